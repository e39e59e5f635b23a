# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers in doc/smoothing-for-the-error.md that come from results/reference are those of its tables."""

import csv
import io
import re
import unittest

from plots.claims.overview import reference
from plots.results.data_folder import data_folder
from plots.results.rows import read_rows
from plots.results.smoothing import read_results
from plots.tables.energy import factor_table, orders_table
from plots.tables.formats import as_csv
from plots.tables.number_format import MISSING

FIXED = ("Weights", "Descent", "Moving mesh and descent")
SLIDING = ("Weights, sliding", "Moving mesh and descent, sliding")
# Rows of the tutorial's table -> method, and what the meshes are called, in the tables of energy-front and energy-layer ...
ROWS = {"indicator-weighted": ("Weights", ""), "indicator-mmpde (of 5 solves, then descent)": ("Moving mesh and descent", ""),
        "the same, sliding": ("Moving mesh and descent, sliding", ""),
        "that on 10,895 and 9,409 nodes": ("Moving mesh and descent, sliding", ", refined")}
# ... and in those of energy-front-variants and energy-layer-variants.
VARIANTS = {"the same, indicator averaged 4 times": "Weights, averaged 4 times", "no quality floor": "Weights, no quality floor",
            "60 sweeps": "Weights, 60 sweeps", "residual in place of the recovery": "Weights by the residual",
            "residual of degree 2": "Weights by the residual of degree 2", "sliding": "Weights, sliding",
            "indicator-aligned, sliding": "Aligned, sliding", "indicator-getme": "GETMe with sizes"}


def by_key(rows):
    """(mesh, degree, method) -> record of a table, as printed."""
    return {(row["Mesh"], row["d"], row["Method"]): row for row in rows}


def table(study, name):
    """A table of the reference."""
    return by_key(read_rows(reference() / study / "tables" / f"{name}.csv", ("Mesh", "d", "Method")).records())


def reason_table(name, make):
    """A table that is made of a reason's results, which has none in the reference."""
    return by_key(csv.DictReader(io.StringIO(as_csv(make(read_results(reference() / "reasons" / name))))))


def gains(study):
    """(solution, elements, degree, method) -> record of a collection's table of gains, as printed."""
    rows = read_rows(reference() / study / "tables" / "table_energy_gains.csv").records()
    return {tuple(row[name] for name in ("Solution", "Elements", "d", "Method")): row for row in rows}


def short(number):
    """0.84 as .84."""
    return number.removeprefix("0")


def orders(study, meshes, degree, methods):
    """Orders in H1, ascending, as printed."""
    rows = table(study, "table_energy_orders")
    return sorted((rows[mesh, degree, method]["Order of H1"] for mesh in meshes for method in methods), key=float)


def best(study, mesh, degree, methods):
    """The highest of these orders."""
    return short(orders(study, (mesh,), degree, methods)[-1])


def orders_with_more_solves():
    """Of sliding weights in the corner of the L with 60 solves: at degree 1, at degree 2."""
    rows = reason_table("l-shape-solves", orders_table)
    return [[short(rows[mesh, d, "Weights, sliding"]["Order of H1"]) for mesh in ("Tri", "Quad")] for d in "12"]


def orders_with_other_parameters():
    """Ranges over triangles and quadrilaterals, and over other parameters of sliding weights of 60 solves: at degree 1, at degree 2."""
    rows = reason_table("l-shape-weights", orders_table)
    others = ("Power 3.5", "No averaging", "60 sweeps", "Floor .02", "Residual", "Power, averaging, sweeps and floor")
    found = [sorted((rows[mesh, d, method]["Order of H1"] for mesh in ("Tri", "Quad") for method in others), key=float) for d in "12"]
    return [(short(each[0]), short(each[-1])) for each in found]


