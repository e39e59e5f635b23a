# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of gains of collections and the table of the short answer, computed again from the rows by pandas and scipy alone."""

import json
import re
import unittest

import numpy as np
import pandas
from scipy import stats

from plots.__main__ import main
from plots.claims.reasons import reference
from plots.results.collection import KEYS, MEMBER_COLUMNS, NUMBERS, SUMMARY
from plots.results.data_folder import data_folder
from plots.tests.synthetic_results import write_csv
from plots.tests.test_read_results import InFolder

KIND = ["elements", "degree", "level"]
FIELDS = [study for study in ("field", "field-volume") if (reference() / study).is_dir()]


def problems(folder):
    """A row for each member and degree: logarithm of error after over before of each method (0 where it failed), and failures."""
    path = folder / "summary.csv"
    rows = pandas.read_csv(path if path.exists() else folder / "summary.csv.xz", dtype={"distortion": str}, keep_default_na=False, na_values=[""], low_memory=False)
    rows["level"] = rows.distortion.fillna("as generated")
    key = ["member", "family", *KIND]
    rows = rows.dropna(subset=["degree"])
    rows["degree"] = rows.degree.astype(int)
    errors = rows.where(rows.n_invalid == 0).assign(**rows[[*key, "method"]]).pivot(index=key, columns="method", values="h1_error")
    failed = errors.isna().drop(columns="initial")
    logs = np.log(errors.div(errors.initial, axis=0)).drop(columns="initial").fillna(0.0)
    return logs[errors.initial.notna()], failed[errors.initial.notna()]


def again(folder, reference_method):
    """(elements, degree, level, method) -> the numbers of the table."""
    logs, failed = problems(folder)
    found = {}
    for kind, of_kind in logs.groupby(level=KIND):
        means = of_kind.groupby(level="family").mean()
        n = len(means)
        others = [method for method in means if method != reference_method]
        p_values = {method: stats.permutation_test(
            ((means[method] - means[reference_method]).to_numpy(), np.zeros(n)), lambda x, y, axis: np.mean(x - y, axis=axis),
            permutation_type="samples", vectorized=True, n_resamples=np.inf).pvalue for method in others} if n > 1 else {}
        adjusted, largest = {}, 0.0
        for place, method in enumerate(sorted(p_values, key=p_values.get)):
            largest = adjusted[method] = min(1.0, max(largest, (len(others) - place) * p_values[method]))
        for method, column in means.items():
            over = column - means[reference_method]
            family = failed.loc[of_kind.index, method].groupby(level="family").mean()
            worse = (of_kind[method] > np.log(1.01)).groupby(level="family").mean()
            found[*kind, method] = (*mean_and_interval(column), *(mean_and_interval(over) if method != reference_method else (1, np.nan, np.nan)),
                                    adjusted.get(method, np.nan), 100 * worse.mean(), 100 * family.mean(), len(of_kind), n)
    return found


def mean_and_interval(logs):
    """Geometric mean and ends of its interval by Student's t distribution."""
    n = len(logs)
    ends = stats.t.interval(0.95, n - 1, loc=logs.mean(), scale=stats.sem(logs)) if n > 1 else (np.nan, np.nan)
    return np.exp(logs.mean()), *np.exp(ends)


def ends_of(text):
    """(0.12, 0.34) of "0.12 to 0.34"."""
    return tuple(float(end) for end in str(text).split(" to ")) if " to " in str(text) else (np.nan, np.nan)


def printed(folder, titles):
    """The same numbers as the table has them."""
    found = {}
    for row in pandas.read_csv(folder / "tables" / "table_smoothing.csv", dtype={"Level": str}).to_dict("records"):
        over = next(name for name in row if name.startswith("Error / ") and name.endswith(" p")).removesuffix(" p")
        is_reference = titles[row["Method"]] == next(iter(titles.values()))
        found[row["Elements"], row["d"], row["Level"], titles[row["Method"]]] = (
            row["Error / initial"], *ends_of(row["Error / initial interval"]),
            row[over], *((np.nan, np.nan) if is_reference else ends_of(row[f"{over} interval"])),
            row[f"{over} p"], row["Worse (%)"], row["Failed (%)"], row["Problems"], row["Families"])
    return found


# Half a unit of the last digit of each number in the table, and a little; of p two digits are shown.
ROUNDING = (*6 * (0.00051,), None, 0.51, 0.51, 0.0, 0.0)


def agree(mine, shown, rounding):
    """True if two numbers are the same up to the rounding of the second."""
    mine, shown = float(mine), pandas.to_numeric(shown, errors="coerce")
    if np.isnan(mine) or np.isnan(shown):
        return np.isnan(mine) and np.isnan(shown)
    return abs(mine - shown) <= (0.051 * shown if rounding is None else rounding)


