# SPDX-License-Identifier: GPL-3.0-or-later
"""Requests, messages for things that are missing, and no half-made output."""

import contextlib
import csv
import io
import os
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path
from unittest import mock

from plots.__main__ import main
from plots.results.names import find_column
from plots.results.request import Request
from plots.results.rows import read_rows
from plots.tests.synthetic_polygons import write_polygon_results
from plots.tests.synthetic_results import change_provenance, write_csv, write_results
from plots.tests.test_read_results import InFolder

PACKAGE = Path(__file__).resolve().parents[1]


class CommandLine(InFolder):
    def setUp(self):
        super().setUp()
        self.results = write_results(self.folder / "r", methods=("weighted-laplace", "getme", "own"))
        self.enterContext(mock.patch("plots.figures.style.DPI", 40))

    def run_main(self, *arguments):
        """(exit code, output, errors)"""
        output, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            try:
                code = main([str(argument) for argument in arguments])
            except SystemExit as end:
                code = end.code
        return code, output.getvalue(), errors.getvalue()

    def made(self, *arguments):
        """Names of the files that a command line makes in a folder of its own."""
        out = self.folder / f"out{len(list(self.folder.iterdir()))}"
        code, _, errors = self.run_main(self.results, "--out", out, "--quiet", *arguments)
        self.assertEqual((code, errors), (0, ""))
        return {path.name for path in out.glob("*/*")}, out

    def refused(self, *arguments):
        """Returns the one sentence on the fault; nothing is made."""
        before = sorted(self.results.rglob("*"))
        code, output, errors = self.run_main(self.results, *arguments)
        self.assertEqual((code, output, errors.count("\n")), (2, "", 1), errors)
        self.assertEqual(sorted(self.results.rglob("*")), before)
        return errors