def phrases():
    """What the tutorial has to say of re-entrant corners."""
    flat, solid = ("Tri", "Quad"), ("Tet", "Hex")
    fixed = sorted((order for d in "12" for order in orders("energy-l-shape", flat, d, FIXED)), key=float)
    yield f"methods stay at {short(fixed[0])} to {short(fixed[-1])};"
    one, two = ([best("energy-l-shape", mesh, d, SLIDING[:1]) for mesh in flat] for d in "12")
    yield f"weights come to {one[0]} (triangles) and {one[1]} (quadrilaterals) at degree 1"
    yield f"and to {two[0]} and {two[1]} at degree 2"
    one, two = orders_with_more_solves()
    yield f"with 60 weights come to {one[0]} and {one[1]}, and to {two[0]} and {two[1]}"
    one, two = orders_with_other_parameters()
    yield f"have orders of {one[0]} to {one[1]}, and of {two[0]} to {two[1]} (`reasons/l-shape-weights`)"
    getme = [best("energy-fichera", mesh, d, ("GETMe",)) for d in "12" for mesh in solid]
    yield f"orders in H1 of {getme[0]} and {getme[1]} at degree 1, and of {getme[2]} and {getme[3]} at degree 2"
    fixed = [best("energy-fichera", mesh, d, FIXED) for d in "12" for mesh in solid]
    methods = f"methods come to {fixed[0]} and {fixed[1]}, and to {fixed[2]} and {fixed[3]};"
    one = [best("energy-fichera", mesh, "1", SLIDING) for mesh in solid]
    two = [best("energy-fichera", mesh, "2", SLIDING) for mesh in solid]
    yield f"{methods} with nodes that slide to {one[0]} and {one[1]}, and to {two[0]} and {two[1]}"
    rows = reason_table("fichera-solves", orders_table)
    moving, weights, sweeps, floor = (rows["Tet", "2", method]["Order of H1"] for method in (
        *reversed(SLIDING), "Weights of 60 sweeps, sliding", "Weights of floor .02, sliding"))
    yield f"(60: {moving} in place of {two[0]}, and for weights {weights}) or of sweeps ({sweeps})"
    yield f"weights come to {floor} (`results/reference/reasons/fichera-solves`)"


