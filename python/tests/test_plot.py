# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests pictures of meshes by matplotlib."""

import unittest

import matplotlib
import numpy as np

from .built import distorted, grid, smoothfem
from .test_meshes import CELLS

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402


class Pictures(unittest.TestCase):
    def setUp(self):
        self.addCleanup(pyplot.close, "all")

    def test_cells_have_the_colours_of_their_quality(self):
        mesh = smoothfem.Mesh([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0.4]], [[1, 4, 2], [0, 1, 2, 3]])
        axes = mesh.plot()
        drawn, = axes.collections
        for path, value in zip(drawn.get_paths(), drawn.get_array()):
            cell = len(path.vertices) - 1 == 4  # triangle: cell 0
            self.assertEqual(value, smoothfem.quality(mesh)[int(cell)])
        self.assertEqual(drawn.get_clim(), (0, 1))
        self.assertEqual(axes.figure.axes[1].get_ylabel(), "mean ratio")

    def test_values_of_cells_and_nodes(self):
        mesh = distorted("triangles")
        of_cells = mesh.plot(values=np.arange(mesh.n_cells), label="number").collections[0]
        self.assertEqual(of_cells.get_array().tolist(), list(range(mesh.n_cells)))
        of_nodes = mesh.plot(values=mesh.points[:, 0], colorbar=False)
        self.assertEqual(len(of_nodes.figure.axes), 1)
        axes = pyplot.figure().add_subplot()
        self.assertIs(mesh.plot(None, ax=axes), axes)

    def test_faces_of_volume_meshes(self):
        mesh = grid("tetrahedra", 3)
        n_boundary = sum(map(len, mesh.boundary_facets.values()))
        faces = mesh.plot().collections[0]
        self.assertEqual(len(faces.get_array()), n_boundary)
        half = mesh.plot(cut="x").collections[0]
        self.assertLess(len(half.get_array()), n_boundary)
        self.assertEqual(smoothfem.generate("roof", edge_scale=3).plot(None).name, "3d")
        for points in CELLS.values():
            solid = smoothfem.Mesh(np.array(points, float), [range(len(points))], dim=3)
            faces, _ = smoothfem._plot._visible_faces(solid, np.array([True]))
            drawn = {tuple(sorted(map(tuple, solid.points[face]))) for face in faces}
            self.assertEqual(drawn, {tuple(sorted(map(tuple, solid.points[row]))) for rows in solid.boundary_facets.values() for row in rows})

    def test_in_notebooks(self):
        self.assertTrue(distorted("triangles")._repr_png_().startswith(b"\x89PNG"))

    def test_refusals_are_sentences(self):
        planar, solid = distorted("triangles"), grid("tetrahedra", 3)
        for sentence, call in (("did you mean", lambda: planar.plot("mean rato")),
                               ("values has the shape", lambda: planar.plot(values=[1, 2])),
                               ("Axes of matplotlib", lambda: planar.plot(ax=3)),
                               ("Axes in space", lambda: solid.plot(ax=pyplot.figure().add_subplot())),
                               ("cut is 'w'", lambda: solid.plot(cut="w")),
                               ("no cell is beyond", lambda: solid.plot(cut=("x", -9.0)))):
            with self.subTest(sentence), self.assertRaisesRegex(smoothfem.InputError, sentence):
                call()


if __name__ == "__main__":
    unittest.main()
