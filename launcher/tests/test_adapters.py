# SPDX-License-Identifier: GPL-3.0-or-later
"""The adapters for programs that Debian has take part in a study, a record per iteration."""

import csv
import tempfile
import unittest
from pathlib import Path

from .build_folder import SMOOTHFEM, SOURCE, run

METHOD = """subsection method {label}
  set command = {command}
  set format = {format}
  set max_iterations = {iterations}
  set time_pattern = time ([0-9.]+) s
end
"""
STUDY = """set dimension = {dimension}
set meshes = m
set methods = {methods}
set degrees = 1
set timing runs = 1
subsection mesh m
  set domain = {domain}
  set elements = {elements}
  set edge scale = {scale}
  set distort to = {quality}
end
subsection solution
  set name = {solution}
end
"""


class Adapters(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def study(self, methods, **mesh):
        """Rows of summary.csv by method, and of iterations.csv."""
        text = STUDY.format(methods=", ".join(methods), **mesh) + "".join(
            METHOD.format(label=label, command=SOURCE / "adapters" / command, format=file_format, iterations=n)
            for label, (command, file_format, n) in methods.items())
        (self.folder / "s.prm").write_text(text)
        run(SMOOTHFEM, "study", "s.prm", "--out", "out", "--quiet", "--force", folder=self.folder)
        tables = []
        for name in ("summary.csv", "iterations.csv"):
            with open(self.folder / "out" / name, newline="", encoding="utf-8") as stream:
                tables.append(list(csv.DictReader(stream)))
        return {row["method"]: row for row in tables[0]}, tables[1]

    def check(self, summary, rows, label, iterations):
        """A method has moved nodes, for the better, and has a record of each of these iterations."""
        self.assertEqual(summary[label]["status"], "ok", label)
        self.assertGreater(float(summary[label]["q_mean"]), float(summary["initial"]["q_mean"]), label)
        mine = [row for row in rows if row["method"] == label]
        self.assertEqual([row["iteration"] for row in mine], iterations, label)
        for row in mine[1:]:
            self.assertLess(0.0, float(row["smoothing_seconds"]))
            self.assertLess(float(row["smoothing_seconds"]), float(row["wall_seconds"]))

    def test_planar(self):
        summary, rows = self.study(
            {"gmsh": ("gmsh_optimize.py {in} {out} Laplace2D {iterations}", "msh", 4)},
            dimension=2, domain="gear", elements="triangles", scale=2, quality=0.7, solution="gear")
        self.check(summary, rows, "gmsh", ["0", "1", "2", "4"])

    def test_planar_quadrilaterals(self):
        summary, rows = self.study(
            {"sfepy": ("sfepy_taubin.py {in} {out} {iterations}", "vtk", 4)},
            dimension=2, domain="gear", elements="quadrilaterals", scale=3, quality=0.8, solution="gear")
        self.check(summary, rows, "sfepy", ["0", "1", "2", "4"])

    def test_volume(self):
        summary, rows = self.study(
            {"gmsh": ("gmsh_optimize.py {in} {out} Relocate3D {iterations}", "msh", 2),
             "swaps": ("gmsh_optimize.py {in} {out} default {iterations}", "msh", 1),
             "sfepy": ("sfepy_taubin.py {in} {out} {iterations}", "vtk", 2)},
            dimension=3, domain="flange", elements="tetrahedra", scale=4, quality=0.7, solution="volume")
        self.check(summary, rows, "gmsh", ["0", "1", "2"])
        self.check(summary, rows, "sfepy", ["0", "1", "2"])
        self.assertRegex(summary["swaps"]["status"], r"^ok$|^failed: its mesh has ")

    def test_netgen(self):
        """The driver, compiled as its first lines say."""
        text = (SOURCE / "adapters" / "netgen_driver.cc").read_text(encoding="utf-8")
        lines = text[text.index("//   mpicxx"):text.index("// LIB:")].replace("//", "").replace("\\\n", "")
        library = next(path for path in run("dpkg", "-L", "libnglib-dev").stdout.split() if path.endswith("/netgen/libmesh.so"))
        words = lines.replace("LIB/netgen", str(Path(library).parent)).split()
        words[words.index("netgen_driver.cc")] = str(SOURCE / "adapters" / "netgen_driver.cc")
        run(*words, folder=self.folder)
        summary, rows = self.study(
            {"netgen": (f"{self.folder / 'netgen_driver'} {{in}} {{out}} {{iterations}}", "vtk", 4)},
            dimension=3, domain="flange", elements="tetrahedra", scale=4, quality=0.5, solution="volume")
        self.check(summary, rows, "netgen", ["0", "1", "2", "4"])
        self.assertGreater(float(summary["netgen"]["q_mean"]), 0.7)


if __name__ == "__main__":
    unittest.main()