def write_random_collection(folder):
    """Eight families, two levels, two degrees, two members each; of four methods one fails now and then."""
    random, rows, members = np.random.default_rng(7), [], []
    for family in "abcdefgh":
        for level in ("", "0.6"):
            for k in "12":
                member = {"member": f"{family}{level}{k}", "family": family, "elements": "triangles", "distortion": level, "solution": "",
                          "status": "complete", "reason": "", "mesh": f"{family}{level}{k}"}
                members.append(member)
                for degree in "12":
                    initial = random.lognormal()
                    for method, gain in (("initial", 1.0), ("first", 0.6), ("better", 0.3), ("equal", 0.6), ("failing", 0.7)):
                        ratio = 1.0 if method == "initial" else gain * random.lognormal(sigma=0.4)
                        is_invalid = method == "failing" and random.random() < 0.3
                        rows.append({**member, "method": method, "degree": degree, "n_invalid": int(is_invalid), "cg_seconds": 1,
                                     "smoothing_seconds": 1, "h1_error": "" if is_invalid else initial * ratio, "l2_error": 1,
                                     "stage": "s", "iteration": 0})
    folder.mkdir()
    write_csv(folder / "members.csv", MEMBER_COLUMNS, members)
    write_csv(folder / "summary.csv", tuple(dict.fromkeys((*KEYS, *SUMMARY, *NUMBERS))), rows)
    starts = [{**row, "method": method} for row in rows if row["method"] == "initial"
              for method in ("first", "better", "equal", "failing")]
    write_csv(folder / "iterations.csv", tuple(dict.fromkeys((*KEYS, *NUMBERS))), starts)
    (folder / "provenance.json").write_text(json.dumps({"study": "many", "parameters": {"kind": "collection"}, "methods": [
        {"name": name, "title": name.capitalize()} for name in ("first", "better", "equal", "failing")]}))
    return folder


class GainsAgain(InFolder):
    def assert_same(self, table, expected):
        self.assertEqual(set(table), set(expected))
        for key, numbers in table.items():
            self.assertTrue(all(map(agree, expected[key], numbers, ROUNDING)), (key, expected[key], numbers))

    def test_gains_are_those_of_scipy(self):
        folder = write_random_collection(self.folder / "r")
        self.assertEqual(main([str(folder), "--quiet", "--only", "table_smoothing"]), 0)
        expected = again(folder, "first")
        table = printed(folder, {name.capitalize(): name for name in ("first", "better", "equal", "failing")})
        self.assertEqual(len(table), 16)
        self.assert_same(table, expected)
        self.assertLess(min(numbers[6] for numbers in expected.values() if np.isfinite(numbers[6])), 0.05)
        self.assertGreater(max(numbers[8] for numbers in expected.values()), 0.0)

    def test_rows_of_the_ends_are_enough(self):
        folder = write_random_collection(self.folder / "r")
        tables = []
        for _ in range(2):
            self.assertEqual(main([str(folder), "--quiet", "--only", "table_smoothing"]), 0)
            tables.append((folder / "tables" / "table_smoothing.csv").read_text())
            (folder / "iterations.csv").unlink(missing_ok=True)
        self.assertEqual(*tables)

    def test_the_reference_has_the_numbers_of_scipy(self):
        self.assertTrue(FIELDS)
        for study in FIELDS:
            with self.subTest(study):
                folder = reference() / study
                titles = {method["title"]: method["name"] for method in json.loads((folder / "provenance.json").read_text())["methods"]}
                table = printed(folder, titles)
                self.assertGreater(len(table), 50)
                self.assert_same(table, again(folder, next(iter(titles.values()))))


class AnswerAgain(unittest.TestCase):
    def test_the_table_of_the_answer(self):
        page = (data_folder() / "docs" / "explanation" / "answer.md").read_text(encoding="utf-8")
        block = re.search(r"<!-- begin levels: .*?-->(.*?)<!-- end levels -->", page, re.DOTALL)[1]
        cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in block.splitlines() if line.startswith("|")][2:]
        expected = {}
        for study in FIELDS:
            expected |= again(reference() / study, "getme-simultaneous")
        self.assertEqual(len(cells), 6 * len(FIELDS))
        for elements, level, *shown in cells:
            for degree, text in zip((1, 2), shown):
                ratio, low, high = (float(number) for number in re.findall(r"[0-9.]+", text))
                mine = expected[elements, degree, level.removeprefix("distorted to "), "getme-simultaneous"]
                for own, number in zip(mine, (ratio, low, high)):
                    self.assertLess(abs(own - number), 0.0056, (elements, level, degree))  # rounded twice: 3 digits, then 2
