# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of the solvers of a study that are not Poisson's."""

import csv

from plots.__main__ import main
from plots.results.smoothing import read_results
from plots.tables.solvers import make_solver_tables
from plots.tests.synthetic_results import change_provenance, write_csv, write_results
from plots.tests.test_read_results import InFolder

STRESS = {"column": "beam.stress", "unit": "MPa", "meaning": "Largest stress."}


class SolverTables(InFolder):
    def setUp(self):
        super().setUp()
        self.results = self.folder / "r"
        write_results(self.results)

    def tables(self, columns, **solver):
        """The tables of a study whose solver `beam` has given these columns: name -> function of a row."""
        path = self.results / "summary.csv"
        with open(path, newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        for row in rows:
            row.update({name: value(row) for name, value in columns.items()})
        write_csv(path, [*rows[0]], rows)
        change_provenance(self.results, solvers=[{"label": "beam", "title": "Beam", "degrees": [], "numbers": [STRESS], **solver}])
        return make_solver_tables(read_results(self.results))

    def test_a_solver_without_degrees_has_one_row_for_each_mesh_and_method(self):
        table, = self.tables({"beam.stress": lambda row: "2.5" if row["method"] == "initial" else "2.25"})
        self.assertEqual(table.name, "table_solver_beam")
        self.assertEqual([heading.text for heading in table.key_headings], ["Mesh", "Method"])
        self.assertEqual([row[0].text for row in table.groups[0].cells], ["2.5000"] + ["2.2500"] * (len(table.keys) - 1))
        self.assertIn(("", "stress [MPa]: Largest stress."), table.notes)

    def test_a_solver_with_degrees_has_rows_of_these(self):
        table, = self.tables({"beam.n": lambda row: "7" if row["degree"] == "2" else ""}, degrees=[2])
        self.assertEqual({row[0].text for row in table.groups[0].cells}, {"7"})
        self.assertEqual({cells[1].text for cells in table.keys} - {""}, {"2"})

    def test_times_are_left_out_and_said(self):
        table, = self.tables({"beam.stress": lambda row: "1", "beam.cg_seconds": lambda row: "0.5"})
        self.assertEqual([group.heading.text for group in table.groups], ["stress"])
        self.assertIn("times", table.notes[-1][1])

    def test_tables_of_earlier_numbers_are_removed(self):
        self.tables({"beam.stress": lambda row: "1"})
        self.assertEqual(main([str(self.results), "--no-figures", "--quiet"]), 0)
        table = self.results / "tables" / "table_solver_beam.md"
        self.assertTrue(table.is_file())
        self.tables({"beam.stress": lambda row: ""})
        self.assertEqual(main([str(self.results), "--no-figures", "--quiet"]), 0)
        self.assertFalse(table.exists())

    def test_a_solver_that_failed_everywhere_has_none(self):
        self.assertEqual(self.tables({"beam.stress": lambda row: ""}), [])
        self.assertEqual(make_solver_tables(read_results(self.results)), [])
