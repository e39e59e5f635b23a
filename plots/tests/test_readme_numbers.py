# SPDX-License-Identifier: GPL-3.0-or-later
"""Every number in README.md, and in what results/README.md says of results, is backed by a file."""

import json
import re
import unittest

import numpy as np

from plots.claims.overview import BEGIN, END, reference
from plots.results.data_folder import data_folder
from plots.results.rows import read_rows

CODE = r"```.*?```"
# What has digits and is no measurement: names, and references to the thesis.
NAMES = (r"`[^`]*`", r"\]\([^)]*\)", r"(?:Section|Table|Figure|Chapter)s? \d[\d.,]*(?: to \d[\d.]*| and \d)?", r"in 5\.2\.4",
         r"Debian 12", r"x86-64", r"AVX2", r"GPL-3\.0", r"Gmsh 2\.2 and 4\.1", r"4\.0 is read", r"degree 1 and 2", r"d = 2", r"e_L2|e_H1",
         r"1/q", r"32 bits", r"exit code 2", r"2D", r"genus 9")


def provenance(study):
    """provenance.json of a study's reference results."""
    return json.loads((reference() / study / "provenance.json").read_text(encoding="utf-8"))


def mesh(study, name):
    """What the provenance says of a mesh."""
    return next(mesh for mesh in provenance(study)["meshes"] if mesh["name"] == name)


def source(path, pattern):
    """What a source says where it matches."""
    return re.search(pattern, (data_folder() / path).read_text(encoding="utf-8"))[1]


def most_dofs(study):
    """The largest number of degrees of freedom."""
    return int(np.nanmax(read_rows(reference() / study / "summary.csv").number("n_dofs"), initial=0))


def largest_system():
    """The most degrees of freedom of any study in results/reference."""
    return max(most_dofs(path.parent.name) for path in reference().glob("*/summary.csv"))


def expected():
    """What README.md has to say, made from files."""
    tri, quad = mesh("gear", "tri"), mesh("gear", "quad")
    angle = source("smoothing/surface/surface_features.h", r"angle_degrees = (\d+)")
    distance = source("smoothing/surface/sliding_boundary.h", r"default_slide_distance = ([.\d]+)")
    patience = source("smoothing/smoothers/getme_sequential.cc", r"patience_below_start_ = (\d+)")
    return (f"(triangles: {tri['n_nodes']:,} nodes, {tri['n_cells']:,} cells; quadrilaterals: "
            f"{quad['n_nodes']:,} nodes, {quad['n_cells']:,} cells)",
            f"{mesh('pump', 'hex')['n_cells'] / 1e6:.1f} million hexahedra",
            f"The largest system in `results/reference` has {largest_system():,} degrees of freedom",
            f"({angle} degrees)", f"({distance})", f"`patience_below_start` ({patience}) times as many",
            f"{2**31 / 1e9:.0f} billion at most")


class ReadmeNumbers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.text = " ".join(without_made("README.md").split())

    def test_numbers_are_those_of_the_files(self):
        for phrase in expected():
            self.assertIn(phrase, self.text)

    def test_there_are_no_others(self):
        text = without_made("README.md")
        text = " ".join(re.sub(CODE, " ", text, flags=re.DOTALL).split())
        for phrase in expected():
            text = text.replace(phrase, "")
        for name in NAMES:
            text = re.sub(name, " ", text)
        found = [text[max(0, at.start() - 40):at.end() + 20] for at in re.finditer(r"\d", text)]
        self.assertEqual(found, [], "back it by a file in this test, or leave it out")

    def test_command_lines_say_what_was_run(self):
        text = (data_folder() / "README.md").read_text(encoding="utf-8")
        seconds = sum(provenance("volume")["seconds"].values())
        self.assertIn(f"up to {most_dofs('volume'):,} degrees of freedom, more than an hour on two cores", text)
        self.assertEqual(provenance("volume")["sessions"][-1]["machine"]["ranks"], 2)
        self.assertGreater(seconds, 3600)


class ResultsReadmeNumbers(unittest.TestCase):
    def test_residuals_of_eigenvalues(self):
        text = without_made("results/README.md")
        bound = float(re.search(r"Below (\S+) but for `cg-lanczos`", text)[1])
        for path in reference().glob("*/summary.csv"):
            rows = read_rows(path)
            known = rows.where((rows.text("condition_residual") != "") & (rows.text("condition_method") != "cg-lanczos"))
            self.assertTrue((known.number("condition_residual") < bound).all(), path)

    def test_constants_are_those_of_the_program(self):
        text = without_made("results/README.md")
        rows = source("fem/linear_algebra/condition_number.h", r"dense_limit = (\d+)")
        tolerance = source("studies/gear.prm", r"cg tolerance *= (\S+)")
        margin = float(source("studies/gear.prm", r"margin *= (\S+)"))
        for phrase in (f"`dense` (up to {rows} rows)", rf"<= {tolerance} \|b\|",
                       f"margin (Table 6.4: {100 * margin:.0f} %)"):
            self.assertIn(phrase, text)

    def test_nothing_else_is_measured(self):
        text = without_made("results/README.md").partition("# Results of a study of polygon")[0]
        self.assertEqual(re.findall(r"\d[\d.,]*(?:e-?\d+)? ?(?:%|s\b|GB|kB|million|times)", text), ["5 %"])


def without_made(name):
    """The text of a file without what stands between the marker lines."""
    text = (data_folder() / name).read_text(encoding="utf-8")
    return re.sub(f"{re.escape(BEGIN)}.*?{re.escape(END)}", "", text, flags=re.DOTALL)
