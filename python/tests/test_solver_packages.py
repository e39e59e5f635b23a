# SPDX-License-Identifier: GPL-3.0-or-later
"""Examples of solvers by sfepy and DOLFINx, against the program's own elasticity and the example by numpy. Tests of packages that
are not installed are skipped."""

import csv
import importlib.util
import unittest

from .built import EXAMPLES, PROGRAM, run
from .smoother_files import InAFolder

STUDY = """set meshes  = mesh
set methods = laplace
set solvers = {solvers}
set degrees = {degree}
set record every = 3
set timing runs = 1
subsection mesh mesh
  set domain     = {domain}
  set elements   = {elements}
  set edge scale = {scale}
  set distort to = 0.7
end
subsection solver own
  set type         = elasticity
  set u            = {u}
  set nu           = 0.4
  set E            = 3
  set points       = {points}
  set cg_tolerance = 1e-13
end
"""
SOLVER = """subsection solver {label}
  set type = python:{file}:{name}
  set nu   = 0.4
  set E    = 3
end
"""
U = {"square": "0.1*(x^2 - y^2) ; -0.2*x*y", "cube": "0.1*(x^2 - y^2) ; -0.2*x*y ; 0"}
SIMPLICES = ("triangles", "tetrahedra")


def needs(module):
    return unittest.skipUnless(importlib.util.find_spec(module), f"python3-{module} is not installed")


class Packages(InAFolder):
    def rows(self, elements, degree, **examples):
        """Runs a study of the own solver and these classes; returns the rows of iterations.csv."""
        domain = "square" if elements in ("triangles", "quadrilaterals") else "cube"
        text = STUDY.format(solvers=", ".join(("own", *examples)), degree=degree, domain=domain, elements=elements, u=U[domain],
                            scale=4 if domain == "square" else 8, points=degree + 1)
        for label, (file, name) in examples.items():
            text += SOLVER.format(label=label, file=EXAMPLES / file, name=name)
        (self.folder / "my.prm").write_text(text, encoding="utf-8")
        run(PROGRAM, "study", "my.prm", "--no-figures", "--quiet", "--force", "--out", "out", folder=self.folder)
        with open(self.folder / "out" / "iterations.csv", newline="", encoding="utf-8") as stream:
            return list(csv.DictReader(stream))

    def check(self, *example, cases):
        for elements, degree in cases:
            with self.subTest(elements, degree=degree):
                others = {"p1": ("elasticity_p1.py", "ElasticityP1")} if elements in SIMPLICES and degree == 1 else {}
                rows = self.rows(elements, degree, mine=example, **others)
                self.assertGreater(len(rows), 1)
                for row in rows:
                    self.assertEqual(row["status"], "ok")
                    for other in ("own", *others):
                        for number in ("energy", "u_max"):
                            self.assertAlmostEqual(float(row[f"mine.{number}"]) / float(row[f"{other}.{number}"]), 1.0, delta=1e-8)
                        self.assertAlmostEqual(float(row["mine.condition_number"]) / float(row[f"{other}.condition_number"]), 1.0, delta=1e-6)
                self.assertNotEqual(rows[0]["mine.condition_number"], rows[-1]["mine.condition_number"])

    @needs("sfepy")
    def test_sfepy(self):
        self.check("elasticity_sfepy.py", "ElasticitySfepy",
                   cases=[("triangles", 1), ("quadrilaterals", 1), ("quadrilaterals", 2), ("tetrahedra", 1), ("tetrahedra", 2), ("hexahedra", 1)])

    @needs("dolfinx")
    def test_dolfinx(self):
        self.check("elasticity_dolfinx.py", "ElasticityDolfinx",
                   cases=[("triangles", 1), ("triangles", 2), ("quadrilaterals", 1), ("tetrahedra", 1), ("hexahedra", 1)])

    @needs("sfepy")
    @needs("dolfinx")
    def test_cells_of_several_types_are_refused(self):
        """The row has the reason. The stand-in for a mixed mesh is one of the program's."""
        text = STUDY.format(solvers="sf, dx", degree=1, domain="random-planar", elements="mixed", u=U["square"], points=2, scale=2)
        text = text[:text.index("subsection solver")].replace("  set distort to = 0.7\n", "")
        text += SOLVER.format(label="sf", file=EXAMPLES / "elasticity_sfepy.py", name="ElasticitySfepy")
        text += SOLVER.format(label="dx", file=EXAMPLES / "elasticity_dolfinx.py", name="ElasticityDolfinx")
        (self.folder / "my.prm").write_text(text, encoding="utf-8")
        run(PROGRAM, "study", "my.prm", "--no-figures", "--quiet", "--out", "out", folder=self.folder)
        with open(self.folder / "out" / "iterations.csv", newline="", encoding="utf-8") as stream:
            status = next(csv.DictReader(stream))["status"]
        self.assertEqual(status.count("the mesh has cells of several types; this solver takes one"), 2, status)
