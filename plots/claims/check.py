# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks claims of the thesis' text against the CSV files of a study.

The claims are in studies/thesis/claims.json; the README.md of that folder describes the format.
"""

import itertools
import json
import math
import re
import statistics
from dataclasses import dataclass, replace

from ..results.data_folder import thesis_folder
from ..results.rows import ResultsError
from ..tables.number_format import MISSING
from .criteria import read_criteria
from .expressions import DividedByZero, Missing, evaluate
from .reasons import results_of_test
from .values import Values

HOLDS, FAILS, UNKNOWN = "holds", "does not hold", "cannot be checked"
COARSE = "too coarse to judge"  # replaces `does not hold` on the coarse meshes of quick studies
# A larger number of values is shown as a range.
MOST_SHOWN = 4
# A number in a note: the computed or the printed one.
NUMBER_IN_NOTE = re.compile(r"\{(printed )?(.+?)\}")


@dataclass(frozen=True)
class Outcome:
    """A claim and its result, as texts for the table."""

    claim: dict
    verdict: str
    printed: str
    computed: str
    note: str = ""  # computed numbers that may explain why it does not hold
    guess: str = ""  # a possible reason that no run has tested
    seeds: str = ""  # number of seeds for which it holds alone; empty for one seed
    chance: bool = True  # True if seeds change a deciding number; meaningless for one seed
    met: tuple = ()  # cases that meet their condition, and cases in all; empty if there are no checks
    tests: tuple = ()  # (test of a reason, Outcome on the study that tests it; None if it was not run)

    @property
    def is_revised_criterion(self):
        """True if the claim revises another claim: a later criterion in addition to the first one."""
        return "revises" in self.claim


def read_claims(study):
    """The claims about a study, as a list of dictionaries, with the Criterion of each as `history`;
    empty if there are none. `study` as in Results.thesis_study."""
    path = thesis_folder() / "claims.json"
    if not path.exists():
        return []
    try:
        claims = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ResultsError(f"{path}: not a complete JSON file ({error}).") from None
    criteria = read_criteria()
    return [{**claim, "history": criteria.get(claim["id"])} for claim in claims if claim["study"] == study]


def check_claims(claims, results, printed):
    """The outcome of each claim; `printed` as in make_tables. Where a study was repeated with several
    seeds, a claim is judged by the median of each of its quantities."""
    computed = values_of(results)
    rows = {content: table.rows for content, table in printed.items()}
    theirs = Values([row for content in rows if content != "thresholds" for row in rows[content]],
                    rows.get("thresholds", []))
    outcomes = [with_tests(check_claim(claim, computed, theirs), theirs) for claim in claims]
    return [replace(outcome, verdict=COARSE) if results.is_quick and outcome.verdict == FAILS else outcome
            for outcome in outcomes]


def values_of(results):
    """The Values of each seed, without methods that failed."""
    seeds = (each.without_failures() for each in (results, *results.repetitions))
    return [Values(each.summary.records(), each.thresholds.records(), each.iterations) for each in seeds]


def with_tests(outcome, theirs):
    """The outcome with the tests of its reasons, where the claim does not hold."""
    if outcome.verdict != FAILS:
        return outcome
    tested = []
    for test in outcome.claim.get("tests", []):
        results = results_of_test(test)
        tested.append((test, results and check_claim(outcome.claim, values_of(results), theirs)))
    return replace(outcome, tests=tuple(tested))


def check_claim(claim, computed, theirs):
    """Returns the outcome of one claim: it holds if all of its checks hold. computed: values of each seed."""
    if not claim["checks"]:
        return Outcome(claim, UNKNOWN, claim.get("printed", MISSING), claim["reason"])
    verdicts, printed, own, all_met, chance = [], [], [], [], []
    for check in claim["checks"]:
        cases = cases_of(check)
        numbers = [number_of(check["quantity"], case, theirs) for case in cases]
        found = [median_of(check["quantity"], case, computed) for case in cases]
        met = met_in(check, found, numbers)
        all_met += met
        verdicts.append(verdict_of(met, check.get("at_least", len(cases))))
        if verdicts[-1] == FAILS:
            chance += [varies(check["quantity"], case, computed) for case, is_met in zip(cases, met) if not is_met]
        printed.append(check.get("printed") or
                       shown(numbers, cases, met_in(check, numbers, numbers)))
        own.append(shown(found, cases, met))
    worst = next(v for v in (FAILS, UNKNOWN, HOLDS) if v in verdicts)
    missing = ""
    if worst == UNKNOWN:
        is_divided = any(divides_by_zero(check, computed) for check in claim["checks"])
        missing = "a quotient by 0" if is_divided else claim.get("reason")
    seeds = ""
    if len(computed) > 1:
        alone = [check_claim(claim, [one], theirs).verdict for one in computed]
        known = len(alone) - alone.count(UNKNOWN)
        seeds = f"{alone.count(HOLDS)} of {known} seeds" if known > 1 else ""
    return Outcome(claim, worst, "; ".join(printed), missing or "; ".join(own),
                   filled(claim.get("note", ""), computed, theirs), claim.get("guess", ""), seeds,
                   chance=any(chance), met=(all_met.count(True), len(all_met)))


def median_of(quantity, case, values):
    """The median of the quantity in one case over the seeds that have what it needs; None if none has."""
    numbers = [number_of(quantity, case, of_seed) for of_seed in values]
    numbers = [number for number in numbers if number is not None]
    return statistics.median(numbers) if numbers else None


def varies(quantity, case, values):
    """True if one of the seeds gives another number for the quantity."""
    return len({number_of(quantity, case, of_seed) for of_seed in values}) > 1


def divides_by_zero(check, values):
    """True if a quantity of the check is a quotient by zero, for one of the seeds in one of its cases."""
    def divides(case, of_seed):
        try:
            evaluate(check["quantity"], case, of_seed)
        except Missing as error:
            return isinstance(error, DividedByZero)
        return False
    return any(divides(case, of_seed) for case in cases_of(check) for of_seed in values)


def filled(note, computed, theirs):
    """Returns a note with numbers in place of its expressions in braces."""
    def number(match):
        value = number_of(match[2], {}, theirs) if match[1] else median_of(match[2], {}, computed)
        return MISSING if value is None else written(value)
    return NUMBER_IN_NOTE.sub(number, note)


def cases_of(check):
    """Returns all cases of a check: a list of dictionaries from name to value."""
    lists = check.get("for", {})
    return [dict(zip(lists, values)) for values in itertools.product(*lists.values())]


def number_of(quantity, case, values):
    """The quantity in one case, or None if something for it is missing."""
    try:
        return evaluate(quantity, case, values)
    except Missing:
        return None


def met_in(check, found, printed):
    """Evaluates the condition case by case; None where a number for it is missing."""
    def met(value, theirs):
        names = {"value": value, "printed": theirs}
        if value is None or (theirs is None and "printed" in check["condition"]):
            return None
        return evaluate(check["condition"], names, no_functions)
    return [met(value, theirs) for value, theirs in zip(found, printed)]


def verdict_of(met, wanted):
    """Returns the verdict on whether so many cases meet the condition; unknown if missing numbers could still
    decide."""
    if met.count(True) >= wanted:
        return HOLDS
    return FAILS if met.count(True) + met.count(None) < wanted else UNKNOWN


def no_functions(name, _):
    """Conditions compare numbers and call nothing."""
    raise ValueError(f"`{name}` in a condition")


def shown(numbers, cases, met):
    """Returns the numbers for the table: each with its case. Of many numbers it returns the range and how many meet the
    condition."""
    present = [(case, number) for case, number in zip(cases, numbers) if number is not None]
    if not present:
        return MISSING
    if len(cases) > MOST_SHOWN:
        values = [number for _, number in present]
        ends = list(dict.fromkeys(written(value) for value in (min(values), max(values))))
        return f"{' to '.join(ends)}, met in {met.count(True)} of {len(cases)}"
    names = [name for name in cases[0] if len({case[name] for case in cases}) > 1]
    return ", ".join(" ".join([*(label(name, case[name]) for name in names), written(number)])
                     for case, number in present)


def label(name, value):
    """The name of a case in the table."""
    return (f"d = {value}" if name == "degree" else str(value)) + ":"


def written(number):
    """Writes a number with three digits, and whole numbers with all digits."""
    if math.isinf(number):
        return "never"
    whole = number == int(number) and abs(number) < 1e6
    return f"{number + 0:.0f}" if whole else f"{number:.3g}"  # + 0 makes -0 zero
