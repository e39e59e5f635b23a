# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests the orders of errors in the edge length on meshes that are graded towards re-entrant corners."""

import itertools
import tempfile
import unittest
from pathlib import Path

import numpy as np

from plots.results.rows import read_rows

from .built import SOURCE, smoothfem

EDGE_SCALES = (8.0, 4.0, 2.0)  # scales of the study energy-l-shape
EXPONENT = 2 / 3  # of r in the solution
STUDY = """
set dimension = 3
set meshes    = {meshes}
set methods   = laplace
set degrees   = 2
{files}
subsection method laplace
  set max_iterations = 1
end
subsection solution
  set name = corner
end
subsection finite elements
  set load             = quadrature
  set condition number = none
  set jacobi cg        = never
end
"""


def getme_mesh(elements, edge_scale):
    """Returns GETMe's mesh of the L, and its nodes."""
    mesh = smoothfem.generate("l-shape", elements=elements, edge_scale=edge_scale)
    smoothfem.smooth(mesh, "getme")
    return mesh, mesh.points.copy()


def graded(even, b):
    """Moves nodes from p to |p|^(b - 1) p, with the largest coordinate |p|. This maps the L and the seven octants onto themselves."""
    return even * np.abs(even).max(axis=1, keepdims=True) ** (b - 1)


def seven_octants(n):
    """Returns nodes and tetrahedra of all octants except that of positive coordinates.

    Each octant has n^3 cubes of six tetrahedra, cut along the planes in which two coordinates are equal."""
    numbers, cells = {}, []
    for signs in itertools.product((1, -1), repeat=3):
        for corner in itertools.product(range(n), repeat=3) if signs != (1, 1, 1) else ():
            for axes in itertools.permutations(np.eye(3, dtype=int)):
                path = signs * np.cumsum([corner, *axes], axis=0)
                order = (0, 1, 2, 3) if np.linalg.det(path[1:] - path[0]) > 0 else (0, 1, 3, 2)
                cells.append([numbers.setdefault(tuple(path[k]), len(numbers)) for k in order])
    return np.array(list(numbers)) / n, np.array(cells)


def documented_orders(domain):
    """Returns {(elements, degree, b): order in H1} of the manual for a domain."""
    rows = read_rows(SOURCE / "docs" / "explanation" / "graded-corner.csv").records()
    return {(row["elements"], int(row["degree"]), float(row["b"])): float(row["order"]) for row in rows if row["domain"] == domain}


def error(mesh, even, degree, b):
    """Returns the true H1 error on the graded mesh."""
    mesh.points[:] = graded(even, b)
    return smoothfem.solve(mesh, "corner", degree, condition_number="none")["h1_error"]


class GradedCorner(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.families = [[getme_mesh(elements, edge_scale) for edge_scale in EDGE_SCALES]
                        for elements in ("triangles", "quadrilaterals")]

    def orders(self, degree, b):
        """Returns the orders for triangles and quadrilaterals: slopes of log(error) over log(n_cells^(-1/2))."""
        return [np.polyfit([-0.5 * np.log(mesh.n_cells) for mesh, _ in family],
                           [np.log(error(mesh, even, degree, b)) for mesh, even in family], 1)[0]
                for family in self.families]

    def test_orders_are_those_of_theory_and_of_the_manual(self):
        """The order is b EXPONENT, the order of errors of cells at the corner, and at most the degree."""
        cases = ((1, 1.5), (1, 2), (2, 1.5), (2, 2), (2, 3))
        found = [self.orders(degree, b) for degree, b in cases]
        documented = documented_orders("l-shape")
        np.testing.assert_allclose(found, [[documented[elements, degree, b] for elements in ("triangles", "quadrilaterals")]
                                           for degree, b in cases], atol=0.0051)
        for orders, expected in zip(found[2:4], (1.5 * EXPONENT, 2 * EXPONENT)):
            np.testing.assert_allclose(orders, expected, atol=0.02)
        for orders, least in ((found[1], 0.95), (found[4], 1.8)):
            self.assertGreater(min(orders), least)

    def test_even_meshes_have_that_of_the_solution(self):
        for degree in (1, 2):
            np.testing.assert_allclose(self.orders(degree, 1), EXPONENT, atol=0.02)


def errors_by_a_study(meshes):
    """Returns true H1 errors of quadratic elements on meshes, {name: (nodes, cells)}. A study computes them, as f is singular and
    solve() evaluates it at the nodes only."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for label, (points, cells) in meshes.items():
            smoothfem.write(smoothfem.Mesh(points, cells), str(folder / f"{label}.vtu"))
        files = "".join(f"subsection mesh {label}\n  set file = {label}.vtu\nend\n" for label in meshes)
        (folder / "graded.prm").write_text(STUDY.format(meshes=", ".join(meshes), files=files), encoding="utf-8")
        smoothfem.Study(folder / "graded.prm").run(folder / "results")
        rows = read_rows(folder / "results" / "summary.csv").records()
        return {row["mesh"]: float(row["h1_error"]) for row in rows if row["method"] == "initial"}


class GradedOctants(unittest.TestCase):
    def test_orders_of_quadratic_tetrahedra_are_those_of_theory_and_of_the_manual(self):
        """The order is b times the order 1 of uniform meshes, and at most the degree."""
        exponents, coarse, fine = (1, 1.5, 2, 2.5), seven_octants(4), seven_octants(8)
        self.assertEqual((len(coarse[1]), len(fine[1])), (2688, 21504))
        errors = errors_by_a_study({f"{size}-{10 * b:.0f}": (graded(points, b), cells) for b in exponents
                                    for size, (points, cells) in (("coarse", coarse), ("fine", fine))})
        found = [np.log2(errors[f"coarse-{10 * b:.0f}"] / errors[f"fine-{10 * b:.0f}"]) for b in exponents]
        documented = documented_orders("fichera")
        np.testing.assert_allclose(found, [documented["tetrahedra", 2, b] for b in exponents], atol=0.0051)
        np.testing.assert_allclose(found[:2], exponents[:2], atol=0.05)
        self.assertGreater(found[3], 1.8)


if __name__ == "__main__":
    unittest.main()
