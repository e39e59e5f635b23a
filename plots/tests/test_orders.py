# SPDX-License-Identifier: GPL-3.0-or-later
"""Orders of the errors in the mesh size, from invented rows whose orders are known."""

import csv
import json
import unittest
from dataclasses import replace

import numpy as np
from scipy import stats

from plots.__main__ import main
from plots.collections.findings import what_orders
from plots.collections.orders import changed, orders
from plots.results.collection import KEYS, MEMBER_COLUMNS, NUMBERS, SUMMARY, read_collection_results
from plots.results.rows import read_rows
from plots.statistics.lines import slope
from plots.tests.synthetic_results import write_csv
from plots.tests.test_read_results import InFolder

# Exponents of h in the H1 error, by method; those of the L2 error are larger by 1.
POWERS = {"initial": 0.5, "better": 1.0, "same": 0.5, "failing": 1.0}
CONSTANTS = {"initial": 8.0, "better": 2.0, "same": 2.0, "failing": 2.0}


def write_sizes(folder, sizes=(1, 0.5, 0.25, 0.125), seeds=(1, 2), noise=0.0):
    """Two families; the finest mesh of `failing` has invalid cells in family b, all but two of its meshes in family a."""
    random, members, rows = np.random.default_rng(3), [], []
    for family in "ab":
        for size in sizes:
            for seed in seeds:
                name = f"{family}.{size:g}.{seed}"
                n_cells = round(100 / size**2)
                members.append({"member": name, "family": family, "elements": "triangles", "size": f"{size:g}", "distortion": "0.45", "seed": seed,
                                "solution": "", "algorithm": "", "dimension": 2, "n_cells": n_cells, "status": "complete", "reason": ""})
                for method, power in POWERS.items():
                    # Two seeds differ by a factor that cancels in their geometric mean.
                    error = CONSTANTS[method] * n_cells**(-power / 2) * 1.5**(2 * seed - 3) * np.exp(noise * random.normal())
                    is_invalid = method == "failing" and (size == sizes[-1] or (family == "a" and size < sizes[1]))
                    rows.append({**members[-1], "mesh": name, "method": method, "degree": 1, "n_invalid": int(is_invalid), "stage": "s",
                                 "iteration": 0, "cg_seconds": 1, "h1_error": error, "l2_error": error * n_cells**-0.5})
    folder.mkdir()
    write_csv(folder / "members.csv", (*MEMBER_COLUMNS, "size", "distortion", "seed", "algorithm", "dimension", "n_cells"), members)
    write_csv(folder / "summary.csv", tuple(dict.fromkeys((*KEYS, *SUMMARY))), rows)
    write_csv(folder / "iterations.csv", tuple(dict.fromkeys((*KEYS, *NUMBERS))), rows)
    (folder / "provenance.json").write_text(json.dumps({"study": "many", "parameters": {"kind": "collection"}, "methods": [
        {"name": name, "title": name.capitalize()} for name in POWERS if name != "initial"]}))
    return folder