class Options(CommandLine):
    def test_only_some_by_name_or_pattern(self):
        self.assertEqual(self.made("--only", "history,table_6_2_solver", "--format", "svg")[0],
                         {"figure_6_4_history.svg", "table_6_2_solver.csv", "table_6_2_solver.md", "table_6_2_solver.tex"})
        self.assertEqual(self.made("--only", "figure_6_3_*", "--format", "pdf")[0],
                         {"figure_6_3_meshes.pdf", "figure_6_3_meshes_full.pdf"})
        self.assertEqual(self.made("--only", "claims")[0], {"claims.md"})

    def test_a_figure_that_is_divided_among_meshes_has_one_name(self):
        self.results = write_results(self.folder / "two", meshes=("tri", "quad"))
        self.assertEqual(self.made("--only", "history,meshes_full", "--width", "84mm", "--format", "png")[0],
                         {"figure_6_4_history_tri.png", "figure_6_4_history_quad.png", "figure_6_3_meshes_full.png"})
        self.assertEqual(self.made("--y", "q_min", "--only", "history_q_min", "--width", "3.3", "--format", "png")[0],
                         {"history_q_min_tri.png", "history_q_min_quad.png"})

    def test_meshes_are_not_read_for_what_needs_none(self):
        (self.results / "meshes" / "tri_getme.vtu").write_text("no mesh")
        self.assertEqual(self.made("--only", "errors,history_log_time", "--format", "png")[0],
                         {"table_6_3_errors.csv", "table_6_3_errors.md", "table_6_3_errors.tex",
                          "figure_6_4_history_log_time.png"})
        self.assertIn("not a complete VTU file", self.refused("--only", "meshes"))

    def test_names_that_are_not_there(self):
        for options, said in ((("--only", "histroy"), "figure or table 'histroy'; did you mean 'history'?"),
                              (("--only", "x*"), r"figure or table 'x\*'; choose one of smoothing, solver, "),
                              (("--methods", "getmee"), "method 'getmee'; did you mean 'getme'? choose one of getme"),
                              (("--meshes", "trii"), "mesh 'trii'; did you mean 'tri'? choose one of tri"),
                              (("--y", "H1norm"), "column 'H1norm'; did you mean 'h1_error'?"),
                              (("--y", "e_h1x"), "column 'e_h1x'; did you mean 'e_h1'?"),
                              (("--y", "e_maks"), "column 'e_maks'; did you mean 'e_max'? choose one of iteration, "),
                              (("--x", "cg_itrations"), "column 'cg_itrations'; did you mean 'cg_iterations'?"),
                              (("--y", "cnd(A)"), r"column 'cnd\(A\)'; did you mean 'condition_number'?")):
            self.assertRegex(self.refused(*options), "^there is no " + said.replace("?", r"\?"))
        self.assertIn("column `status` holds something that is not a number", self.refused("--y", "status"))
        self.assertIn("column `w_mean` has no numbers", self.refused("--y", "w_mean"))

    def test_values_that_cannot_be_used(self):
        for options, said in ((("--width", "84cm"), "is not a width from 2in to 30in"),
                              (("--x-range", "2:1"), "is not a range such as 0:0.5"), (("--y-range", ":"), "is not a range"),
                              (("--columns", "mesh", "--y", "H1"), "use one command for each"),
                              (("--width", "1mm"), "such as 84mm, 8.4cm or 3.3in"), (("--format", "jpg"), "choose from pdf, png"),
                              (("--y", "e_max", "--no-figures"), "leave out --no-figures"), (("--wide",), "unrecognized")):
            self.assertIn(said, self.refused(*options))

    def test_some_methods(self):
        names, out = self.made("--methods", "getme,own", "--only", "*smoothing,*errors", "--no-figures")
        self.assertNotIn("claims.md", names)
        text = (out / "tables" / "table_6_1_smoothing.md").read_text()
        self.assertIn("GETMe", text)
        self.assertIn("| Initial |", text)
        self.assertNotIn("weighted-laplace", text)

    def test_a_history_of_other_columns(self):
        self.assertEqual(self.made("--y", "q_min,cg_iterations", "--x", "iteration", "--format", "png")[0],
                         {f"history_q_min_cg_iterations_d{d}.png" for d in "12"})
        self.assertEqual(self.made("--y", "cond(A),q*_min,e_L2", "--x", "Smoothing time", "--format", "png")[0],
                         {f"history_cond_q_star_min_e_l2_time_d{d}.png" for d in "12"})
        self.assertEqual(self.made("--y", "Cond", "--format", "png")[0],
                         {f"history_cond_d{d}.png" for d in "12"})
        self.assertEqual(self.made("--y", "q_min", "--log-x", "--format", "png")[0], {"history_q_min_logx.png"})
        self.assertEqual(self.made("--log-y", "--only", "history_log*,errors", "--format", "png")[0],
                         {"history_log_d1.png", "history_log_d2.png", "table_6_3_errors.csv",
                          "table_6_3_errors.md", "table_6_3_errors.tex"})

    def test_true_errors_have_short_names(self):
        numbers = ["q_min", "e_l2", "e_h1", "l2_error", "h1_error", "condition_number"]
        for wanted, column in (("H1", "h1_error"), ("l2", "l2_error"), ("h1 error", "h1_error"), ("E_H1", "e_h1"), ("Q_Min", "q_min"),
                               ("cond", "condition_number")):
            self.assertEqual(find_column(wanted, numbers, numbers), column)

    def test_width(self):
        for text, inches in (("84mm", 84 / 25.4), ("8.4 cm", 84 / 25.4), ("3.3", 3.3), ("5in", 5.0)):
            _, out = self.made("--width", text, "--only", "history,model", "--format", "png")
            for path in (out / "figures").iterdir():
                width, = struct.unpack(">I", path.read_bytes()[16:20])  # of the PNG's header
                self.assertAlmostEqual(width / 40, inches, delta=0.03, msg=path.name)

    def test_one_figure_into_a_file(self):
        before = sorted(self.results.rglob("*"))
        for options in (("--only", "history_log_time"), ("--y", "q_min", "--width", "3.4in"), ("--y", "H1", "--degrees", "1")):
            for name in ("fig.pdf", "FIG.PNG"):
                with tempfile.TemporaryDirectory() as folder:
                    code, output, errors = self.run_main(self.results, "--methods", "getme", *options, "-o", f"{folder}/{name}")
                    self.assertEqual((code, errors, output), (0, "", f"wrote {folder}/{name}\n"))
                    self.assertEqual([path.name for path in Path(folder).iterdir()], [name])
        self.assertEqual(sorted(self.results.rglob("*")), before)
        self.assertIn("no figure to draw into fig.svg", self.refused("--only", "claims", "-o", "fig.svg"))
        self.assertIn("fig.svg is a figure", self.refused("--no-figures", "-o", "fig.svg"))
        self.assertEqual(self.refused("--y", "H1", "-o", "fig.pdf"), "fig.pdf has room for one figure, but there are 2: history_h1_d1, "
                         "history_h1_d2; choose one by --degrees, or give a folder.\n")
        self.assertIn("choose one by --only", self.refused("--only", "history*", "-o", "fig.pdf"))
        self.results = write_results(self.folder / "two", meshes=("tri", "quad"))
        self.assertIn("choose one by --degrees and --meshes,", self.refused("--y", "H1", "--width", "84mm", "-o", "fig.pdf"))
        self.assertIn("says the format already", self.refused("--y", "q_min", "--format", "png", "-o", "fig.pdf"))

    def test_files_of_unknown_formats_are_no_folders(self):
        for name in ("f.eps", "f.jpg"):
            self.assertIn(f"{name[2:]} is not one of pdf, png, svg ", self.refused("--y", "q_min", "-o", self.folder / name))
            self.assertFalse((self.folder / name).exists())
        for name in ("v1.2", "f.eps/"):
            self.assertEqual(self.run_main(self.results, "--only", "errors", "-o", f"{self.folder}/{name}", "--quiet")[0], 0)
            self.assertTrue((self.folder / name / "tables").is_dir())

    def test_names_of_histories_are_short(self):
        self.assertEqual(Request(y=("h1_error",)).history_name, "history_h1")
        self.assertEqual(Request(y=("q_min", "h1_error"), x="iteration", log_y=True).history_name, "history_q_min_h1_iterations_log")
        long = Request(y=("h1_error", "l2_error", "q_star_min", "jacobi_cg_iterations"), x="iteration", log_x=True).history_name
        self.assertEqual(long, "history_h1_l2_more_iterations_logx")

    def test_columns_of_a_table(self):
        names, out = self.made("--columns", "mesh,method,H1,q_min", "--degrees", "2", "--methods", "GETMe,own")
        self.assertEqual(names, {f"table_chosen.{suffix}" for suffix in ("csv", "md", "tex")})
        self.assertEqual((out / "tables" / "table_chosen.csv").read_text(), "Mesh,Method,H1 error,q_min\ntri,Initial,1.5000,0.2046\n"
                         "tri,GETMe,1.5000,0.2046\ntri,own,1.5000,0.2046\n")
        path = self.results / "summary.csv"
        rows = read_rows(path).records()
        write_csv(path, list(rows[0]), [{**row, "e_max": row["degree"]} for row in rows])
        self.assertIn("rows of the table differ by degree; add degree to --columns, or choose one of 1, 2 by --degrees",
                      self.refused("--columns", "method,e_max"))
        self.assertIn("column 'h1-errr'; did you mean 'h1_error'?", self.refused("--columns", "h1-errr"))
        path = self.folder / "t.tex"
        code, output, errors = self.run_main(self.results, "--columns", "method,q_mean,status", "--degrees", "1", "-o", path)
        self.assertEqual((code, errors), (0, ""))
        self.assertIn("Method", output)
        self.assertIn(r"GETMe & 1.5000 & ok \\", path.read_text())
        self.assertIn("room for one table, but there are", self.refused("-o", path.with_name("u.csv")))

    def test_degrees(self):
        names, out = self.made("--degrees", "2", "--y", "H1", "--format", "pdf")
        self.assertEqual(names, {"history_h1.pdf"})
        _, out = self.made("--degrees", "2", "--only", "errors")
        with open(out / "tables" / "table_6_3_errors.csv", encoding="utf-8", newline="") as stream:
            self.assertEqual({row["d"] for row in csv.DictReader(stream)}, {"2"})
        self.assertIn("there is no degree '3'; choose one of 1, 2", self.refused("--degrees", "3"))

    def test_a_study_of_the_users_has_no_numbers_of_the_thesis(self):
        change_provenance(self.results, built_in=False)
        names, _ = self.made("--format", "pdf")
        self.assertFalse([name for name in names if re.search(r"\d_\d|figure|claims", name)])
        self.assertLessEqual({"history.pdf", "meshes.pdf", "model.pdf", "table_errors.tex"}, names)
        code, output, _ = self.run_main(self.results, "--only", "errors", "--verbose")
        self.assertEqual(code, 0)
        self.assertIn("No claims.md: the thesis says nothing about this study.\n", output)
        change_provenance(self.results, built_in=True)
        names, _ = self.made("--format", "pdf")
        self.assertLessEqual({"figure_6_4_history.pdf", "table_6_3_errors.tex", "claims.md"}, names)


