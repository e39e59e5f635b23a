# SPDX-License-Identifier: GPL-3.0-or-later
"""Measured numbers next to the printed ones, in all formats."""

import csv
import math
import re
from dataclasses import replace
from fnmatch import fnmatchcase

from plots.results.data_folder import data_folder, thesis_folder
from plots.results.printed_values import as_guess, read_printed_tables
from plots.results.rows import read_rows
from plots.results.smoothing import read_results
from plots.results.symbols import Heading
from plots.tables.formats import TERMINAL_WIDTH, aligned, as_csv, as_markdown, as_text, group_width, split
from plots.tables.latex import as_latex, panels_of, tabular
from plots.tables.number_format import (format_error, format_quality, format_seconds, grouped, relative_difference,
                                        seconds_text)
from plots.tables.smoothing import make_tables, without_noise
from plots.tables.table import Cell, Group, Table, escape_tex, number_cell
from plots.tests.synthetic_results import (change_provenance, without_columns,
                                           without_finite_elements, write_csv, write_results)
from plots.tests.test_read_results import InFolder


class Numbers(InFolder):
    def test_relative_difference(self):
        for computed, printed, expected in (
                (110.0, "100", "+10.0"), (0.33674, "0.3367", "="), (377.4, "7.39e+02", "-48.9"),
                (1.0899e8, "1.09e+08", "="), (0.1, "0.0000", "–"), (math.nan, "1.0", "–"),
                (1.0, "", "–"), (1.00006, "1.0000", "<0.1"),
                (9.0, "1", "+800.0"), (30.0, "1", "×30"), (1.0, "0.0003", "×3,333")):
            self.assertEqual(relative_difference(computed, printed), expected)

    def test_thousands(self):
        for text, expected in (("40/221700", "40/221,700"), ("999", "999"), ("1234", "1,234"), ("–", "–"),
                               ("0.12345", "0.12345"), ("1.23e+04", "1.23e+04"), ("dense", "dense")):
            self.assertEqual(grouped(text), expected)

    def test_what_is_too_small_is_called_so(self):
        self.assertEqual(format_seconds([0.0, 4e-6, 0.0012, math.nan]), ["<0.0001", "<0.0001", "0.0012", "–"])
        self.assertEqual(format_quality([0.0, 9e-6, 0.5]), ["0.0000", "<0.0001", "0.5000"])
        self.assertEqual([seconds_text(value) for value in (0.0, 0.0226)], ["<0.0001", "0.0226"])
        rows = [{"reference_seconds": "0.1", "method_seconds": seconds, "speedup": "9"} for seconds in ("0.00001", "0.01", "")]
        self.assertEqual([row["speedup"] for row in without_noise(rows)], ["", "9", "9"])

    def test_decimal_points_stand_below_each_other(self):
        self.assertEqual(aligned(["1.5", "12", "7.39e+02", "–"], ["", "", "ᵃ", ""]), ["1.5      ", "12        ", "7.39e+02ᵃ", "–"])
        self.assertEqual(aligned(["1.5", "12.25"], ["", ""], "_"), ["1.5_", "12.25"])
        lines = tabular(Table("s", "t", "", (Heading("M", "M"),), ((Cell("a"),), (Cell("b"),), (Cell("c"),)), (), (), (
            Group(Heading("E", "E"), ("",), ((number_cell("5.32e-02"),), (number_cell("-3.2898", "a"),), (number_cell("–"),))),), ()))
        self.assertEqual(lines[0], r"\begin{tabular}{lr@{}l}")
        self.assertEqual(lines[4:7], [r"a & 5 & $.32\cdot10^{-2}$ \\", r"b & $-3$ & .2898\rlap{\textsuperscript{a}} \\",
                                      r"c & \multicolumn{2}{r}{--} \\"])

    def test_small_errors_get_exponents(self):
        self.assertEqual(format_error([1.5, math.nan]), ["1.5000", "–"])
        self.assertEqual(format_error([1.5, 2e-6]), ["1.5000e+00", "2.0000e-06"])


