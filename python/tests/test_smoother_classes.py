# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests smoothers written in Python and called from Python: classes, and files that change."""

import runpy
import unittest
from pathlib import Path

import numpy as np

from .built import EXAMPLES, PACKAGES, address, distorted, smoothfem
from .smoother_files import CHEATS, SMOOTHERS, InAFolder


class InTheModule(InAFolder):
    def test_classes_are_methods(self):
        class Shrinks:
            """Moves nodes a little."""

            parameters = {"by": (0.0, "a number")}
            max_iterations = 3
            tolerance = -1.0

            def step(self, mesh):
                seen.append((address(mesh), smoothfem._core.address(mesh), self.by))
                mesh.points[mesh.free] *= 1.0 - self.by

        seen, mesh = [], distorted("triangles")
        before = mesh.points.copy()
        result = smoothfem.smooth(mesh, Shrinks, by=1e-9)
        self.assertEqual((result.iterations, result.stages[0].name), ("3", "Shrinks"))
        self.assertEqual(len(set(seen)), 1)
        self.assertEqual((seen[0][0], seen[0][2]), (seen[0][1], 1e-9))
        np.testing.assert_array_equal(mesh.points[mesh.fixed], before[mesh.fixed])
        self.assertEqual(smoothfem.parameters(Shrinks)["by"]["default"], 0.0)
        self.assertEqual(smoothfem.parameters(Shrinks)["max_iterations"]["default"], 3)

    def test_files_are_read_again(self):
        mesh = distorted("triangles")
        self.assertEqual(smoothfem.smooth(mesh, "python:mine.py:Laplace").iterations, "4")
        Path("mine.py").write_text(SMOOTHERS.replace("max_iterations = 4", "max_iterations = 2"))
        self.assertEqual(smoothfem.smooth(mesh, "python:mine.py:Laplace").iterations, "2")

    def test_cheats_leave_the_mesh_as_it_was(self):
        mesh = distorted("triangles")
        before = mesh.points.copy()
        for name, sentence in CHEATS.items():
            with self.subTest(name):
                with self.assertRaisesRegex(smoothfem.InputError, sentence) as caught:
                    smoothfem.smooth(mesh, f"python:mine.py:{name}")
                np.testing.assert_array_equal(mesh.points, before)
                if name == "Raises":
                    self.assertIsInstance(caught.exception.__cause__, ZeroDivisionError)

    def test_what_is_kept_stays_valid_memory(self):
        kept = []

        class Keeps:
            def step(self, mesh):
                kept.extend((mesh, mesh.points))
                raise LookupError

        mesh = distorted("triangles")
        with self.assertRaises(smoothfem.InputError):
            smoothfem.smooth(mesh, Keeps)
        np.testing.assert_array_equal(kept[1], mesh.points)
        self.assertNotEqual(kept[1].__array_interface__["data"][0], address(mesh))
        with self.assertRaisesRegex(smoothfem.InputError, "for one call, which is over"):
            kept[0].points

    def test_odt_is_the_mean_of_circumcentres(self):
        """Compares with the textbook formula, in barycentric coordinates of the squares of the sides."""
        rng, n = np.random.default_rng(1), 7
        angles = 2 * np.pi * (np.arange(n) + 0.4 * rng.random(n)) / n
        ring = (1 + 0.3 * rng.random(n))[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
        mesh = smoothfem.Mesh(np.vstack([[0.1, 0.2], ring]), [(0, 1 + i, 1 + (i + 1) % n) for i in range(n)])
        centres, areas = [], []
        for a, b, c in mesh.points[mesh.cells]:
            sides = [np.sum((b - c) ** 2), np.sum((c - a) ** 2), np.sum((a - b) ** 2)]
            weights = np.array([sides[i] * (sum(sides) - 2 * sides[i]) for i in range(3)])
            centres.append(weights @ [a, b, c] / weights.sum())
            areas.append(0.5 * np.cross(b - a, c - a))
        smoother = runpy.run_path(str(EXAMPLES / "odt.py"))["OptimalDelaunay"]()
        smoother.relaxation = 1.0
        smoother.initialize(mesh)
        smoother.step(mesh)
        np.testing.assert_allclose(mesh.points[0], np.average(centres, axis=0, weights=areas), atol=1e-14)
        np.testing.assert_array_equal(mesh.points[1:], ring)

    def test_surfaces_are_not_for_them(self):
        class Idle:
            def step(self, mesh):
                pass

        surface = smoothfem.generate("roof", edge_scale=3)
        with self.assertRaisesRegex(smoothfem.InputError, "surface meshes"):
            smoothfem.smooth(surface, Idle)

    def test_package_is_where_it_is_installed(self):
        self.assertEqual(Path(smoothfem.__file__).parents[1], PACKAGES)


if __name__ == "__main__":
    unittest.main()
