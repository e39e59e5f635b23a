# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of gains of a collection, computed again from its rows by pandas and scipy alone."""

import json

import numpy as np
import pandas
from scipy import stats

from plots.__main__ import main
from plots.results.collection import KEYS, MEMBER_COLUMNS, NUMBERS, SUMMARY
from plots.tests.synthetic_results import write_csv
from plots.tests.test_read_results import InFolder

KIND = ["elements", "degree", "level"]


def problems(folder):
    """A row for each member and degree: logarithm of error after over before of each method (0 where it failed), and failures."""
    rows = pandas.read_csv(folder / "summary.csv", dtype={"distortion": str}, keep_default_na=False, na_values=[""], low_memory=False)
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
            interval = stats.t.interval(0.95, n - 1, loc=column.mean(), scale=stats.sem(column)) if n > 1 else (np.nan, np.nan)
            family = failed.loc[of_kind.index, method].groupby(level="family").mean()
            worse = (of_kind[method] > np.log(1.01)).groupby(level="family").mean()
            found[*kind, method] = (np.exp(column.mean()), *np.exp(interval), adjusted.get(method, np.nan), 100 * worse.mean(),
                                    100 * family.mean(), len(of_kind), n)
    return found


def printed(folder, titles):
    """The same numbers as the table has them."""
    found = {}
    for row in pandas.read_csv(folder / "tables" / "table_smoothing.csv", dtype={"Level": str}).to_dict("records"):
        low, high = (float(end) for end in str(row["Error / initial interval"]).split(" to ")) if " to " in str(
            row["Error / initial interval"]) else (np.nan, np.nan)
        p_value = next(value for name, value in row.items() if name.endswith(" p"))
        found[row["Elements"], row["d"], row["Level"], titles[row["Method"]]] = (
            row["Error / initial"], low, high, p_value, row["Worse (%)"], row["Failed (%)"], row["Problems"], row["Families"])
    return found


# Half a unit of the last digit of each number in the table, and a little; of p two digits are shown.
ROUNDING = (0.00051, 0.00051, 0.00051, None, 0.51, 0.51, 0.0, 0.0)


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
    write_csv(folder / "summary.csv", tuple(dict.fromkeys((*KEYS, *SUMMARY))), rows)
    starts = [{**row, "method": method} for row in rows if row["method"] == "initial"
              for method in ("first", "better", "equal", "failing")]
    write_csv(folder / "iterations.csv", tuple(dict.fromkeys((*KEYS, *NUMBERS))), starts)
    (folder / "provenance.json").write_text(json.dumps({"study": "many", "parameters": {"kind": "collection"}, "methods": [
        {"name": name, "title": name.capitalize()} for name in ("first", "better", "equal", "failing")]}))
    return folder


class GainsAgain(InFolder):
    def test_gains_are_those_of_scipy(self):
        folder = write_random_collection(self.folder / "r")
        self.assertEqual(main([str(folder), "--quiet", "--only", "table_smoothing"]), 0)
        expected = again(folder, "first")
        table = printed(folder, {name.capitalize(): name for name in ("first", "better", "equal", "failing")})
        self.assertEqual(set(table), set(expected))
        self.assertEqual(len(table), 16)
        for key, numbers in table.items():
            self.assertTrue(all(map(agree, expected[key], numbers, ROUNDING)), (key, expected[key], numbers))
        self.assertLess(min(numbers[3] for numbers in expected.values() if np.isfinite(numbers[3])), 0.05)
        self.assertGreater(max(numbers[5] for numbers in expected.values()), 0.0)
