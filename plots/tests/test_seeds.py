# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies that repeat their meshes with several seeds."""

import csv

from plots.claims.check import FAILS, HOLDS, UNKNOWN, check_claims
from plots.claims.report import claims_as_markdown
from plots.results.rows import ResultsError
from plots.results.smoothing import read_results
from plots.study_kinds import outputs_of
from plots.tables.seeds import make_seed_tables
from plots.tests.synthetic_results import change_provenance, write_csv, write_results
from plots.tests.test_read_results import InFolder

MESHES = ("tri", "quad", "tri.seed-5", "tri.seed-7")
# Of GETMe's resulting mesh.
Q_MIN = {"tri": "0.3", "tri.seed-5": "0.1", "tri.seed-7": "0.2", "quad": "0.9"}


def write_seeds(folder):
    """Results of a mesh with the seeds 3, 5 and 7, and of one that no seed changes."""
    write_results(folder, meshes=MESHES)
    with open(folder / "summary.csv", newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    for row in rows:
        if row["method"] == "getme":
            row["q_min"] = Q_MIN[row["mesh"]]
    write_csv(folder / "summary.csv", list(rows[0]), rows)
    change_provenance(folder, meshes=[
        {"name": "tri", "title": "Triangles", "seed": 3}, {"name": "quad", "title": "Quadrilaterals", "seed": 1},
        {"name": "tri.seed-5", "seed": 5, "repeats": "tri"}, {"name": "tri.seed-7", "seed": 7, "repeats": "tri"}])
    return folder


def claim(condition, mesh="tri"):
    """One about GETMe's lowest quality."""
    return {"id": "X1", "section": "1", "statement": "s", "criterion": "c",
            "checks": [{"quantity": f"q_min('{mesh}', 'getme')", "condition": condition}]}


class Seeds(InFolder):
    def setUp(self):
        super().setUp()
        write_seeds(self.folder / "seeds")

    def results(self):
        return read_results(self.folder / "seeds")

    def test_are_repetitions_of_the_same_meshes(self):
        results = self.results()
        self.assertEqual(results.meshes, ("tri", "quad"))
        self.assertEqual((results.seeds, results.repeated), ((3, 5, 7), ("tri",)))
        self.assertEqual(len(results.repetitions), 2)
        for each, q_min in zip((results, *results.repetitions), ("0.3", "0.1", "0.2")):
            self.assertEqual(each.meshes, ("tri", "quad"))
            self.assertEqual(set(each.iterations.text("mesh")), {"tri", "quad"})
            self.assertEqual(each.summary.select(mesh="tri", method="getme").text("q_min")[0], q_min)
            self.assertEqual(each.summary.select(mesh="quad", method="getme").text("q_min")[0], "0.9")

    def test_one_seed_is_as_before(self):
        results = read_results(write_results(self.folder / "one"))
        self.assertEqual((results.seeds, results.repeated, results.repetitions), ((), (), ()))
        self.assertEqual(make_seed_tables(results), [])

    def test_table_of_median_and_range(self):
        tables = make_seed_tables(self.results())
        self.assertEqual([table.name for table in tables],
                         ["table_seeds_smoothing", "table_seeds_solver", "table_seeds_errors"])
        smoothing = tables[0]
        self.assertEqual([cells[0].text for cells in smoothing.keys], ["tri", "", ""])  # not quad
        of_getme = [cells[1].text for cells in smoothing.keys].index("GETMe")
        group = next(group for group in smoothing.groups if group.heading.text == "q_min")
        self.assertEqual(group.subheadings, ("median", "least", "greatest"))
        self.assertEqual([cell.text for cell in group.cells[of_getme]], ["0.2000", "0.1000", "0.3000"])
        self.assertIn("3, 5, 7", smoothing.notes[0][1])
        self.assertIn("table_seeds_errors", outputs_of(self.folder / "seeds").names)

    def test_claims_are_judged_on_the_median(self):
        for condition, verdict, seeds in (("value > 0.15", HOLDS, "2 of 3 seeds"),
                                          ("value > 0.25", FAILS, "1 of 3 seeds"),
                                          ("value == 0.2", HOLDS, "1 of 3 seeds")):
            outcome, = check_claims([claim(condition)], self.results(), {})
            self.assertEqual((outcome.verdict, outcome.seeds, outcome.computed), (verdict, seeds, "0.2"))
        outcome, = check_claims([claim("value > 0", "none")], self.results(), {})
        self.assertEqual(outcome.verdict, UNKNOWN)

    def test_claims_say_what_the_seeds_say(self):
        results = self.results()
        text = claims_as_markdown(check_claims([claim("value > 0.15")], results, {}), results)
        self.assertIn("| holds (holds for 2 of 3 seeds) |", text)
        self.assertIn("Repeated with the seeds 3, 5, 7: tri.", text)

    def test_seeds_with_other_rows_are_refused(self):
        folder = write_seeds(self.folder / "gap")
        with open(folder / "summary.csv", newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        write_csv(folder / "summary.csv", list(rows[0]),
                  [row for row in rows if (row["mesh"], row["method"]) != ("tri.seed-5", "getme")])
        with self.assertRaisesRegex(ResultsError, "not every seed has the same meshes and methods"):
            make_seed_tables(read_results(folder))
