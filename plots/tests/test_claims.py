# SPDX-License-Identifier: GPL-3.0-or-later
"""Claims: their arithmetic, their verdicts, and the agreement of the criteria with the printed values."""

import csv
import json
import math
import re
import shutil
from dataclasses import replace
from unittest import mock

from plots.__main__ import main
from plots.claims import reasons as reasons_module
from plots.claims.check import (COARSE, FAILS, HOLDS, NUMBER_IN_NOTE, UNKNOWN, Outcome, cases_of, check_claim,
                                check_claims, met_in, number_of, read_claims, values_of, verdict_of)
from plots.claims.expressions import Missing, evaluate
from plots.claims.report import claims_as_markdown, known_reasons, of_test
from plots.claims.values import TRAJECTORY, Values
from plots.results.data_folder import thesis_folder
from plots.results.printed_values import read_printed_tables
from plots.results.smoothing import read_results
from plots.tables.number_format import MISSING
from plots.tests.synthetic_results import change_provenance, results_row, write_csv, write_results
from plots.tests.synthetic_volume import write_volume_results
from plots.tests.test_read_results import InFolder

ROWS = [{"mesh": "tri", "method": method, "degree": degree, "e_max": error, "q_min": quality}
        for method, degree, error, quality in (("getme", "1", "2.0", "0.5"), ("getme", "2", "0.5", "0.5"),
                                               ("other", "1", "4.0", "0"), ("other", "2", "", "0"))]
THRESHOLDS = [{"mesh": "tri", "degree": "1", "error": "e_max", "method": method,
               "method_seconds": seconds, "speedup": speedup}
              for method, seconds, speedup in (("getme", "0.5", "4"), ("other", "", ""))]


class Expressions(InFolder):
    def test_arithmetic_and_comparisons(self):
        for text, expected in (("1 + 2 * 3", 7), ("-(4 / 8)", -0.5), ("1 <= x < 3", True),
                               ("twice(x) == 3", False), ("twice(x - 1)", 2)):
            self.assertEqual(evaluate(text, {"x": 2}, lambda name, values: 2 * values[0]), expected)

    def test_what_is_missing(self):
        for text in ("1 / (x - x)", "f()"):
            with self.assertRaises(Missing):
                evaluate(text, {"x": 1.0}, lambda name, values: float("nan"))

    def test_no_more_than_arithmetic(self):
        for text in ("x.real", "[1]", "1 if 2 else 3", "open('f').read()", "y", "2 **", "x ** 2", "'a' / 2"):
            with self.assertRaises(ValueError):
                evaluate(text, {"x": 1.0}, lambda name, values: 1.0)


