# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables and figures of a regularization study."""

import contextlib
import io
import json

from plots.__main__ import main
from plots.figures import style
from plots.figures.regularization import ELEMENTS, FIGURES, STARTS, draw_corridor, draw_speeds
from plots.results.regularization import COUNTS, STUDY, read_regularization_results
from plots.tables.formats import as_text
from plots.tables.regularization import make_regularization_tables
from plots.tests.synthetic_results import change_provenance, write_csv
from plots.tests.test_read_results import InFolder

SIGMAS = [0.0, 0.5, 1.0, 2.0]
MEANS = ["", "9.5", "4.25", "8.125"]


def write_results(folder):
    """A folder with few numbers, which are known."""
    folder.mkdir()
    rows = []
    for element in ELEMENTS:
        for transformation in ("opposite-face-normals", "dual-element"):
            if transformation == "opposite-face-normals" and element != "tetrahedron":
                continue
            rows += [dict(zip(COUNTS, (element, transformation, start, sigma, 10, 10 if mean else 0, mean,
                                       "1" if mean else "", "2" if mean else "", "20" if mean else "")))
                     for start in STARTS for sigma, mean in zip(SIGMAS, MEANS)]
    write_csv(folder / "regularization.csv", COUNTS, rows)
    valid = [{"element": e, "n_elements": 10, "n_valid": 5, "share": 0.5} for e in ELEMENTS]
    write_csv(folder / "validity.csv", list(valid[0]), valid)
    (folder / "provenance.json").write_text(json.dumps(
        {"study": STUDY, "study_title": "R", "parameters": {"kind": "regularization"}}))
    return folder


class Regularization(InFolder):
    def test_least_mean_stands_next_to_the_printed_value(self):
        tables = make_regularization_tables(read_regularization_results(write_results(self.folder / "r")))
        text = as_text(tables[0])
        self.assertIn("4.25", text)
        self.assertIn("0.78", text)
        self.assertIn("50.15", as_text(tables[1]))

    def test_element_types_have_the_colours_of_all_figures(self):
        results = read_regularization_results(write_results(self.folder / "r"))
        style.apply_style()
        self.addCleanup(style.pyplot.close, "all")
        labelled = [line for figure in (draw_corridor(results), draw_speeds(results))
                    for axes in figure.axes for line in axes.get_lines()
                    if line.get_label().lower() in (*ELEMENTS, "mean")]
        self.assertEqual(len(labelled), 1 + 2 * len(ELEMENTS))
        for line in labelled:
            element = line.get_label().lower().replace("mean", "tetrahedron")
            self.assertEqual(line.get_color(), style.ELEMENT_COLOURS[element], element)

    def test_files(self):
        folder = write_results(self.folder / "r")
        self.assertEqual(main([str(folder), "--quiet"]), 0)
        for name, (number, _, _) in FIGURES.items():
            for suffix in ("pdf", "png"):
                self.assertGreater((folder / "figures" / f"figure_{number}_{name}.{suffix}").stat().st_size, 1000)
        self.assertTrue((folder / "tables" / "table_fastest.tex").exists())

    def test_a_study_of_the_users_has_no_numbers_of_the_thesis(self):
        folder = write_results(self.folder / "r")
        change_provenance(folder, built_in=False)
        self.assertEqual(main([str(folder), "--quiet", "--format", "svg"]), 0)
        self.assertEqual({path.name for path in folder.glob("figures/*")}, {"corridor.svg", "speeds.svg"})
        for path in folder.glob("tables/*.md"):
            self.assertNotIn("printed", path.read_text())

    def test_what_is_missing(self):
        folder = write_results(self.folder / "r")
        (folder / "validity.csv").unlink()
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors):
            self.assertEqual(main([str(folder), "--quiet"]), 2)
        self.assertIn("validity.csv: the file is missing", errors.getvalue())