class Orders(InFolder):
    def found(self, **options):
        """Orders by family, method and error, and the results."""
        results = read_collection_results(write_sizes(self.folder / "r", **options))
        return {(entry.family, entry.method, entry.error): entry for entry in orders(results)}, results

    def test_errors_of_a_solver_have_a_table_of_orders(self):
        folder = write_sizes(self.folder / "r")
        for name in ("summary.csv", "iterations.csv"):
            rows = [{**row, "beam.energy_error": row["h1_error"]} for row in read_rows(folder / name).records()]
            write_csv(folder / name, tuple(rows[0]), rows)
        self.assertEqual(main([str(folder), "--quiet", "--no-figures"]), 0)
        line, = [line for line in (folder / "tables" / "table_orders_beam.md").read_text().splitlines() if "| a | Better |" in line]
        self.assertIn("| 1.00 | 1.00 to 1.00 | 0.50 | 0.50 to 0.50 | 4 |", line)
        self.assertIn("Order of Energy error", (folder / "tables" / "table_orders_beam.md").read_text())

    def test_known_orders_are_found(self):
        found, results = self.found()
        for family in "ab":
            for method, power in (("initial", 0.5), ("better", 1.0), ("same", 0.5)):
                for error, more in (("h1_error", 0.0), ("l2_error", 1.0)):
                    entry = found[family, method, error]
                    self.assertAlmostEqual(entry.order, power + more)
                    np.testing.assert_allclose(entry.interval, power + more, rtol=1e-6)
                    self.assertEqual(entry.n_sizes, 4)
        self.assertAlmostEqual(found["a", "better", "l2_error"].change, 0.5)
        self.assertAlmostEqual(found["a", "same", "h1_error"].change, 0.0)
        self.assertTrue(np.isnan(found["a", "initial", "h1_error"].change))
        self.assertEqual(found["b", "failing", "h1_error"].n_sizes, 3)
        self.assertAlmostEqual(found["b", "failing", "h1_error"].order, 1.0)
        self.assertEqual(found["a", "failing", "h1_error"].n_sizes, 2)
        self.assertTrue(np.isnan(found["a", "failing", "h1_error"].order))
        text, = what_orders(results, list(found.values()))
        self.assertIn("Smoothing changes the order of the error in h in 4 of 6 cases", text)
        self.assertIn("Triangles, degree 1, distorted to 0.45, Better, H1: a +0.50 (0.50 to 0.50), b +0.50 (0.50 to 0.50)", text)
        self.assertNotIn("Same", text)

    def test_a_change_on_one_family_only_does_not_count(self):
        found, _ = self.found()
        better = [entry for entry in found.values() if (entry.method, entry.error) == ("better", "h1_error")]
        self.assertEqual([len(cases) for cases in changed(better)[0].values()], [2])
        for change, interval in ((0.0, (-0.1, 0.1)), (-0.5, (-0.6, -0.4)), (0.05, (0.04, 0.06)), (0.5, (-0.1, 1.1))):
            self.assertEqual(changed([better[0], replace(better[1], change=change, change_interval=interval)]), ({}, 1))

    def test_two_sizes_have_no_order(self):
        found, results = self.found(sizes=(1, 0.5))
        self.assertEqual(found, {})
        self.assertEqual(main([str(self.folder / "r"), "--quiet", "--no-figures"]), 0)
        self.assertFalse((self.folder / "r" / "tables" / "table_orders.md").exists())
        self.assertNotIn("Order or constant", (self.folder / "r" / "tables" / "findings.md").read_text())
        self.assertEqual(what_orders(results, []), [])

    def test_table(self):
        self.found(noise=0.1)
        self.assertEqual(main([str(self.folder / "r"), "--quiet", "--only", "table_orders"]), 0)
        with open(self.folder / "r" / "tables" / "table_orders.csv", newline="", encoding="utf-8") as stream:
            rows = {(row["Family"], row["Method"]): row for row in csv.DictReader(stream)}
        self.assertEqual(len(rows), 8)
        row = rows["a", "Better"]
        low, high = map(float, row["Order of H1 interval"].split(" to "))
        self.assertLess(low, high)
        self.assertAlmostEqual(0.5 * (low + high), float(row["Order of H1"]), delta=0.011)
        self.assertEqual(rows["a", "Failing"]["Sizes"], "2")


class Slope(unittest.TestCase):
    def test_slope_and_interval_are_those_of_scipy(self):
        random = np.random.default_rng(1)
        x = random.normal(size=6)
        y = 2.0 * x + random.normal(size=6)
        expected = stats.linregress(x, y)
        found, (low, high) = slope(x, y)
        self.assertAlmostEqual(found, expected.slope)
        half = stats.t.ppf(0.975, 4) * expected.stderr
        np.testing.assert_allclose((low, high), (expected.slope - half, expected.slope + half))
        self.assertTrue(np.isnan(slope(x[:2], y[:2])[0]))


if __name__ == "__main__":
    unittest.main()
