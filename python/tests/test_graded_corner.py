# SPDX-License-Identifier: GPL-3.0-or-later
"""Which orders in the edge length errors in the re-entrant corner have on meshes that are graded towards it."""

import re
import unittest

import numpy as np

from .built import SOURCE, smoothfem

EDGE_SCALES = (8.0, 4.0, 2.0)  # those of the study energy-l-shape
EXPONENT = 2 / 3  # of r in the solution


def graded(elements, edge_scale, b):
    """GETMe's mesh of the L with nodes p put to |p|^(b - 1) p, |p| the larger coordinate, which maps the L onto itself."""
    mesh = smoothfem.generate("l-shape", elements=elements, edge_scale=edge_scale)
    smoothfem.smooth(mesh, "getme")
    distance = np.abs(mesh.points).max(axis=1, keepdims=True)
    mesh.points *= distance ** (b - 1)
    return mesh


def order(elements, degree, b):
    """Slope of the true H1 errors' logarithms over those of the number of cells to the power of -1/2."""
    meshes = [graded(elements, edge_scale, b) for edge_scale in EDGE_SCALES]
    errors = [smoothfem.solve(mesh, "corner", degree, condition_number="none")["h1_error"] for mesh in meshes]
    return np.polyfit(-0.5 * np.log([mesh.n_cells for mesh in meshes]), np.log(errors), 1)[0]


class GradedCorner(unittest.TestCase):
    def orders(self, degree, b):
        return [order(elements, degree, b) for elements in ("triangles", "quadrilaterals")]

    def test_orders_are_those_of_theory_and_of_the_tutorial(self):
        """b EXPONENT, as errors of cells at the corner fall, up to the degree."""
        text = (SOURCE / "doc" / "smoothing-for-the-error.md").read_text(encoding="utf-8")
        sentence = re.search(r"so that cells shrink towards the corner,(.*?)with b = 3\.", text, re.DOTALL).group(1)
        told = [tuple(float(number) for number in pair) for pair in re.findall(r"(\d?\.\d\d) and (\d?\.\d\d)", sentence)]
        found = [self.orders(degree, b) for degree, b in ((1, 1.5), (1, 2), (2, 1.5), (2, 2), (2, 3))]
        np.testing.assert_allclose(found, told, atol=0.0051)
        for orders, expected in zip(found[2:4], (1.5 * EXPONENT, 2 * EXPONENT)):
            np.testing.assert_allclose(orders, expected, atol=0.02)
        for orders, least in ((found[1], 0.95), (found[4], 1.8)):
            self.assertGreater(min(orders), least)

    def test_even_meshes_have_that_of_the_solution(self):
        for degree in (1, 2):
            np.testing.assert_allclose(self.orders(degree, 1), EXPONENT, atol=0.02)


if __name__ == "__main__":
    unittest.main()
