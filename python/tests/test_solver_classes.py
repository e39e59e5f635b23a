# SPDX-License-Identifier: GPL-3.0-or-later
"""Solvers written in Python in studies: the example against the program's own elasticity, and refused solvers."""

import csv
import json
import math

from .built import EXAMPLES, PROGRAM, run
from .smoother_files import InAFolder

STUDY = """set meshes  = mesh
set methods = laplace
set solvers = own, mine
set record every = 3
set timing runs = 1
subsection mesh mesh
  set domain     = {domain}
  set elements   = {elements}
  set edge scale = 6
  set distort to = 0.7
end
subsection solver own
  set type         = elasticity
  set degrees      = 1
  set u            = {u}
  set nu           = {nu}
  set cg_tolerance = 1e-13
end
subsection solver mine
  set type = python:{file}:{name}
  {more}
end
"""
U = {2: "0.1*(x^2 - y^2) ; -0.2*x*y", 3: "0.1*(x^2 - y^2) ; -0.2*x*y ; 0"}
MISTAKES = """class Nothing:
    def step(self, mesh):
        pass
class Right:
    def solve(self, mesh):
        return {"a": 2.5}
class Raises:
    def solve(self, mesh):
        return {"a": 1 / 0}
class List:
    def solve(self, mesh):
        return [1.0]
class Word:
    def solve(self, mesh):
        return {"a": "high"}
class Infinite:
    def solve(self, mesh):
        return {"a": float("inf")}
class Name:
    def solve(self, mesh):
        return {"a b": 1.0}
class Writes:
    def solve(self, mesh):
        mesh.points[0] = 7
        return {"a": 1.0}
class Untold:
    def solve(self, mesh):
        return {"matrix": [[1.0]]}
class Given:
    gives_matrix = True
    def solve(self, mesh):
        return {"matrix": self.matrix}
class Missing(Given):
    def solve(self, mesh):
        return {"a": 1.0}
class Skew(Given):
    matrix = [[1.0, 2.0], [0.0, 1.0]]
class Negative(Given):
    matrix = [[-1.0, 0.0], [0.0, 1.0]]
class Indefinite(Given):
    matrix = [[1.0, 2.0], [2.0, 1.0]]
class Oblong(Given):
    matrix = [[1.0, 2.0]]
class Half(Right):
    def energy(self, mesh):
        return 0.0
class Numbers:
    numbers = {"a": "metres"}
    def solve(self, mesh):
        return {"a": 1.0}
"""
SPRINGS = """import numpy as np
class Springs:
    def solve(self, mesh):
        return {"sum": float(((mesh.points - 0.5) ** 2).sum())}
    def energy(self, mesh):
        self.arms = np.array(mesh.points) - 0.5
        return (self.arms ** 2).sum()
    def energy_gradient(self):
        return 2 * self.arms
    def indicators(self, mesh):
        return np.ones(mesh.n_cells)
class Short(Springs):
    def energy_gradient(self):
        return self.arms[1:]
class Wrong(Springs):
    def energy(self, mesh):
        return "low"
"""
REFUSED = {"Half": "has energy, but not the other one of energy and energy_gradient", "Nothing": "is not a solver: it has no solve", "Numbers": "numbers has the entry 'a'", "Absent": "has no class 'Absent'"}
FAILED = {"Raises": "Raises: solve failed: ", "List": "solve returned list", "Word": "gives a a value that is not a number",
          "Infinite": "the value inf", "Name": "the name 'a b'", "Writes": "read-only", "Untold": "gives a matrix, but the class has gives_matrix = False",
          "Missing": "gives no matrix, but the class has gives_matrix = True", "Skew": "is not symmetric", "Negative": "no positive number",
          "Indefinite": "is not positive definite", "Oblong": "1 rows and 2 columns"}