class Tables(InFolder):
    def tables(self, folder="r", **arguments):
        results = read_results(write_results(self.folder / folder, **arguments))
        printed = read_printed_tables(results.thesis_study, results.provenance)
        return {table.name: table for table in make_tables(results, printed)}

    def test_computed_next_to_printed(self):
        tables = self.tables()
        self.assertEqual(list(tables), ["table_6_1_smoothing", "table_6_2_solver", "table_6_3_errors",
                                        "table_6_4_thresholds", "table_details"])
        q_min = next(g for g in tables["table_6_1_smoothing"].groups if g.heading.text == "q_min")
        self.assertEqual(q_min.subheadings, ("smoothfem", "thesis", "%"))
        # Rows: initial, then in the order of the provenance GETMe, then area-weighted Laplace.
        self.assertEqual([cell.text for cell in q_min.cells[2]], ["0.2046", "0.2045", "<0.1"])
        condition = tables["table_6_2_solver"].groups[0]
        self.assertEqual([(c.text, c.mark) for c in condition.cells[2]],
                         [("3.77e+02", ""), ("7.39e+02", "a"), ("-48.9", "")])
        text = as_text(tables["table_6_2_solver"])
        self.assertIn("7.39e+02ᵃ  -48.9", text)
        self.assertIn("stand-ins", text)

    def test_volume_study_next_to_its_tables(self):
        tables = self.tables(study="volume", meshes=("tet", "hex"))
        self.assertEqual(list(tables)[:4], ["table_6_5_smoothing", "table_6_6_solver", "table_6_7_errors",
                                            "table_6_8_thresholds"])
        quality = next(g for g in tables["table_6_5_smoothing"].groups if g.heading.text == "q_min")
        self.assertEqual([cell.text for cell in quality.cells[2]], ["0.2046", "invalid", "–"])
        solver = tables["table_6_6_solver"]
        self.assertIn("with AMG", [group.heading.text for group in solver.groups])
        # A field that the thesis leaves empty has the mark of the note with the reason.
        condition = solver.groups[0].cells[2]
        self.assertEqual([(c.text, c.mark) for c in condition[1:]], [("–", "a"), ("–", "")])
        for name in ("table_6_5_smoothing", "table_6_6_solver", "table_6_7_errors"):
            self.assertIn("Not comparable: digits", as_text(tables[name]).replace("\n  ", " "))

    def test_columns_that_other_versions_lack(self):
        folder = write_results(self.folder / "old")
        absent = ("condition_residual", "amg_cg_iterations", "amg_setup_seconds", "amg_cg_seconds")
        for name in ("iterations.csv", "summary.csv"):
            without_columns(folder / name, absent)
        headings = [group.heading.text for group in self.tables_of("old", "solver").groups]
        self.assertEqual(headings, ["cond(A)", "CG iterations", "with Jacobi", "Time (s)"])

    def test_text_is_aligned_and_fits(self):
        for table in self.tables(meshes=("tri", "quad")).values():
            lines = as_text(table).split("\n\n")[1].splitlines()
            self.assertEqual(len({len(lines[0]), len(lines[-1])}), 1)
            self.assertLessEqual(max(map(len, as_text(table).splitlines())), TERMINAL_WIDTH)

    def test_other_study_has_no_printed_columns(self):
        tables = self.tables(study="slab", methods=("own_1", "getme"))
        self.assertEqual(list(tables), ["table_smoothing", "table_solver", "table_errors",
                                        "table_thresholds", "table_details"])
        for table in tables.values():
            self.assertNotIn(" thesis ", as_text(table).partition("\n\n  ")[0])
            self.assertTrue(all(group.subheadings == ("",) for group in table.groups))

    def test_study_without_finite_elements(self):
        without_finite_elements(write_results(self.folder / "s", study="own"))
        results = read_results(self.folder / "s")
        table, = make_tables(results, {})  # the table of details would have nothing to say
        self.assertIn("q*_min", [group.heading.text for group in table.groups])

    def test_failed_methods_have_a_reason_in_place_of_numbers(self):
        folder = write_results(self.folder / "s", study="own")
        for name in ("summary.csv", "iterations.csv"):
            with open(folder / name, newline="", encoding="utf-8") as stream:
                rows = list(csv.DictReader(stream))
            for row in rows:
                if row["method"] == "getme":
                    row.update(q_mean="0.123456", status="failed: it ended with exit code 7")
            write_csv(folder / name, list(rows[0]), rows)
        table = next(t for t in make_tables(read_results(folder), {}) if t.name == "table_smoothing")
        text = as_text(table)
        self.assertNotIn("0.1235", text)
        details = next(t for t in make_tables(read_results(folder), {}) if t.name == "table_details")
        self.assertEqual([cells[0].text for cells in details.groups[0].cells[1:3]], ["–", "1.5000"])  # q*_min
        self.assertIn("GETMe, Triangular mesh: failed: it ended with exit code 7.", text)

    def test_true_errors_come_first_and_norms_of_the_thesis_are_called_so(self):
        tables = {**self.tables(), **self.tables("own", study="slab")}
        self.assertEqual([group.heading.text for group in tables["table_6_3_errors"].groups],
                         ["H1 error", "L2 error", "e_max", "e_mean", "e_L2", "e_H1"])
        self.assertIn("e_max, e_mean, e_L2, e_H1: norms of the thesis", tables["table_6_3_errors"].notes[-2][1])
        self.assertEqual([group.heading.text for group in tables["table_errors"].groups], ["H1 error", "L2 error"])

    def test_coarse_meshes_are_not_compared(self):
        folder = write_results(self.folder / "q")
        change_provenance(folder, scale="quick")
        table = self.tables_of("q", "6_3_errors")
        self.assertEqual({group.subheadings for group in table.groups}, {("",)})
        self.assertIn(("", "Not compared with Table 6.3 of the thesis: meshes of the scale `quick` are too coarse."), table.notes)

    def test_an_invalid_result_has_a_sentence(self):
        folder = write_results(self.folder / "i", study="own")
        rows = read_rows(folder / "summary.csv").records()
        write_csv(folder / "summary.csv", list(rows[0]), [
            {**row, "status": "invalid mesh", "n_invalid": "3"} if row["method"] == "getme" else row for row in rows])
        self.assertIn(("", "GETMe, Triangular mesh: the mesh is invalid (3 cells); nothing was solved on it."),
                      self.tables_of("i", "errors").notes)

    def test_the_speedup_stays_next_to_its_time(self):
        keys = (Heading("Mesh", "Mesh"),)
        pair = [Group(Heading(f"{kind} {i}", ""), ("",), ((Cell("0.123"),),), tied)
                for i in range(9) for kind, tied in (("A rather long method", False), ("Speedup", True))]
        table = Table("own", "t", "", keys, ((Cell("tri"),),), (), (), tuple(pair), ())
        for panel in split(table, 100, group_width):
            self.assertEqual([group.tied for group in panel.groups], [False, True] * (len(panel.groups) // 2))

    def test_notes_on_columns_that_are_printed(self):
        without_finite_elements(write_results(self.folder / "p", "planar"))
        without_finite_elements(write_results(self.folder / "s", "sphere", ("tet",)))
        self.assertIn("only their proportions", as_text(self.tables_of("p", "smoothing")))
        self.assertNotIn("only their proportions", as_text(self.tables_of("s", "smoothing")))

    def test_note_of_the_study_is_below_the_printed_values(self):
        folder = write_results(self.folder / "n")
        change_provenance(folder, note="The shape is not that of the thesis.")
        text = as_text(self.tables_of("n", "smoothing"))
        self.assertIn("The shape is not that of the thesis.", text[text.index("Values of the thesis"):])

    def test_csv_can_be_read_by_programs(self):
        def row(*texts):
            return tuple(map(Cell, texts))
        heading = Heading("Cells", "Cells")
        table = Table("s", "t", "A, b", (Heading("Mesh", ""), Heading("d", "")),
                      (row("tri", "1"), row("", "2"), row('a "b", c', "1")), (), (),
                      (Group(heading, ("smoothfem", "%"), (row("1,234,567", "="), row("–", "×3,333"), row("12/5,099", "-1.5"))),), ())
        self.assertEqual(list(csv.reader(as_csv(table).splitlines())),
                         [["Mesh", "d", "Cells smoothfem", "Cells %"], ["tri", "1", "1234567", "="],
                          ["tri", "2", "", "×3333"], ['a "b", c', "1", "12/5099", "-1.5"]])
        for table in self.tables().values():
            lines = list(csv.reader(as_csv(table).splitlines()))
            self.assertEqual({len(line) for line in lines}, {len(lines[0])})
            self.assertEqual(len({tuple(line[:len(table.key_headings)]) for line in lines[1:]}), len(table.keys))

    def test_markdown_has_decimal_points_below_each_other(self):
        cells = ((number_cell("5.32"),), (number_cell("3.2898", "a"),), (number_cell("12"),))
        table = Table("s", "t", "", (Heading("M", "M"),), ((Cell("a"),),) * 3, (), (), (Group(Heading("E", "E"), ("",), cells),), ())
        self.assertEqual([line.split(" | ")[1] for line in as_markdown(table).splitlines()[4:7]],
                         ["5.32\u2007\u2007\u2007 |", "3.2898<sup>a</sup> |", "12" + 6 * "\u2007" + " |"])

    def test_markdown_has_equal_columns(self):
        for table in self.tables().values():
            rows = [line for line in as_markdown(table).splitlines() if line.startswith("|")]
            counts = {line.replace("\\|", "").count("|") for line in rows}
            self.assertEqual(len(counts), 1)

    def test_latex(self):
        self.assertEqual(escape_tex("<0.1"), "$<$0.1")
        self.assertEqual(escape_tex(r"50 % & a_b {x} \ ~ ^ # $"),
                         r"50 \% \& a\_b \{x\} \textbackslash{} \textasciitilde{} "
                         r"\textasciicircum{} \# \$")
        for table in self.tables().values():
            latex = as_latex(table)
            self.assertIn(r"\caption{A \& B\_1: ", latex)
            bodies = [part.partition(r"\bottomrule")[0] for part in latex.split(r"\midrule")[1:]]
            panels = panels_of(table)
            self.assertEqual(len(bodies), len(panels))
            for body, panel in zip(bodies, panels):
                rows = [line for line in body.splitlines() if line.endswith(r"\\")]
                columns, = re.findall(r"\\begin\{tabular\}\{([lr@{}]*)\}", "\n".join(tabular(panel)))
                columns = columns.count("l") + columns.count("r")
                self.assertGreaterEqual(columns, len(table.keys[0]) + sum(len(group.subheadings) for group in panel.groups))
                self.assertEqual({line.count(" & ") + line.count(r"\multicolumn{2}") for line in rows}, {columns - 1})
                self.assertEqual(len(rows), len(table.keys))
            self.assertEqual(latex.count("{"), latex.count("}"))
        self.assertIn(r"7.39\cdot10^{2}$\rlap{\textsuperscript{a}}",
                      as_latex(self.tables_of("r", "solver")))

    def test_labels_of_two_studies_do_not_clash(self):
        labels = {re.search(r"\\label\{(.*?)\}", as_latex(table))[1]
                  for study in ("one", "two") for table in self.tables(study=study, folder=study).values()}
        self.assertLessEqual({"tab:one:smoothing", "tab:two:smoothing", "tab:two:details"}, labels)
        self.assertEqual(len(labels), 10)

    def test_wide_tables_are_split_not_shrunk(self):
        keys = (Heading("Mesh", "Mesh"),)
        groups = tuple(Group(Heading(f"Method number {i} (s)", ""), ("smoothfem", "printed"),
                             ((Cell("0.123"), Cell("0.1")),) * 3) for i in range(11))
        wide = Table("own", "table_thresholds", "", keys, ((Cell("tri"),),) * 3, (), (), groups, ())
        panels = panels_of(wide)
        self.assertEqual(tuple(group for panel in panels for group in panel.groups), groups)
        self.assertEqual(sorted(len(panel.groups) for panel in panels), [3, 4, 4])
        self.assertEqual(as_latex(wide).count(r"\begin{tabular}"), 3)
        self.assertEqual(as_latex(wide).count(r"\caption"), 1)
        narrow = replace(wide, groups=groups[:3])
        self.assertEqual(panels_of(narrow), [narrow])

    def test_a_study_of_the_users_is_not_compared_whatever_its_name(self):
        folder = write_results(self.folder / "gear")
        change_provenance(folder, built_in=False)
        results = read_results(folder)
        for table in make_tables(results, read_printed_tables(results.thesis_study, results.provenance)):
            self.assertNotIn("Values of the thesis", as_text(table))
            self.assertNotIn("6_", table.name)

    def tables_of(self, folder, content):
        """A table of a folder that has been written before."""
        results = read_results(self.folder / folder)
        printed = read_printed_tables(results.thesis_study, results.provenance)
        return next(t for t in make_tables(results, printed) if t.name.endswith(content))


class PrintedValues(InFolder):
    def test_choice_of_tables(self):
        self.assertEqual(set(read_printed_tables("gear", {})),
                         {"smoothing", "solver", "errors", "thresholds"})
        self.assertEqual(read_printed_tables("slab", {}), {})
        self.assertEqual(read_printed_tables("gear", {"printed_values": []}), {})
        for chosen in ("6.1", "table_6_1", "studies/thesis/table_6_1.csv"):
            self.assertEqual(set(read_printed_tables("own", {"printed_values": [chosen]})), {"smoothing"})

    def test_deviations_are_known_from_somewhere_or_guesses(self):
        for note in read_rows(thesis_folder() / "deviations.csv").records():
            known_from = note["known_from"]
            if known_from and not known_from.startswith("thesis, "):
                self.assertTrue((data_folder() / known_from).is_file(), known_from)
        shown = [note for study in ("gear", "volume") for table in read_printed_tables(study, {}).values()
                 for note in table.deviations]
        guesses = {note["note"] for note in shown if not note["known_from"]}
        self.assertEqual(guesses, {note["note"] for note in shown if note["note"].startswith("Guess, tested by no run: ")})
        self.assertEqual(as_guess("why"), "Guess, tested by no run: why")

    def test_deviations_name_rows_that_are_printed(self):
        index = read_rows(thesis_folder() / "tables.csv").records()
        for note in read_rows(thesis_folder() / "deviations.csv").records():
            files = [entry["file"] for entry in index if fnmatchcase(entry["table"], note["table"])]
            rows = [row for name in files for row in read_rows(thesis_folder() / name).records()]
            keys = [key for key in ("mesh", "degree", "method") if note[key] != "*"]
            self.assertTrue(any(all(row.get(key) == note[key] for key in keys) for row in rows), note)