class Verdicts(InFolder):
    def outcome(self, *checks):
        values = Values(ROWS, THRESHOLDS)
        return check_claim({"checks": list(checks)}, [values], Values([], []))

    def test_holds_fails_unknown(self):
        factor = "e_max('tri', 'getme', 1) / e_max('tri', 'getme', 2)"
        for quantity, condition, verdict, computed in (
                (factor, "value > 3", HOLDS, "4"), (factor, "value > 5", FAILS, "4"),
                (factor, "printed < value", UNKNOWN, "4"),
                ("e_max('tri', 'other', 2)", "value > 0", UNKNOWN, "–"),
                ("e_max('quad', 'getme', 2)", "value > 0", UNKNOWN, "–"),
                ("reached('tri', 1, 'e_max', 'other')", "value == 0", HOLDS, "0"),
                ("speedup('tri', 1, 'e_max', 'other')", "value >= 2", FAILS, "0"),
                ("method_seconds('tri', 1, 'e_max', 'other')", "value < 1", FAILS, "never"),
                ("max(q_min('tri', 'getme'), column('e_max', 'tri', 'getme', 1))", "value == 2", HOLDS, "2")):
            outcome = self.outcome({"quantity": quantity, "condition": condition})
            self.assertEqual((outcome.verdict, outcome.computed), (verdict, computed), quantity)

    def test_one_failing_check_decides(self):
        holding, failing = ({"quantity": "1", "condition": f"value == {n}"} for n in (1, 2))
        lacking = {"quantity": "e_max('quad', 'getme')", "condition": "value > 0"}
        self.assertEqual(self.outcome(holding, lacking).verdict, UNKNOWN)
        self.assertEqual(self.outcome(holding, lacking, failing).verdict, FAILS)

    def test_cases_and_counts(self):
        check = {"quantity": "e_max('tri', method, degree)", "condition": "value < 3",
                 "for": {"method": ["getme", "other"], "degree": [1, 2]}}
        outcome = self.outcome(check)
        self.assertEqual(outcome.verdict, FAILS)
        self.assertEqual(outcome.computed, "getme: d = 1: 2, getme: d = 2: 0.5, other: d = 1: 4")
        self.assertEqual(self.outcome({**check, "at_least": 2}).verdict, HOLDS)
        self.assertEqual(self.outcome({**check, "at_least": 3}).verdict, UNKNOWN)
        many = self.outcome({**check, "for": {"method": ["getme", "other"], "degree": [1, 2, 1]}})
        self.assertEqual(many.computed, "0.5 to 4, met in 3 of 6")

    def test_numbers_in_a_note(self):
        note = ("{e_max('tri', 'getme', 1) / 3}, not {printed q_min('tri', 'getme')} "
                "or {e_max('quad', 'getme')}")
        theirs = Values([{"mesh": "tri", "method": "getme", "q_min": "0.25"}], [])
        outcome = check_claim({"checks": [], "reason": "", "note": note}, [Values(ROWS, [])], theirs)
        self.assertEqual(outcome.note, "")  # it cannot be checked
        check = {"quantity": "1", "condition": "value == 2"}
        outcome = check_claim({"checks": [check], "note": note}, [Values(ROWS, [])], theirs)
        self.assertEqual(outcome.note, "0.667, not 0.25 or –")


def all_claims():
    """The claims about all studies."""
    return json.loads((thesis_folder() / "claims.json").read_text(encoding="utf-8"))


class Trajectories(InFolder):
    def values(self, iterations=(0, 1, 2), **fields):
        rows = [results_row(mesh="tri", method="getme", degree="1", iteration=i, q_min=0.1 * (n + 1),
                            smoothing_seconds=n, stage="first" if i else "initial", n_invalid=2 - n, **fields)
                for n, i in enumerate(iterations)]
        rows.append({**rows[-1], "stage": "second", "iteration": 100, "q_min": 0.2, "smoothing_seconds": 6})
        folder = self.folder / "t"
        folder.mkdir(exist_ok=True)
        write_csv(folder / "iterations.csv", list(rows[0]), rows)
        write_csv(folder / "summary.csv", list(rows[0]), rows)
        return Values([], [], read_results(folder).iterations)

    def test_functions(self):
        values = self.values(n_reset=3)
        for text, expected in (
                ("at_start('q_min', 'tri', 'getme', 1)", 0.1), ("highest('q_min', 'tri', 'getme', 1)", 0.3),
                ("at_stage_end('q_min', 'tri', 'getme', 1, 'first')", 0.3),
                ("after_iterations('q_min', 'tri', 'getme', 1, 1)", 0.2),
                ("highest('q_min', 'tri', 'getme', 1, 'second')", 0.2),
                ("after_share_of_time('q_min', 'tri', 'getme', 1, 0.25)", 0.25),
                ("total('n_reset', 'tri', 'getme')", 9), ("total('n_reset', 'tri', 'getme', 'second')", 3),
                ("invalid_iterations('tri', 'getme')", 1), ("valid_iterations('tri', 'getme')", 2)):
            self.assertAlmostEqual(evaluate(text, {}, values), expected, msg=text)

    def test_times_and_iterations(self):
        values = self.values()
        for text, expected in (
                ("seconds_until('q_min', 'tri', 'getme', 0.15)", 1.0),
                ("seconds_until('q_min', 'tri', 'getme', 0.9)", math.inf),
                ("seconds_until_below('q_min', 'tri', 'getme', 0.1)", 0.0),
                ("iterations_until('q_min', 'tri', 'getme', 0.3)", 2),
                ("iterations_until('q_min', 'tri', 'getme', 0.9)", math.inf),
                ("seconds_per_iteration('tri', 'getme')", 1.0)):
            self.assertEqual(round(evaluate(text, {}, values), 12), expected, msg=text)

    def test_gaps_in_the_record_leave_questions_open(self):
        values = self.values(iterations=(0, 10, 20))
        for text in ("invalid_iterations('tri', 'getme')", "highest('q_min', 'tri', 'getme', 1)",
                     "after_iterations('q_min', 'tri', 'getme', 1, 5)", "valid_iterations('quad', 'getme')",
                     "total('n_reset', 'tri', 'getme')"):
            with self.assertRaises(Missing, msg=text):
                evaluate(text, {}, values)
        self.assertAlmostEqual(evaluate("at_start('q_min', 'tri', 'getme', 1)", {}, values), 0.1)