class TutorialNumbers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.text = (data_folder() / "doc" / "smoothing-for-the-error.md").read_text(encoding="utf-8")
        cls.line = " ".join(cls.text.split())

    def test_orders_are_those_of_the_tables(self):
        for phrase in phrases():
            self.assertIn(phrase, self.line)

    def test_cases_that_pay_are_those_of_the_tables(self):
        lines = re.findall(r"^\| (energy[\w-]*) \|(.*)\|$", self.text, re.MULTILINE)
        self.assertGreater(len(lines), 2)
        for study, cells in lines:
            rows = table(study, "table_energy_alternatives").items()
            expected = []
            for degree in "12":
                chosen = [row for (_, d, _), row in rows if d == degree]
                gains = [float(row["Gain"]) for row in chosen if row["Gain"] not in ("", "–")]
                expected += [f"{sum(row['Verdict'] == 'pays' for row in chosen)} of {len(chosen)}" if chosen else MISSING,
                             f"{max(gains):.2f}" if gains else MISSING]
            self.assertEqual([cell.strip() for cell in cells.split("|")], expected, study)

    def test_factors_are_those_of_the_tables(self):
        expected = {name: [tables[study][f"{mesh}{kind}", "1", method] for mesh in ("Tri", "Quad") for study in tables]
                    for tables in [{study: table(f"energy-{study}", "table_energy") for study in ("front", "layer")}]
                    for name, (method, kind) in ROWS.items()}
        expected |= {name: [tables[study][mesh, "1", method] for mesh in ("Tri", "Quad") for study in tables]
                     for tables in [{study: table(f"energy-{study}-variants", "table_energy") for study in ("front", "layer")}]
                     for name, method in VARIANTS.items()}
        begin = self.text.index("What was tried on the unit square")
        lines = re.findall(r"^\| ([^|]*) \|(.*)\|$", self.text[begin:], re.MULTILINE)
        found = {name: [cell.strip() for cell in cells.split("|")] for name, cells in lines if name in expected}
        self.assertEqual(found, {name: [row["H1 after solves 20"] for row in rows] for name, rows in expected.items()})

    def test_recovery_lowers_errors_of_degree_2_more_than_the_residual_of_degree_2(self):
        for study in ("front", "layer"):
            rows = table(f"energy-{study}-variants", "table_energy")
            for mesh in ("Tri", "Quad"):
                both = [float(rows[mesh, "2", method]["H1 after solves 20"])
                        for method in ("Weights", "Weights by the residual of degree 2")]
                self.assertGreater(*both)

    def test_least_factors_of_many_meshes_are_those_of_the_table(self):
        rows = gains("energy-robust")
        lines = re.findall(r"^\| (triangles|quadrilaterals) \| ([^|]*) \|(.*)\|$", self.text, re.MULTILINE)
        self.assertEqual(len(lines), len(rows) / 6)
        for elements, method, cells in lines:
            expected = [rows[solution, elements, d, method]["H1 least"] for solution in ("front", "layer", "peak") for d in "12"]
            self.assertEqual([cell.strip() for cell in cells.split("|")], expected, (elements, method))
        self.assertEqual({row["Members"] for row in rows.values()}, {"22"})
        self.assertEqual({row["With invalid cells"] for row in rows.values()}, {"0"})

    def test_factors_on_five_domains_are_those_of_the_table(self):
        rows = gains("energy-field")
        expected = {(method, elements): [f"{rows[solution, elements, '1', method]['H1 median']} "
                                         f"({rows[solution, elements, '1', method]['H1 least']})"
                                         for solution in ("front", "layer", "peak")] for _, elements, _, method in rows}
        lines = re.findall(r"^\| ([^|\n]*) \| (\w+) \| ([^|\n]*\)) \| ([^|\n]*\)) \| ([^|\n]*\)) \|$", self.text, re.MULTILINE)
        self.assertEqual({(method, elements): cells for method, elements, *cells in lines}, expected)
        self.assertEqual({row["With invalid cells"] for row in rows.values()}, {"0"})

        summary = read_rows(reference() / "energy-field" / "summary.csv").records()
        getme = {row["member"]: float(row["h1_error"]) for row in summary if row["method"] == "getme"}
        factors = [(getme[row["member"]] / float(row["h1_error"]), row["elements"], row["domain"], row["solution"], row["method"])
                   for row in summary if row["method"] not in ("initial", "getme")]
        self.assertGreaterEqual(min(factors)[0], 1)
        self.assertEqual({case[1:] for case in factors if case[0] == 1}, {("tetrahedra", "fichera", "peak", "weights")})
        for elements in ("triangles", "quadrilaterals"):
            self.assertEqual(min(case for case in factors if case[1] == elements)[2], "gear")

    def test_cost_on_five_domains_is_that_of_the_table(self):
        folder = reference() / "energy-field"
        times = sorted(float(row["Time / initial"]) for row in read_rows(folder / "tables" / "table_payoff.csv").records()
                       if row["Instead"] in ("Weights", "Descent", "Moving mesh and descent, sliding"))
        self.assertIn(f"take {times[0]:.0f} to {times[-1]:.0f} times as long as one solution of the initial mesh", self.line)
        found = (folder / "tables" / "findings.md").read_text(encoding="utf-8")
        self.assertIn("error is surely lower than the unsmoothed mesh's in 1 of 5 families and degrees, surely higher in 3;", found)
        self.assertIn("gear, d = 1, at equal time in all: of the methods GETMe does best, with 0.", found)
        nodes = sorted(int(row["n_nodes"]) for row in read_rows(folder / "members.csv").records())
        self.assertIn(f"{len(nodes)} small meshes of {nodes[0]} to {nodes[-1]:,} nodes", self.line)

    def test_factors_in_corners_of_many_meshes_are_those_of_the_table(self):
        rows = gains("energy-corners")
        self.assertEqual({(row["Members"], row["With invalid cells"]) for row in rows.values()}, {("22", "0")})
        self.assertGreater(min(float(row["H1 least"]) for row in rows.values()), 1)
        one, two = ("{}, {}, {} and {}".format(*(rows["", elements, d, "Weights, sliding"]["H1 least"] for elements in (
            "triangles", "quadrilaterals", "tetrahedra", "hexahedra"))) for d in "12")
        self.assertIn(f"have the least factors {one} at degree 1 and {two} at degree 2 (triangles", self.line)
        found = (reference() / "energy-corners" / "tables" / "findings.md").read_text(encoding="utf-8")
        self.assertIn("error is surely lower than the unsmoothed mesh's in 0 of 2 families and degrees, surely higher in 2;", found)

    def test_meshes_for_many_are_those_of_the_table(self):
        rows = table("energy-many", "table_energy_many")
        error, times = "H1 error over GETMe's here", "Times until it pays"
        for n in "1248":
            chosen = [rows[mesh, d, f"Moving mesh and descent for {n}"] for mesh in ("Tri", "Quad") for d in "12"]
            self.assertIn("| ".join((f"| {n} ", *(f"{row[error]} " for row in chosen), "")).rstrip(), self.text)
        until = sorted(int(row[times]) for (_, d, _), row in rows.items() if d == "1")
        self.assertIn(f"have to be solved on it {until[0]} to {until[-1]} times at degree 1", self.line)
        paying = [(mesh, row["n"]) for (mesh, d, _), row in rows.items() if d == "2" and row[times] != "never"]
        self.assertEqual(paying, [("Tri", "1"), ("Tri", "2"), ("Quad", "1")])
        self.assertTrue(all(row["Verdict"] == "does not pay" for row in rows.values()))
        refined = "H1 error over GETMe's refined"
        self.assertEqual([{f"{float(row[refined]):.2f}" for (_, d, _), row in rows.items() if d == degree} for degree in "12"],
                         [{"0.50"}, {"0.25"}])
        others = "H1 error over GETMe's of the others"
        for row in rows.values():
            if row["n"] != "8":
                self.assertEqual(float(row[others]) > 1, row["n"] in "12")

    def test_gradient_costs_what_the_benchmark_printed(self):
        printed = (reference() / "speed.md").read_text(encoding="utf-8")
        ratios = dict(re.findall(r"^\| (\w+ \| \d) \|.* ([0-9.]+) \|$", printed, re.MULTILINE))
        percent = {case: f"{100 * float(ratio):.1f}" for case, ratio in ratios.items()}
        self.assertIn(f"{percent['tetrahedron | 1']} and {percent['tetrahedron | 2']} % of it on tetrahedra of degree 1 and 2, "
                      f"{percent['hexahedron | 1']} and {percent['hexahedron | 2']} % on hexahedra", self.line)

    def test_factors_in_space_and_in_the_plane_are_those_of_the_results(self):
        def factors(rows, meshes, d, method):
            return [rows[f"{mesh}{finer}", d, method]["H1 after solves 20"] for mesh in meshes for finer in ("", ", refined")]

        front, layer = (table(f"energy-{study}-volume", "table_energy") for study in ("front", "layer"))
        flat = reason_table("front-in-plane", factor_table)
        lines = re.findall(r"^\| ([^|\n]*) \| (\d) \|((?:[^|\n]*\|)+)$", self.text, re.MULTILINE)
        lines = [(method, d, [cell.strip() for cell in cells.split("|")[:-1]]) for method, d, cells in lines]
        fronts = [line for line in lines if len(line[2]) == 8]
        layers = [line for line in lines if len(line[2]) == 4 and line[0] in {one[0] for one in fronts}]
        self.assertGreater(min(len(fronts), len(layers)), 5)
        for method, d, cells in fronts:
            solid, plane = factors(front, ("Tet", "Hex"), d, method), factors(flat, ("Tri", "Quad"), d, method)
            self.assertEqual(cells, solid + plane, (method, d))
            self.assertLessEqual(max(float(two) / float(three) for two, three in zip(plane, solid)), 1.25)
        for method, d, cells in layers:
            self.assertEqual(cells, factors(layer, ("Tet", "Hex"), d, method), (method, d))
