# SPDX-License-Identifier: GPL-3.0-or-later
"""One problem by five solvers in one study: the program's own, deal.II's path, a plugin, a class in Python, and a command."""

import csv
import sys
import tempfile
import unittest
from pathlib import Path

from .build_folder import SMOOTHFEM, run
from .test_new_smoother import make

STUDY = """set dimension = {dimension}
set plugins = {plugin}
set meshes  = mesh
set methods = getme-simultaneous
set degrees = 1
set solvers = poisson, reference, five-ways, class, program
set record every = 100
set timing runs = 1
subsection mesh mesh
  set domain     = {domain}
  set elements   = {elements}
  set edge scale = 8
  set distort to = 0.6
end
subsection solution
  set u = x^2 + y^2{z}
end
subsection finite elements
  set quadrilateral points = 3
  set hexahedron points    = 3
  set cg tolerance         = 1e-13
end
subsection solver reference
  set type         = deal.II
  set points       = 3
  set cg_tolerance = 1e-13
end
subsection solver class
  set type = python:{python}:Poisson
end
subsection solver program
  set command = {interpreter} {python} {{in}} {{out}}
  set format  = vtk
end
"""
PYTHON = Path(__file__).with_name("poisson_in_python.py")


class FiveWays(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = make(Path(temporary.name), "five-ways", command="new-problem")
        source = cls.folder / "five_ways.cc"
        source.write_text(source.read_text().replace("CosineFunction", "SquareFunction"))
        run("cmake", "-S", ".", "-B", "build", "-DCMAKE_BUILD_TYPE=None", folder=cls.folder)
        run("cmake", "--build", "build", folder=cls.folder)

    def check(self, elements):
        dimension = 2 if elements in ("triangles", "quadrilaterals") else 3
        text = STUDY.format(dimension=dimension, plugin="libfive_ways.so", domain="square" if dimension == 2 else "cube",
                            elements=elements, z="" if dimension == 2 else " + z^2", python=PYTHON, interpreter=sys.executable)
        (self.folder / f"{elements}.prm").write_text(text)
        run(SMOOTHFEM, "study", f"{elements}.prm", "--quiet", "--no-figures", folder=self.folder)
        with open(self.folder / "results" / elements / "summary.csv", newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        self.assertEqual([row["status"] for row in rows], ["ok", "ok"])
        for row in rows:
            for error in ("l2_error", "h1_error"):
                expected = float(row[error])
                for label, tolerance in (("reference", 1e-10), ("five-ways", 1e-10), ("class", 1e-10), ("program", 1e-8)):
                    self.assertLess(abs(float(row[f"{label}.{error}"]) / expected - 1), tolerance, f"{elements} {label} {error}")

    def test_triangles(self):
        self.check("triangles")

    def test_quadrilaterals(self):
        self.check("quadrilaterals")

    def test_tetrahedra(self):
        self.check("tetrahedra")

    def test_hexahedra(self):
        self.check("hexahedra")


if __name__ == "__main__":
    unittest.main()
