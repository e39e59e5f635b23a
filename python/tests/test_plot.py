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

    def test_planar_edges_are_parabolas(self):
        points = [[0, 0], [1, 0], [0, 1], [0.5, -0.25], [0.6, 0.6], [0, 0.5]]
        mesh = smoothfem.Mesh(points, {"triangle6": [range(6)]})
        path, = mesh.plot().collections[0].get_paths()
        # Of three control points the first and the last are the corners; the curve passes the node half way.
        np.testing.assert_allclose(path.vertices[:-1], [[0, 0], [0.5, -0.5], [1, 0], [0.7, 0.7], [0, 1], [0, 0.5], [0, 0]])
        self.assertEqual(set(path.codes[1:-1]), {3})
        drawn = mesh.plot(values=np.array(points)[:, 1]).collections[0]  # linear, so the values are those of the points
        np.testing.assert_allclose(drawn.get_array(), drawn._triangulation.y, atol=1e-15)
        self.assertAlmostEqual(drawn._triangulation.y.min(), -0.25)

    def test_edges_in_space_pass_their_nodes(self):
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
        ends = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
        nodes = [corners[list(pair)].mean(axis=0) for pair in ends]
        nodes[0] = np.array([0.5, -0.2, -0.2])
        mesh = smoothfem.Mesh(np.vstack([corners, nodes]), {"tetra10": [range(10)]})
        faces, _ = smoothfem._plot._visible_faces(mesh, np.array([True]))
        polygons, numbers, lines = smoothfem._curves.pieces(mesh, faces)
        self.assertEqual((len(polygons), sorted(set(numbers)), len(lines)), (4 * 16, [0, 1, 2, 3], 6 * 4))
        for place in (nodes[0], [0.25, -0.15, -0.15], nodes[5]):  # at 1/4 a parabola has 3/4 of its height
            of_faces = {number for polygon, number in zip(polygons, numbers) if np.isclose(polygon, place).all(axis=1).any()}
            self.assertEqual(len(of_faces), 2)
            self.assertEqual(sum(np.isclose(line, place).all(axis=1).any() for line in lines), 2)
        drawn = mesh.plot().collections[0]
        self.assertEqual(len(drawn.get_array().compressed()), len(polygons))
        self.assertEqual(len(mesh.plot(edges=False).collections[0].get_array()), len(polygons))
        drawn = mesh.plot(None).collections[0]
        self.assertEqual(len(drawn.get_facecolor()), len(polygons) + len(lines))

    def test_faces_pass_the_nodes_in_their_middles(self):
        places = [[x, y, z] for x, y, z in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))]
        pairs = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
        opposite = [(0, 7), (1, 6), (0, 5), (3, 6), (0, 2), (4, 6), (0, 6)]
        points = np.array(places + [np.add(places[a], places[b]) / 2 for a, b in pairs + opposite], float)
        points[20:26] += 0.1 * (points[20:26] - 0.5)  # the middles of the faces move outwards
        mesh = smoothfem.Mesh(points, {"hexahedron27": [range(27)]})
        polygons, _, _ = smoothfem._curves.pieces(mesh, smoothfem._plot._visible_faces(mesh, np.array([True]))[0])
        for place in points[20:26]:
            self.assertTrue(any(np.isclose(polygon, place).all(axis=1).any() for polygon in polygons))

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
