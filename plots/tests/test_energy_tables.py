# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of methods that move nodes by the solution."""

import csv

from plots.results.smoothing import read_results
from plots.tables.energy import make_energy_tables
from plots.tests.synthetic_results import COLUMNS, write_csv, write_results
from plots.tests.test_read_results import InFolder

MESHES = ("tri", "tri-fine")


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def write_solves(folder, here=("0.5", "1.0"), refined=("0.6", "2.0")):
    """The method getme becomes one that solves: its start has the error 2, after 5 and 10 solves it is 1 and
    0.5. here, refined: error and seconds of its result and of the other method's on the refined mesh."""
    write_results(folder, meshes=MESHES)
    iterations = rows_of(folder / "iterations.csv")
    for row in iterations:
        row["n_solves"] = row["method_solve_seconds"] = ""
        if row["method"] == "getme":
            k = int(float(row["iteration"]))
            row.update(stage=("initial", "start", "descent", "descent")[k], n_solves=("0", "0", "5", "10")[k],
                       h1_error=("9", "2", "1", "0.5")[k], l2_error=("9", "1", "2", "0.25")[k])
    write_csv(folder / "iterations.csv", [*COLUMNS, "n_solves", "method_solve_seconds"], iterations)
    summary = rows_of(folder / "summary.csv")
    for row in summary:
        for mesh, method, (error, seconds) in (("tri", "getme", here), ("tri-fine", "weighted-laplace", refined)):
            if (row["mesh"], row["method"]) == (mesh, method):
                row.update(h1_error=error, smoothing_seconds=seconds, cg_seconds="0.0")
    write_csv(folder / "summary.csv", list(summary[0]) + ["preparation_seconds"],
              [{**row, "preparation_seconds": "0.0"} for row in summary])
    return read_results(folder)


def texts(group):
    return [[cell.text for cell in cells] for cells in group.cells]


class EnergyTables(InFolder):
    def test_factors_are_those_of_the_start_over_the_error_after_so_many_solves(self):
        factors, _ = make_energy_tables(write_solves(self.folder / "r"))
        self.assertEqual(texts(factors.groups[0])[0], ["2.00", "4.00", "–"])
        self.assertEqual(texts(factors.groups[1])[0], ["0.50", "4.00", "–"])

    def verdict(self, name, **numbers):
        _, pays = make_energy_tables(write_solves(self.folder / name, **numbers))
        return texts(pays.groups[-1])[0]

    def test_a_method_pays_only_where_neither_error_nor_time_is_larger(self):
        self.assertEqual(self.verdict("a"), ["pays"])
        self.assertEqual(self.verdict("b", here=("0.7", "1.0")), ["does not pay"])
        self.assertEqual(self.verdict("c", here=("0.5", "3.0")), ["does not pay"])
        self.assertEqual(self.verdict("d", here=("", "1.0")), ["–"])

    def test_against_refinement(self):
        """Refined, four times the unknowns have half the error in four times the time: order 1/2 in both."""
        folder = self.folder / "r"
        write_solves(folder, here=("0.25", "4.0"), refined=("1.0", "4.0"))
        summary = rows_of(folder / "summary.csv")
        for row in summary:
            row["n_free"] = "40" if row["mesh"] == "tri-fine" else "10"
            if (row["mesh"], row["method"]) == ("tri", "weighted-laplace"):
                row.update(h1_error="2.0", smoothing_seconds="1.0", cg_seconds="0.0")
        write_csv(folder / "summary.csv", list(summary[0]), summary)
        _, pays = make_energy_tables(read_results(folder))
        self.assertEqual(texts(pays.groups[2])[0], ["0.25", "64.0"])
        self.assertEqual(texts(pays.groups[-1])[0], ["pays"])
        for row in summary:
            if (row["mesh"], row["method"]) == ("tri-fine", "weighted-laplace"):
                row["smoothing_seconds"] = "1.9"  # not of its size
        write_csv(folder / "summary.csv", list(summary[0]), summary)
        _, pays = make_energy_tables(read_results(folder))
        self.assertEqual(texts(pays.groups[2])[0], ["–", "64.0"])

    def test_studies_without_solves_have_none(self):
        self.assertEqual(make_energy_tables(read_results(write_results(self.folder / "r"))), [])
