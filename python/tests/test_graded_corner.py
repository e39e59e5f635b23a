# SPDX-License-Identifier: GPL-3.0-or-later
"""Which orders in the edge length errors in the re-entrant corner have on meshes that are graded towards it."""

import re
import unittest

import numpy as np

from .built import SOURCE, smoothfem

EDGE_SCALES = (8.0, 4.0, 2.0)  # those of the study energy-l-shape
EXPONENT = 2 / 3  # of r in the solution


def getme_mesh(elements, edge_scale):
    """GETMe's mesh of the L, and where its nodes are."""
    mesh = smoothfem.generate("l-shape", elements=elements, edge_scale=edge_scale)
    smoothfem.smooth(mesh, "getme")
    return mesh, mesh.points.copy()


def error(mesh, even, degree, b):
    """True H1 error where nodes are from p to |p|^(b - 1) p, |p| the larger coordinate, which maps the L onto itself."""
    mesh.points[:] = even * np.abs(even).max(axis=1, keepdims=True) ** (b - 1)
    return smoothfem.solve(mesh, "corner", degree, condition_number="none")["h1_error"]


class GradedCorner(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.families = [[getme_mesh(elements, edge_scale) for edge_scale in EDGE_SCALES]
                        for elements in ("triangles", "quadrilaterals")]

    def orders(self, degree, b):
        """Of triangles and quadrilaterals: slopes of the errors' logarithms over those of the number of cells to the power of -1/2."""
        return [np.polyfit([-0.5 * np.log(mesh.n_cells) for mesh, _ in family],
                           [np.log(error(mesh, even, degree, b)) for mesh, even in family], 1)[0]
                for family in self.families]

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