class BrokenResults(CommandLine):
    def change(self, name, change):
        """Rewrites a CSV file of the results."""
        path = self.results / name
        with open(path, newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        change(rows)
        write_csv(path, list(rows[0]), rows)

    def test_no_number_where_one_has_to_be(self):
        for name, column, value in (("iterations.csv", "smoothing_seconds", "nan"),
                                    ("iterations.csv", "q_min", ""), ("summary.csv", "q_mean", "inf")):
            before = (self.results / name).read_text()
            self.change(name, lambda rows, column=column, value=value: rows[3].update({column: value}))
            self.assertRegex(self.refused(), rf"{name}, row 5: `{column}` is {value or 'empty'}, not a number; "
                             r"run the study again\.$")
            (self.results / name).write_text(before)

    def test_no_number_where_there_may_be_none(self):
        self.change("iterations.csv", lambda rows: [row.update(e_max="nan") for row in rows[2:5]])
        self.change("summary.csv", lambda rows: rows[1].update(cg_seconds="-inf"))
        code, _, errors = self.run_main(self.results, "--quiet", "--format", "png")
        self.assertEqual(code, 0)
        first, second = errors.splitlines()
        self.assertRegex(first, r"iterations.csv: `e_max` is no finite number in 3 of \d+ rows; there, lines")
        self.assertRegex(second, r"summary.csv: `cg_seconds` is no finite number in 1 of \d+ rows")
        self.assertNotIn("nan", (self.results / "tables" / "table_6_2_solver.md").read_text())
        self.assertNotIn("inf", (self.results / "tables" / "table_6_2_solver.md").read_text())

    def test_files_that_are_not_whole(self):
        for name, change, said in (
                ("iterations.csv", lambda text: text[:-1], "the last line has no end; the file looks truncated"),
                ("iterations.csv", lambda text: text[:-3], "the last line has no end"),
                ("iterations.csv", lambda text: text[:text.index("\n") + 1], "the file has no rows"),
                ("summary.csv", lambda text: "", "the file is empty"),
                ("thresholds.csv", lambda text: text.replace("speedup", "other"), "column `speedup` is missing"),
                ("summary.csv", lambda text: text.replace(",1,9,", ",one,9,"), "column `degree` holds something")):
            path = self.results / name
            before = path.read_text()
            path.write_text(change(before))
            self.assertNotEqual(path.read_text(), before)
            self.assertIn(said, self.refused())
            path.write_text(before)

    def test_a_broken_mesh_is_found_before_anything_is_written(self):
        path = self.results / "meshes" / "tri_getme.vtu"
        path.write_text(path.read_text()[:500])
        self.assertIn("tri_getme.vtu: not a complete VTU file", self.refused())


class WithoutPackages(CommandLine):
    def test_one_sentence(self):
        for module in ("numpy", "matplotlib"):
            # Ahead of the real one, a module that is not there.
            (self.folder / module).mkdir()
            (self.folder / module / "__init__.py").write_text(
                f"raise ModuleNotFoundError(\"No module named '{module}'\", name='{module}')\n")
            done = subprocess.run(
                [sys.executable, "-B", "-m", "plots", str(self.results)], cwd=PACKAGE.parent,
                env={**os.environ, "PYTHONPATH": str(self.folder)}, capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
            self.assertRegex(done.stderr, rf"^[^\n]*No module named '{module}'; install the Debian package "
                             rf"python3-{module}, [^\n]*SMOOTHFEM_PYTHON[^\n]*\.\n$")
            self.assertFalse((self.results / "tables").exists())
            (self.folder / module / "__init__.py").unlink()
            (self.folder / module).rmdir()


class Pipe(CommandLine):
    def test_files_are_made_although_nobody_reads(self):
        reading, writing = os.pipe()
        os.close(reading)
        with os.fdopen(writing, "w") as nobody:
            done = subprocess.run([sys.executable, "-B", "-m", "plots", str(self.results), "--no-figures"], cwd=PACKAGE.parent,
                                  stdout=nobody, stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertTrue(list((self.results / "tables").iterdir()))


class Library(CommandLine):
    def test_the_readme_does_what_it_says(self):
        text = (PACKAGE / "README.md").read_text(encoding="utf-8")
        code, = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
        (self.folder / "results").mkdir()
        self.results.rename(self.folder / "results" / "gear")
        here = os.getcwd()
        self.addCleanup(os.chdir, here)
        os.chdir(self.folder)
        names = {}
        exec(compile(code, "README.md", "exec"), names)  # the text is part of this repository
        self.assertEqual((self.folder / "getme.pdf").read_bytes()[:4], b"%PDF")
        self.assertEqual(names["results"].methods, ("getme",))
        self.assertIn("GETMe of smoothfem", [text.get_text() for text in names["figure"].legends[0].get_texts()])

    def test_the_readmes_command_lines(self):
        text = (PACKAGE / "README.md").read_text(encoding="utf-8")
        lines = re.findall(r"^smoothfem plot results/gear(.*?)(?: +#.*)?$", text, re.MULTILINE)
        self.assertEqual(len(lines), 6)
        for line in lines:
            self.made(*line.replace("--out paper", "").replace("-o fig.pdf", "").replace("smart-laplace", "own").split())

    def test_another_kind_of_study(self):
        folder = write_polygon_results(self.folder / "p")
        code, _, errors = self.run_main(folder, "--quiet", "--only", "side_ratio")
        self.assertEqual(code, 2)
        self.assertIn("did you mean 'side_ratios'?", errors)
        code, _, errors = self.run_main(folder, "--quiet", "--width", "84mm")
        self.assertEqual(code, 2)
        self.assertRegex(errors, r"^[^\n]*at least 6\.0in wide; choose a larger --width\.\n$")
        self.assertFalse((folder / "tables").exists())
