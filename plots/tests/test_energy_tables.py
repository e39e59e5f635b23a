# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of methods that move nodes by the solution."""

import csv
import json
import math

from plots.results.smoothing import read_results
from plots.tables.energy import make_energy_tables, solves_to_pay
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


def table(results, name):
    """One of the tables, by its name without what all begin with."""
    return next(table for table in make_energy_tables(results) if table.name == f"table_energy{name}")


def texts(group):
    return [[cell.text for cell in cells] for cells in group.cells]


class EnergyTables(InFolder):
    def test_factors_are_those_of_the_start_over_the_error_after_so_many_solves(self):
        """It has made 10; 20 are more than it took."""
        factors = table(write_solves(self.folder / "r"), "")
        self.assertEqual(texts(factors.groups[0])[0], ["2.00", "4.00", "4.00"])
        self.assertEqual(texts(factors.groups[1])[0], ["0.50", "4.00", "4.00"])

    def verdict(self, name, **numbers):
        pays = table(write_solves(self.folder / name, **numbers), "_pays")
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
        pays = table(read_results(folder), "_pays")
        self.assertEqual(texts(pays.groups[2])[0], ["0.25", "64.0", "–"])
        self.assertEqual(texts(pays.groups[-1])[0], ["pays"])
        for row in summary:
            if (row["mesh"], row["method"]) == ("tri-fine", "weighted-laplace"):
                row["smoothing_seconds"] = "1.9"  # not of its size
        write_csv(folder / "summary.csv", list(summary[0]), summary)
        pays = table(read_results(folder), "_pays")
        self.assertEqual(texts(pays.groups[2])[0], ["–", "64.0", "–"])

    def cells_against(self, name, here, ways):
        """Cells of the first row compared with ways: (file, mesh, method, degree) -> (error, seconds of smoothing, of
        solving)."""
        folder = self.folder / name
        write_solves(folder, here=here)
        rows = rows_of(folder / "summary.csv")
        header = list(rows[0])
        kept = [row for row in rows if (row["mesh"], row["method"], row["degree"]) == ("tri", "getme", "1")]
        chosen = {"summary": kept, "refined": []}
        for (file, mesh, method, degree), (error, smoothing, solving) in ways.items():
            chosen[file].append({**kept[0], "mesh": mesh, "method": method, "degree": degree, "h1_error": error,
                                 "smoothing_seconds": smoothing, "cg_seconds": solving})
        iterations = [row for row in rows_of(folder / "iterations.csv") if (row["mesh"], row["degree"]) == ("tri", "1")]
        write_csv(folder / "iterations.csv", list(iterations[0]), iterations)
        for file, file_rows in chosen.items():
            write_csv(folder / f"{file}.csv", header, file_rows)
        alternatives = table(read_results(folder), "_alternatives")
        return [text for group in alternatives.groups for text in texts(group)[0]]

    def test_against_the_best_way_in_no_more_time(self):
        ways = {("summary", "tri", "initial", "1"): ("5", "", "0.1"),
                ("summary", "tri", "weighted-laplace", "1"): ("3", "0.5", "0.1"),
                ("summary", "tri", "weighted-laplace", "2"): ("0.4", "0.5", "0.6"),
                ("refined", "tri", "initial", "1"): ("2.5", "", "0.9"),
                ("refined", "tri", "weighted-laplace", "1"): ("1", "", "0.4"),
                ("summary", "tri-fine", "weighted-laplace", "1"): ("0.9", "0.9", "0.3")}
        cells = self.cells_against("a", ("0.5", "1.0"), ways)
        self.assertEqual(cells, ["5.000e-01", "1.000", "–", "weighted-laplace, split", "1.000e+00", "2.00", "pays"])
        cells = self.cells_against("b", ("0.5", "1.2"), ways)
        self.assertEqual(cells[3:], ["weighted-laplace, d = 2", "4.000e-01", "0.80", "does not pay"])
        cells = self.cells_against("c", ("0.8", "1.2"), {key: ways[key] for key in list(ways)[-1:]})
        self.assertEqual(cells[3:], ["weighted-laplace, finer", "9.000e-01", "1.12", "pays"])
        cells = self.cells_against("d", ("0.8", "0.05"), ways)
        self.assertEqual(cells[3:], ["–", "–", "–", "pays"])
        cells = self.cells_against("e", ("", "1.0"), ways)
        self.assertEqual(cells[-1], "–")

    def test_meshes_as_they_are_are_no_other_way(self):
        ways = {("summary", "tri", "weighted-laplace", "1"): ("3", "0.5", "0.1")}
        with self.assertRaises(StopIteration):
            self.cells_against("f", ("0.5", "1.0"), ways)

    def test_from_how_many_solves_on_a_method_pays(self):
        """Half the error by refinement: 4 times the smoothing, 8 times the solution. The method: a quarter, so 16 and 64."""
        unrefined = {"error": 2.0, "smoothing": 1.0, "solution": 0.5}
        refined = {"error": 1.0, "smoothing": 4.0, "solution": 4.0}
        self.assertEqual(solves_to_pay({"error": 0.5, "smoothing": 116.0, "solution": 0.5}, refined, unrefined), 4)
        self.assertEqual(solves_to_pay({"error": 0.5, "smoothing": 16.0, "solution": 0.5}, refined, unrefined), 1)
        self.assertEqual(solves_to_pay({"error": 0.5, "smoothing": 116.0, "solution": 33.0}, refined, unrefined), math.inf)
        self.assertTrue(math.isnan(solves_to_pay({"error": 0.5, "smoothing": 1.0, "solution": 0.5}, unrefined, refined)))

    def test_many_solutions_on_one_mesh(self):
        """Errors of two solutions are 1/2 and 1/8 of those on the other method's mesh, in the mean 1/4; refined, with four
        times the unknowns, they are 1/2 in four times the time. So the same takes 16 times the smoothing and solving. The
        error of a third one, which the mesh is not made for, is doubled."""
        folder = self.folder / "r"
        write_solves(folder)
        summary = rows_of(folder / "summary.csv")
        smoothing = {("tri", "weighted-laplace"): "1", ("tri-fine", "weighted-laplace"): "4", ("tri", "getme"): "40"}
        for row in summary:
            row.update(n_free="40" if row["mesh"] == "tri-fine" else "10",
                       smoothing_seconds=smoothing.get((row["mesh"], row["method"]), "9"))
        write_csv(folder / "summary.csv", list(summary[0]), summary)
        errors = {("tri", "weighted-laplace"): (8, 80, 3), ("tri-fine", "weighted-laplace"): (4, 40, 2),
                  ("tri", "getme"): (4, 10, 6)}
        solves = {"tri": "0.5", "tri-fine": "2"}
        write_csv(folder / "solutions.csv", ["mesh", "method", "solution", "degree", "cg_seconds", "h1_error", "status"],
                  [{"mesh": mesh, "method": method, "solution": solution, "degree": degree, "cg_seconds": solves[mesh],
                    "h1_error": str(error), "status": "ok"}
                   for (mesh, method), both in errors.items() for solution, error in zip("abc", both)
                   for degree in ("1", "2")])
        provenance = json.loads((folder / "provenance.json").read_text(encoding="utf-8"))
        for entry in provenance["methods"]:
            if entry["name"] == "getme":
                entry["smooth_for"] = ["a", "b"]
        (folder / "provenance.json").write_text(json.dumps(provenance), encoding="utf-8")
        many = table(read_results(folder), "_many")
        self.assertEqual([texts(group)[0] for group in many.groups],
                         [["2"], ["0.250", "2.000", "0.500"], ["40.000", "1.000", "32.000"], ["2"], ["does not pay"]])

    def test_orders_are_those_of_three_sizes(self):
        """Half the edge length: four times the cells in the plane, a quarter of the L2 error, half the H1 error."""
        folder = self.folder / "r"
        write_solves(folder)
        meshes = (*MESHES, "tri-finer")
        summary, iterations = rows_of(folder / "summary.csv"), rows_of(folder / "iterations.csv")
        one_mesh = [row for row in summary if row["mesh"] == "tri"]
        sized = [{**row, "mesh": mesh, "h1_error": str(3 / 2**k), "l2_error": str(5 / 4**k)}
                 for k, mesh in enumerate(meshes) for row in one_mesh]
        write_csv(folder / "summary.csv", list(summary[0]), sized)
        write_csv(folder / "iterations.csv", list(iterations[0]),
                  iterations + [{**row, "mesh": "tri-finer"} for row in iterations if row["mesh"] == "tri"])
        provenance = json.loads((folder / "provenance.json").read_text(encoding="utf-8"))
        provenance["meshes"] = [{**provenance["meshes"][0], "name": mesh, "dimension": 2, "n_cells": 200 * 4**k}
                                for k, mesh in enumerate(meshes)]
        (folder / "provenance.json").write_text(json.dumps(provenance), encoding="utf-8")
        orders = table(read_results(folder), "_orders")
        self.assertEqual(texts(orders.groups[0])[0], ["1.00"])
        self.assertEqual(texts(orders.groups[1])[0], ["2.00"])

    def test_studies_without_solves_have_none(self):
        self.assertEqual(make_energy_tables(read_results(write_results(self.folder / "r"))), [])