class SolverClasses(InAFolder):
    def study(self, **values):
        """Runs the study; returns (exit code, standard error, rows of iterations.csv)."""
        values = {"domain": "square", "elements": "triangles", "u": U[2], "nu": 0.3, "more": "", **values}
        (self.folder / "my.prm").write_text(STUDY.format(**values), encoding="utf-8")
        outcome = run(PROGRAM, "study", "my.prm", "--no-figures", "--quiet", "--force", "--out", "out", folder=self.folder, check=False)
        if outcome.returncode:
            return outcome.returncode, outcome.stderr, []
        with open(self.folder / "out" / "iterations.csv", newline="", encoding="utf-8") as stream:
            return 0, outcome.stderr, list(csv.DictReader(stream))

    def checked_example(self):
        """Writes the example's class with one more number, the condition number by all singular values."""
        (self.folder / "checked.py").write_text(
            "import sys\n"
            f"sys.path.append({str(EXAMPLES)!r})\n"
            "import numpy as np\n"
            "from elasticity_p1 import ElasticityP1\n"
            "class Checked(ElasticityP1):\n"
            "    def solve(self, mesh):\n"
            "        found = super().solve(mesh)\n"
            "        return {**found, 'dense': np.linalg.cond(found['matrix'].toarray())}\n", encoding="utf-8")
        return {"file": "checked.py", "name": "Checked"}

    def test_the_example_has_the_numbers_of_the_programs_own_solver(self):
        for domain, elements, dim, nu in (("square", "triangles", 2, 0.3), ("square", "triangles", 2, 0.499), ("cube", "tetrahedra", 3, 0.3)):
            with self.subTest(elements, nu=nu):
                code, message, rows = self.study(domain=domain, elements=elements, u=U[dim], nu=nu, more=f"set nu = {nu}",
                                                 **self.checked_example())
                self.assertEqual(code, 0, message)
                self.assertGreater(len(rows), 2)
                for row in rows:
                    self.assertEqual(row["status"], "ok")
                    for number in ("energy", "u_max"):
                        self.assertAlmostEqual(float(row[f"mine.{number}"]) / float(row[f"own.{number}"]), 1.0, delta=1e-8)
                    for solver in ("own", "mine"):
                        self.assertAlmostEqual(float(row[f"{solver}.condition_number"]) / float(row["mine.dense"]), 1.0, delta=1e-6)
                    self.assertLess(float(row["mine.amg_cg_iterations"]), float(row["mine.cg_iterations"]))
        solver = json.loads((self.folder / "out" / "provenance.json").read_text(encoding="utf-8"))["solvers"][1]
        self.assertEqual(solver["type"], "python:checked.py:Checked")
        self.assertEqual(solver["files"][0]["name"], "checked.py")

    def test_curved_cells_are_for_classes_that_take_them(self):
        (self.folder / "area.py").write_text(
            "import smoothfem\n"
            "class Straight:\n"
            "    def solve(self, mesh):\n"
            "        return {'order': mesh.order, 'area': smoothfem.quality(mesh, 'size').sum()}\n"
            "class Curved(Straight):\n"
            "    takes_curved_cells = True\n", encoding="utf-8")
        text = """set meshes = disc
set methods = laplace
set solvers = mine
set timing runs = 1
subsection mesh disc
  set domain = disc
  set order = 2
  set edge scale = 16
end
subsection solver mine
  set type = python:area.py:NAME
end
"""
        for name, more, found in (("Curved", "", (2, math.pi)), ("Straight", "set geometry = straight", (1, 3.1)), ("Straight", "", ())):
            with self.subTest(name, more=more):
                study = text.replace("NAME", name) + f"subsection finite elements\n{more}\nend\n"
                (self.folder / "my.prm").write_text(study, encoding="utf-8")
                outcome = run(PROGRAM, "study", "my.prm", "--no-figures", "--quiet", "--force", "--out", "out", folder=self.folder, check=False)
                if not found:
                    self.assertEqual(outcome.returncode, 2)
                    self.assertIn("set geometry = straight", outcome.stderr)
                    continue
                self.assertEqual(outcome.returncode, 0, outcome.stderr)
                with open(self.folder / "out" / "summary.csv", newline="", encoding="utf-8") as stream:
                    row = next(csv.DictReader(stream))
                self.assertEqual(float(row["mine.order"]), found[0])
                self.assertAlmostEqual(float(row["mine.area"]), found[1], delta=1e-4 if name == "Curved" else .05)

    def test_classes_that_are_no_solvers_are_refused(self):
        (self.folder / "wrong.py").write_text(MISTAKES, encoding="utf-8")
        for name, why in REFUSED.items():
            with self.subTest(name):
                code, message, _ = self.study(file="wrong.py", name=name)
                self.assertEqual((code, message.count("\n")), (2, 1), message)
                self.assertIn(why, message)

    def test_mistakes_are_rows_with_the_reason(self):
        """All wrong classes are solvers of one study."""
        (self.folder / "wrong.py").write_text(MISTAKES, encoding="utf-8")
        sections = "".join(f"subsection solver {name}\n set type = python:wrong.py:{name}\nend\n" for name in FAILED)
        text = STUDY.format(domain="square", elements="triangles", u=U[2], nu=0.3, more="", file="wrong.py", name="Right")
        (self.folder / "my.prm").write_text(text.replace("own, mine", f"own, mine, {', '.join(FAILED)}") + sections, encoding="utf-8")
        run(PROGRAM, "study", "my.prm", "--no-figures", "--quiet", "--out", "out", folder=self.folder)
        with open(self.folder / "out" / "summary.csv", newline="", encoding="utf-8") as stream:
            row = next(csv.DictReader(stream))
        self.assertNotEqual(row["own.energy"], "")
        self.assertEqual(row["mine.a"], "2.5")
        reasons = dict(part.split(": failed: ", 1) for part in row["status"].split("; ") if ": failed: " in part)
        self.assertEqual(set(reasons), set(FAILED))
        for name, why in FAILED.items():
            self.assertIn(why, reasons[name])

    def test_methods_move_nodes_by_their_energy(self):
        (self.folder / "springs.py").write_text(SPRINGS, encoding="utf-8")
        names = ("Springs", "Short", "Wrong")
        sections = "".join(f"subsection solver {name}\n set type = python:springs.py:{name}\nend\n"
                           f"subsection method by_{name}\n set type = energy-descent\n set start.method = none\n set smooth for = {name}\nend\n"
                           for name in names)
        text = STUDY.format(domain="square", elements="triangles", u=U[2], nu=0.3, more="", file="springs.py", name="Springs") + sections
        text = text.replace("set methods = laplace", "set methods = laplace, by_Springs, by_Short, by_Wrong, weighted")
        text = text.replace("own, mine", "own, mine, Springs, Short, Wrong")
        text += "subsection method weighted\n set type = indicator-weighted\n set smooth for = mine\nend\n"
        (self.folder / "my.prm").write_text(text, encoding="utf-8")
        outcome = run(PROGRAM, "study", "my.prm", "--no-figures", "--quiet", "--out", "out", folder=self.folder)
        with open(self.folder / "out" / "summary.csv", newline="", encoding="utf-8") as stream:
            rows = {row["method"]: row for row in csv.DictReader(stream)}
        self.assertLess(float(rows["by_Springs"]["mine.sum"]), float(rows["initial"]["mine.sum"]))
        self.assertEqual(rows["weighted"]["status"], "ok")
        self.assertIn("energy_gradient returns an array of shape", rows["by_Short"]["status"] + outcome.stderr)
        self.assertIn("energy gives energy a value that is not a number", rows["by_Wrong"]["status"] + outcome.stderr)