class ClaimsOfTheThesis(InFolder):
    def test_criteria_fit_the_print(self):
        claims = all_claims()
        self.assertEqual(len({claim["id"] for claim in claims}), len(claims))
        for study in {claim["study"] for claim in claims}:
            printed = {content: table.rows for content, table in read_printed_tables(study, {}).items()}
            theirs = Values([row for content, rows in printed.items() if content != "thresholds"
                             for row in rows], printed.get("thresholds", []))
            for claim in read_claims(study):
                self.assertTrue(claim["checks"] or claim["reason"])
                for check in claim["checks"]:
                    numbers = [number_of(check["quantity"], case, theirs) for case in cases_of(check)]
                    if "printed" not in check:  # in words, if the thesis prints no numbers
                        met = met_in(check, numbers, numbers)
                        self.assertEqual(verdict_of(met, check.get("at_least", len(met))), HOLDS, claim["id"])

    def test_every_name_is_a_column_or_function(self):
        results = read_results(write_results(self.folder / "r"))
        known = {*results.summary.columns, *results.thresholds.columns, *TRAJECTORY, "reached", "column",
                 "min", "max"}
        for claim in all_claims():
            quantities = [check["quantity"] for check in claim["checks"]]
            quantities += [match[2] for match in NUMBER_IN_NOTE.finditer(claim.get("note", ""))]
            for quantity in quantities:
                self.assertLessEqual(set(re.findall(r"(\w+)\(", quantity)), known)

    def test_notes_ask_for_numbers_there_are(self):
        for claim in all_claims():
            printed = {content: table.rows
                       for content, table in read_printed_tables(claim["study"], {}).items()}
            theirs = Values([row for rows in printed.values() for row in rows], [])
            for match in NUMBER_IN_NOTE.finditer(claim.get("note", "")):
                number_of(match[2], {}, lambda *_: 1.0)  # raises if it is no arithmetic
                if match[1]:
                    self.assertIsNotNone(number_of(match[2], {}, theirs), claim["id"])

    def test_table_of_claims(self):
        for study, write in (("gear", write_results), ("volume", write_volume_results)):
            folder = write(self.folder / study)
            self.assertEqual(main([str(folder), "--quiet", "--no-figures"]), 0)
            text = (folder / "tables" / "claims.md").read_text()
            rows = [line for line in text.splitlines() if line.startswith("| ")]
            self.assertEqual(len(rows), 1 + len(read_claims(study)))
            self.assertEqual({row.count(" |") for row in rows}, {7})
            self.assertIn("stand-ins", text)
            self.assertNotIn("A shape that the thesis does not print.", text)
            change_provenance(folder, note="A shape that the thesis does not print.")
            self.assertEqual(main([str(folder), "--quiet", "--no-figures"]), 0)
            text = (folder / "tables" / "claims.md").read_text()
            self.assertLess(text.index("A shape that the thesis does not print."), text.index("|"))
        folder = write_results(self.folder / "own", study="slab")
        self.assertEqual(main([str(folder), "--quiet", "--no-figures"]), 0)
        self.assertFalse((folder / "tables" / "claims.md").exists())

    def test_quick_meshes_are_too_coarse_to_judge(self):
        folder = write_results(self.folder / "r")
        verdicts, texts = {}, {}
        for scale in ("default", "quick"):
            change_provenance(folder, scale=scale)
            results = read_results(folder)
            outcomes = check_claims(read_claims("gear"), results, read_printed_tables("gear", {}))
            verdicts[scale] = [outcome.verdict for outcome in outcomes]
            texts[scale] = claims_as_markdown(outcomes, results)
        self.assertIn(FAILS, verdicts["default"])
        self.assertEqual(verdicts["quick"], [COARSE if v == FAILS else v for v in verdicts["default"]])
        n = sum(o.verdict == COARSE and not o.is_revised_criterion for o in outcomes)
        self.assertIn(f" {n} do not hold", texts["default"])
        self.assertIn(f" {n} are on meshes too coarse to judge,", texts["quick"])
        self.assertIn(f"| {COARSE} |", texts["quick"])
        self.assertNotIn("not hold", texts["quick"])

    def test_a_study_of_the_users_has_no_claims_whatever_its_name(self):
        folder = write_results(self.folder / "r")
        self.assertNotEqual(read_claims(read_results(folder).thesis_study), [])
        change_provenance(folder, built_in=False)
        self.assertEqual(read_claims(read_results(folder).thesis_study), [])

    def test_count_of_verdicts(self):
        results = read_results(write_results(self.folder / "r"))
        outcomes = check_claims(read_claims("gear"), results, {})
        text = claims_as_markdown(outcomes, results)
        for verdict in (FAILS, UNKNOWN):
            self.assertEqual(text.count(f"**{verdict}**"), sum(o.verdict == verdict for o in outcomes))
        reasons = text.partition("Known and supposed reasons why")[2]
        for outcome in outcomes:
            self.assertEqual(outcome.claim["id"] in re.findall(r"[GV]\d+b?", reasons), outcome.verdict == FAILS)

    def test_what_is_guessed_is_called_a_guess(self):
        def reasons(**keys):
            claim = {"id": "X1", "checks": [{"quantity": "1", "condition": "value == 2"}], **keys}
            return known_reasons([check_claim(claim, [Values(ROWS, [])], Values([], []))])[-1]
        self.assertEqual(reasons(note="It is {q_min('tri', 'getme')}.", guess="Chance."),
                         "- X1: It is 0.5. Guess, tested by no run: Chance.")
        self.assertEqual(reasons(note="It is so."), "- X1: It is so.")
        self.assertEqual(reasons(guess="Chance."), "- X1: Guess, tested by no run: Chance.")
        self.assertEqual(reasons(), "- X1: Reason not known.")

    def test_a_reason_is_tested_by_the_claim_on_another_run(self):
        check = {"quantity": "e_max('tri', 'getme', 1)", "condition": "value > 20", "printed": "25"}
        test = {"study": "reasons/other", "change": "one thing changed", "reason": "It is that thing."}
        claim = {"id": "X1", "study": "gear", "checks": [check], "tests": [test]}
        results = read_results(write_results(self.folder / "r"))

        def reasons(error):
            reasons_module.results_of.cache_clear()
            other = self.folder / "data" / "results" / "reference" / "reasons" / "other"
            if error is not None:
                write_results(other)
                with open(other / "summary.csv", newline="", encoding="utf-8") as stream:
                    rows = list(csv.DictReader(stream))
                write_csv(other / "summary.csv", list(rows[0]), [{**row, "e_max": error} for row in rows])
            with mock.patch.object(reasons_module, "data_folder", lambda: self.folder / "data"):
                found = known_reasons(check_claims([claim], results, {}))[-1]
            shutil.rmtree(other, ignore_errors=True)
            return found

        self.assertEqual(reasons(None), "- X1: Guess, tested by no run: It is that thing.")
        begin = ("- X1: Suspected: It is that thing. Tested by `reasons/other`, one thing changed: with this change "
                 "the claim ")
        self.assertEqual(reasons(30), begin + "holds; 30 (printed 25).")
        self.assertEqual(reasons(15), begin + "does not hold either; 15 (printed 25).")
        self.assertEqual(reasons(""), begin + "cannot be judged, as numbers for it are missing; – (printed 25).")
        check["for"] = {"degree": ["1", "2"]}
        check["quantity"] = "e_max('tri', 'getme', degree)"
        self.assertEqual(reasons(15), begin + "does not hold either, 0 of 2 cases meet it (without: 0); d = 1: 15, "
                                      "d = 2: 15 (printed 25).")

    def test_a_test_with_several_seeds_says_for_how_many_the_claim_holds(self):
        test = {"study": "reasons/other", "change": "other seeds", "reason": "Chance."}
        judged = Outcome({"id": "X1"}, FAILS, MISSING, "3", met=(0, 1))
        tested = replace(judged, seeds="1 of 2 seeds")
        self.assertEqual(of_test(test, tested, judged),
                         "Suspected: Chance. Tested by `reasons/other`, other seeds: with this change the claim does "
                         "not hold either (holds for 1 of 2 seeds); 3.")

    def test_methods_that_failed_have_no_numbers(self):
        folder = write_results(self.folder / "failed")
        for name in ("summary.csv", "iterations.csv"):
            with open(folder / name, newline="", encoding="utf-8") as stream:
                rows = list(csv.DictReader(stream))
            for row in rows:
                if row["method"] == "getme":
                    row["status"] = "failed: it took too long"
            write_csv(folder / name, list(rows[0]), rows)
        [computed] = values_of(read_results(folder))
        for quantity in ("q_min('tri', 'getme')", "at_start('q_min', 'tri', 'getme', 1)",
                         "speedup('tri', 1, 'e_max', 'getme')"):
            self.assertIsNone(number_of(quantity, {}, computed), quantity)
        self.assertIsNotNone(number_of("q_min('tri', 'initial')", {}, computed))

    def test_every_test_of_a_reason_is_a_study(self):
        for claim in json.loads((thesis_folder() / "claims.json").read_text(encoding="utf-8")):
            for test in claim.get("tests", []):
                self.assertTrue((thesis_folder().parent / f"{test['study']}.prm").is_file(), test["study"])
                self.assertEqual(set(test), {"study", "change", "reason"})

    def test_seeds_say_whether_it_is_chance(self):
        def reasons(seeds, chance=True):
            outcome = Outcome({"id": "X1"}, FAILS, "", "", note="It is so.", seeds=seeds, chance=chance)
            return known_reasons([outcome])[-1]

        self.assertEqual(reasons("0 of 3 seeds"),
                         "- X1: It is so. Chance is not the reason: it holds for 0 of 3 seeds.")
        self.assertEqual(reasons("2 of 5 seeds"), "- X1: It is so. Chance decides: it holds for 2 of 5 seeds.")
        self.assertEqual(reasons("0 of 5 seeds", chance=False), "- X1: It is so. Seeds do not change what decides.")
        self.assertEqual(reasons(""), "- X1: It is so.")

    def test_chance_is_judged_by_the_numbers_that_decide(self):
        check = {"quantity": "e_max(mesh, 'getme')", "condition": "value < 1", "for": {"mesh": ["a", "b"]}}
        claim = {"id": "X1", "checks": [check]}

        def outcome(*pairs):
            seeds = [Values([{"mesh": mesh, "method": "getme", "e_max": error} for mesh, error in zip("ab", pair)], [])
                     for pair in pairs]
            return check_claim(claim, seeds, Values([], []))
        self.assertFalse(outcome(("2", "0.1"), ("2", "0.2")).chance)
        self.assertTrue(outcome(("2", "0.1"), ("3", "0.1")).chance)
        self.assertEqual(outcome(("2", "0.1"), ("3", "0.1")).met, (1, 2))

    def test_a_quotient_by_zero_is_no_missing_column(self):
        check = {"quantity": "1 / q_min('tri', 'other')", "condition": "value > 0"}
        claim = {"id": "X1", "checks": [check], "reason": "missing: column `q_min`"}
        outcome = check_claim(claim, [Values(ROWS, [])], Values([], []))
        self.assertEqual((outcome.verdict, outcome.computed), (UNKNOWN, "a quotient by 0"))

    def test_what_is_missing_stands_in_the_row(self):
        check = {"quantity": "n_cells('tri', 'getme')", "condition": "value > 0"}
        claim = {"id": "X1", "checks": [check], "reason": "missing: column `n_cells`"}
        outcome = check_claim(claim, [Values(ROWS, [])], Values([], []))
        self.assertEqual((outcome.verdict, outcome.computed), (UNKNOWN, claim["reason"]))
        there = check_claim(claim, [Values([{**ROWS[0], "n_cells": "3"}], [])], Values([], []))
        self.assertEqual((there.verdict, there.computed), (HOLDS, "3"))
