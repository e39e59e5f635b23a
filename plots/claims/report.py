# SPDX-License-Identifier: GPL-3.0-or-later
"""The claims about a study and their verdicts as Markdown."""

from ..results.printed_values import as_guess
from ..results.rows import entries
from ..tables.formats import escape_markdown
from ..tables.number_format import MISSING
from .check import COARSE, FAILS, HOLDS, UNKNOWN

# Phrases for one claim and for several.
PHRASES = {HOLDS: ("holds", "hold"), FAILS: ("does not hold", "do not hold"),
           COARSE: ("is on meshes too coarse to judge", "are on meshes too coarse to judge"),
           UNKNOWN: ("cannot be checked", "cannot be checked")}


def claims_as_markdown(outcomes, results):
    """All claims of a study as a Markdown table."""
    lines = [f"# {results.study_title}: claims of the thesis", "", totals(outcomes) + ".", ""]
    lines += [sentence + "  " for sentence in caveats(results)]
    lines += ["", "| | Section | Claim | Criterion | Thesis | smoothfem | |", "|:--|:--|:--|:--|:--|:--|:--|"]
    for outcome in outcomes:
        claim = outcome.claim
        cells = (claim["id"], claim["section"], claim["statement"], criterion_of(claim),
                 outcome.printed, outcome.computed)
        lines.append("| " + " | ".join(escape_markdown(cell) for cell in cells)
                     + f" | {verdict_cell(outcome)} |")
    lines += known_reasons(outcomes)
    return "\n".join(lines) + "\n"


def criterion_of(claim):
    """Returns the criterion, with its date if a reader has to know it."""
    history = claim.get("history")
    is_plain = history is None or ("revises" not in claim and history.is_as_it_should_be)
    return claim["criterion"] + ("" if is_plain else f" ({history})")


def totals(outcomes):
    """Counts the claims that hold by their first criterion, and the claims that hold by a later one."""
    # At the scale `quick` the verdict COARSE replaces FAILS.
    left_out = FAILS if any(o.verdict == COARSE for o in outcomes) else COARSE

    def counted(chosen, one, many):
        numbers = {verdict: sum(o.verdict == verdict for o in chosen) for verdict in PHRASES}
        counts = ", ".join(f"{number} {PHRASES[verdict][number != 1]}" for verdict, number in numbers.items()
                           if verdict != left_out)
        return f"{len(chosen)} {one if len(chosen) == 1 else many} {counts}"
    text = "Of " + counted([o for o in outcomes if not o.is_revised_criterion], "claim", "claims")
    revised = [o for o in outcomes if o.is_revised_criterion]
    return text + ("; of " + counted(revised, "later criterion", "later criteria") if revised else "")


def verdict_cell(outcome):
    """Returns the verdict, and the number of single seeds for which the claim holds."""
    return emphasized(outcome.verdict) + of_seeds(outcome)


def of_seeds(outcome):
    """Counts the single seeds for which the claim holds; empty for one seed."""
    return f" (holds for {outcome.seeds})" if outcome.seeds else ""


def emphasized(verdict):
    """Returns a verdict for a table: bold if it needs attention."""
    return f"**{verdict}**" if verdict in (FAILS, UNKNOWN) else verdict


def of_chance(outcome):
    """Describes whether other seeds point to chance as a reason; empty for one seed."""
    if not outcome.seeds:
        return ""
    if not outcome.chance:
        return "Seeds do not change what decides."
    verdict = "is not the reason" if outcome.seeds.startswith("0 ") else "decides"
    return f"Chance {verdict}: it holds for {outcome.seeds}."


def of_test(test, tested, outcome):
    """Describes the result of the test of a reason. tested: the claim's outcome in the study that changes the one
    thing, or None."""
    if tested is None:
        return as_guess(test["reason"])
    if tested.verdict == HOLDS:
        found = "the claim holds"
    elif tested.verdict == FAILS:
        met, of_all = tested.met
        found = "the claim does not hold either"
        if of_all > 1:
            found += f", {met} of {of_all} cases meet it (without: {outcome.met[0]})"
    else:
        found = "the claim cannot be judged, as numbers for it are missing"
    printed = "" if tested.printed == MISSING else f" (printed {tested.printed})"
    return (f"Suspected: {test['reason']} Tested by `{test['study']}`, {test['change']}: with this change "
            f"{found}{of_seeds(tested)}; {tested.computed}{printed}.")


def known_reasons(outcomes):
    """Known and supposed reasons why claims do not hold: lines below the table."""
    found = {}
    for outcome in outcomes:
        if outcome.verdict == FAILS:
            guess = as_guess(outcome.guess) if outcome.guess else ""
            tests = [of_test(*tested, outcome) for tested in outcome.tests]
            reason = " ".join(filter(None, (outcome.note, of_chance(outcome), *tests, guess))) or "Reason not known."
            found.setdefault(reason, []).append(outcome.claim["id"])
    lines = [f"- {', '.join(ids)}: {escape_markdown(reason)}" for reason, ids in found.items()]
    return ["", "Known and supposed reasons why claims do not hold:", "", *lines] if lines else []


def caveats(results):
    """Warnings that a reader needs before comparing the numbers, as sentences."""
    found = [results.note] if results.note else []
    found += ["All numbers come from the CSV files of this folder. Printed values come from the "
              "tables and the text of the thesis. A dash marks a missing number."]
    sizes = [f"{entry['name']} ({entry['n_cells']:,} cells)"
             for entry in entries(results.provenance, "meshes")
             if entry["name"] in results.meshes and isinstance(entry.get("n_cells"), int)]
    scale = results.provenance.get("scale") or ""
    if sizes:
        found.append(f"Meshes{f' of the scale `{scale}`' if scale else ''}: {', '.join(sizes)}. Errors, "
                     "condition numbers and times depend on the size.")
    if results.seeds:
        seeds = ", ".join(str(seed) for seed in results.seeds)
        found.append(f"Repeated with the seeds {seeds}: {', '.join(results.repeated)}. Numbers of smoothfem "
                     "are medians over the seeds, and claims are judged by them.")
    own = [mesh for mesh in results.meshes if not results.is_published(mesh)]
    if own:
        found.append(f"Not the meshes of the thesis but stand-ins for them: {', '.join(own)}.")
    return found
