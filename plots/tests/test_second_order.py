# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of cells of second order: their curved edges and faces."""

import base64
import contextlib
import io
from pathlib import Path
from unittest import mock

import numpy as np
from matplotlib import pyplot

from plots.__main__ import main
from plots.figures.curved_faces import distinct_edges, outer_faces, triangles_of_curved
from plots.figures.meshes import draw_mesh
from plots.figures.planar_geometry import areas, bounding_box, cells_in, outline_path, paths_of
from plots.figures.plane_sections import draw_section
from plots.figures.render import Scene, render
from plots.figures.section_geometry import area_of, section, section_lines
from plots.figures.shape_functions import POWERS, PYRAMIDS, nodes_of, shape_values, volume_pieces, vtk_cell
from plots.figures.virtual_display import NoDisplay
from plots.figures.volume_geometry import Cut, view_of
from plots.report.mesh_views import metrics_of, mesh_view, parts_of
from plots.results.cell_types import CELL_DIMENSIONS
from plots.results.smoothing import read_results
from plots.results.vtu import UnstructuredGrid, read_vtu, with_corners
from plots.tests.rendering import needs_rendering
from plots.tests.synthetic_results import write_results
from plots.tests.test_labels import write_labelled
from plots.tests.test_read_results import InFolder

TRI6, TRI7, QUAD8, QUAD9, TET10, HEX20, HEX27 = 22, 34, 23, 28, 24, 25, 29
X, Z = (1, 0, 0), (0, 0, 1)
BEND = 0.25


def one_cell(kind, **moved):
    """A reference cell; moved: n3=(0, 0.1) moves node 3 by so much."""
    points = np.zeros((len(nodes_of(kind)), 3))
    points[:, :CELL_DIMENSIONS[kind]] = nodes_of(kind)
    for node, by in moved.items():
        points[int(node[1:]), :len(by)] += by
    return grid_of(points, [(kind, range(len(points)))])


def grid_of(points, cells):
    return with_corners(UnstructuredGrid(
        points=np.asarray(points, dtype=float), connectivity=np.concatenate([list(nodes) for _, nodes in cells]),
        offsets=np.cumsum([0] + [len(nodes) for _, nodes in cells]), types=np.array([kind for kind, _ in cells]),
        point_data={}, cell_data={"mean_ratio": np.linspace(0.5, 0.9, len(cells))}))


def node_at(kind, place):
    return "n%d" % np.flatnonzero((nodes_of(kind) == place).all(axis=1))[0]


class ShapeFunctions(InFolder):
    def test_have_the_values_of_vtk(self):
        rng = np.random.default_rng(1)
        for kind in POWERS:
            np.testing.assert_allclose(shape_values(kind, nodes_of(kind)), np.eye(len(nodes_of(kind))), atol=1e-13)
            # VTK takes other functions in pyramids, and its Python gives prisms of 18 nodes too little memory.
            for point in rng.uniform(0.05, 0.3, (0 if kind in (*PYRAMIDS, 32) else 3, CELL_DIMENSIONS[kind])):
                cell, place = vtk_cell(kind), np.zeros(3)
                place[:len(point)] = point
                weights = [0.0] * cell.GetNumberOfPoints()
                cell.InterpolateFunctions(place.tolist(), weights)
                np.testing.assert_allclose(shape_values(kind, point[None])[0], weights, atol=1e-13)

    def test_pyramids_keep_quadratic_functions(self):
        points = np.array([[0.1, 0.2, 0.3], [0.3, 0.1, 0.6], [0.0, 0.0, 1.0]])

        def function(x):
            return 1 + x[:, 0] * x[:, 1] - 2 * x[:, 2]**2 + x[:, 0] * x[:, 2]
        np.testing.assert_allclose(shape_values(27, points) @ function(nodes_of(27)), function(points), atol=1e-13)

    def test_pieces_fill_the_cell(self):
        for kind, volume in ((TET10, 1 / 6), (HEX27, 1), (26, 1 / 2), (27, 1 / 3)):
            pieces = volume_pieces(kind, 3)
            grid = grid_of(pieces.points, [(pieces.kind, row) for row in pieces.cells])
            area = sum(map(area_of, section(grid, Cut((0, 0, 0.25), Z))[0]))
            self.assertAlmostEqual(area, {27: 0.75**2, TET10: 0.75**2 / 2}.get(kind, volume))


class Planar(InFolder):
    def test_a_bent_edge_is_a_parabola_through_its_node(self):
        for kind, node, below in ((TRI6, "n3", (0.5, -0.25)), (TRI7, "n3", (0.5, -0.25)), (QUAD8, "n4", (0.5, -0.25)),
                                  (QUAD9, "n4", (0.5, -0.25))):
            grid = one_cell(kind, **{node: (0, -BEND)})
            path, = paths_of(grid)
            others = [(0.5, 0.5), (0, 1), (0, 0.5)] if kind in (TRI6, TRI7) else [(1, 0.5), (1, 1), (0.5, 1), (0, 1), (0, 0.5)]
            np.testing.assert_allclose(path.vertices[:-1], [(0, 0), (0.5, -0.5), (1, 0), *others, (0, 0)], atol=1e-15)
            self.assertEqual(path.codes.tolist(), [1] + [3] * (len(path) - 2) + [79])
            middle = [curve(0.5).tolist() for curve in (bezier for bezier, code in path.iter_bezier() if code == 3)]
            self.assertEqual(middle[0], list(below))
            self.assertEqual(bounding_box(grid), (0, -BEND, 1, 1))
            straight = 0.5 if kind in (TRI6, TRI7) else 1.0
            self.assertAlmostEqual(areas(grid)[0], straight + 2 / 3 * BEND)
            np.testing.assert_array_equal(outline_path(grid).vertices[:3], [(0, 0), (0.5, -0.5), (1, 0)])
            a, b, c = np.moveaxis(triangles_of_curved(grid, grid.points[:, :2]), 1, 0)
            self.assertAlmostEqual(0.5 * np.cross(b - a, c - a).sum(), straight + 2 / 3 * BEND * (1 - 1 / 64))
            self.assertTrue(cells_in(grid, (0.4, -0.3, 0.6, -0.2)).all())  # where the cell has no corner

    def test_polygons_stay_whole_next_to_curved_cells(self):
        grid = grid_of([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.5, 0, 0), (0.5, 0.5, 0), (0, 0.5, 0), (2, 0, 0), (2, 1, 0), (1, 2, 0)],
                       [(TRI6, range(6)), (7, (1, 6, 7, 8, 2))])
        corners = triangles_of_curved(grid, grid.points[:, :2])
        self.assertAlmostEqual(0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).sum(), 0.5 + 2.5)
        part, = parts_of(grid).faces.values()
        n = len(part.edges) / (3 + 4)  # the pieces of each of seven edges
        self.assertEqual(n, 8)

    def test_an_edge_that_leans_reaches_beyond_its_nodes(self):
        grid = one_cell(TRI6, n3=(0.25, -BEND))  # the mean of 0 and 1 plus 1/4
        self.assertAlmostEqual(bounding_box(grid)[1], -BEND)
        grid = one_cell(TRI6, n0=(0, -0.2), n3=(0, -BEND))  # y = -0.2, -0.25, 0 has its least value between the nodes
        self.assertLess(bounding_box(grid)[1], -BEND - 1e-3)

    def test_drawn_in_the_colours_of_the_file(self):
        # A linear triangle below a curved one.
        grid = grid_of([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.5, 0, 0), (0.6, 0.6, 0), (0, 0.5, 0), (0, -1, 0)],
                       [(TRI6, range(6)), (5, (6, 1, 0))])
        axes = pyplot.figure().add_subplot()
        self.addCleanup(pyplot.close, "all")
        draw_mesh(axes, grid, None)
        drawn, = axes.collections
        self.assertEqual(drawn.get_array().tolist(), [0.5, 0.9])
        np.testing.assert_allclose(drawn.get_paths()[0].vertices[3], (0.7, 0.7))
        np.testing.assert_allclose(drawn.get_paths()[1].vertices[:3], [(0, -1), (0.5, -0.5), (1, 0)])
        self.assertEqual(len(outline_path(grid).vertices), 2 * 4 + 2)


def bulging_hexahedron():
    """The middle of the top is raised: z = 1 + 16 BEND x (1-x) y (1-y)."""
    return one_cell(HEX27, **{node_at(HEX27, (0.5, 0.5, 1)): (0, 0, BEND)})


class Volume(InFolder):
    def test_faces_of_a_bent_tetrahedron(self):
        node = node_at(TET10, (0.5, 0, 0))
        grid = one_cell(TET10, **{node: (0, -BEND, 0)})
        faces, = outer_faces(grid)
        self.assertEqual((faces.kind, len(faces.nodes)), (TRI6, 4))
        points = faces.interpolated(grid.points, 4)
        quarter = (0.25, -0.75 * BEND, 0)  # 4 s (1-s) of the bend
        self.assertEqual(np.isclose(points, quarter).all(axis=2).sum(), 2)  # two faces have the edge
        self.assertEqual([mask.sum() for mask in distinct_edges([faces])], [6])
        normals = faces.normals(grid.points, 4)
        np.testing.assert_allclose(np.linalg.norm(normals, axis=2), 1)
        flat = np.isclose(points[..., 2], 0).all(axis=1)  # the bottom stays flat
        np.testing.assert_allclose(np.abs(normals[flat]), np.broadcast_to((0, 0, 1), normals[flat].shape), atol=1e-14)

    def test_inner_faces_are_not_seen(self):
        for kind, size in ((HEX20, 8), (HEX27, 9)):
            points = np.vstack([nodes_of(kind), nodes_of(kind) + (1, 0, 0)])
            _, first, same = np.unique(points, axis=0, return_index=True, return_inverse=True)
            grid = grid_of(np.unique(points, axis=0), [(kind, row) for row in np.asarray(same).reshape(2, -1)])
            faces, = outer_faces(grid)
            self.assertEqual(faces.nodes.shape, (10, size))
            self.assertEqual(len(outer_faces(grid, np.array([True, False]))[0].nodes), 6)

    def test_a_section_follows_the_bulge(self):
        grid, cut = bulging_hexahedron(), Cut((0.5, 0, 0), X)
        polygons, cells = section(grid, cut)
        self.assertEqual(set(cells), {0})
        bulge = 2 / 3 * BEND * (1 - 1 / 36)  # below a parabola of six chords
        self.assertAlmostEqual(sum(map(area_of, polygons)), 1 + bulge)
        lines = section_lines(grid, cut)
        heights = 4 * BEND * np.linspace(0, 1, 7) * (1 - np.linspace(0, 1, 7))
        arc = np.hypot(1 / 6, np.diff(heights)).sum()
        self.assertAlmostEqual(np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1).sum(), 3 + arc)
        # A plane above all corners crosses the bulge alone, and one above the bulge nothing.
        self.assertGreater(sum(map(area_of, section(grid, Cut((0, 0, 1 + BEND / 2), Z))[0])), 0.1)
        self.assertEqual(section(grid, Cut((0, 0, 1.3), Z))[0], [])
        self.assertEqual(len(section_lines(grid, Cut((0, 0, 1.3), Z))), 0)
        axes = pyplot.figure().add_subplot()
        self.addCleanup(pyplot.close, "all")
        draw_section(axes, grid, cut)
        self.assertEqual(set(axes.collections[0].get_array()), {0.5})

    def test_a_plane_between_cells_cuts_those_on_one_side(self):
        points = np.vstack([nodes_of(HEX27), nodes_of(HEX27) + (0, 0, 1)]) + (0, 0, 0.1)
        grid = grid_of(points, [(HEX27, range(27)), (HEX27, range(27, 54))])
        polygons, cells = section(grid, Cut((0, 0, 1.1), Z))
        self.assertEqual(set(cells), {1})
        self.assertAlmostEqual(sum(map(area_of, polygons)), 1)

    @needs_rendering
    def test_rendered_faces_reach_beyond_the_corners(self):
        grid = bulging_hexahedron()
        red = np.array([[255, 0, 0]], dtype=np.uint8)
        view = view_of(grid.points, (0, -1, 0), margin=0)  # 1 wide and 1 + BEND high
        picture, = render([Scene(grid, view, (80, 100), cell_colours=red, outside_coloured=True, ambient=1.0)])
        seen = (picture[..., 0] > 200) & (picture[..., 1] < 100)
        bulge = 2 / 3 * BEND
        self.assertAlmostEqual(seen.mean(), (1 + bulge) / (1 + BEND), delta=0.02)
        self.assertTrue(seen[5, 40] and not seen[5, 5])
        with_edges, plain, values = render([
            Scene(grid, view, (80, 100), cell_colours=red, outside_coloured=True, cell_edges=True),
            Scene(grid, view, (80, 100), feature_edges=True),
            Scene(grid, view, (80, 100), point_values=grid.points[:, 0], value_colours=np.array([[0, 0, 0], [250, 0, 0]], np.uint8))])
        self.assertTrue((with_edges < 140).all(axis=2).any())
        self.assertTrue((plain < 100).all(axis=2).any())
        self.assertGreater(values[60, 70, 0], values[60, 10, 0])


class Page(InFolder):
    def test_faces_in_pieces_and_no_metrics_of_corners(self):
        grid = bulging_hexahedron()
        self.assertEqual(set(metrics_of(grid)), {"mean_ratio"})
        parts = parts_of(grid)
        places = parts.places(grid)
        self.assertEqual(places[:, 2].max(), 1 + BEND)
        surface = parts.faces["surface"]
        self.assertEqual(len(surface.triangles), 6 * 8**2 * 2)
        self.assertEqual(len(surface.edges), 12 * 8)

    def test_large_meshes_get_fewer_pieces(self):
        grid = one_cell(TET10)
        for most, pieces in ((10**6, 8), (100, 4), (50, 2)):
            with mock.patch("plots.report.mesh_views.MOST_TRIANGLES", most):
                self.assertEqual(len(parts_of(grid).faces["surface"].triangles), 4 * pieces**2)


class Study(InFolder):
    def test_a_study_has_all_figures_and_the_page(self):
        grids = {"tri": one_cell(TRI6, n3=(0, -BEND)), "ball": one_cell(TET10, n4=(0, -BEND, 0))}
        folder = write_results(self.folder / "r", meshes=tuple(grids))
        for mesh, grid in grids.items():
            cells = grid.curved
            for path in (folder / "meshes").glob(f"{mesh}_*.vtu"):
                label = (21, cells.connectivity[[0, 1, 4 if mesh == "ball" else 3]])  # an edge with a label
                write_labelled(path, grid.points, [label, (int(cells.types[0]), cells.connectivity)])
        self.assertTrue(read_vtu(folder / "meshes" / "tri_initial.vtu").is_planar)
        self.assertTrue(read_vtu(folder / "meshes" / "ball_initial.vtu").is_volume)
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors), mock.patch("plots.figures.style.DPI", 40), \
                mock.patch("plots.figures.render.virtual_display", side_effect=NoDisplay("no display here")):
            self.assertEqual(main([str(folder), "--quiet", "--format", "png"]), 0)
        self.assertNotIn("Not drawn", errors.getvalue())
        names = {path.stem for path in folder.glob("figures/*")}
        self.assertLessEqual({"figure_6_2_model", "figure_6_3_meshes", "figure_6_3_meshes_full"}, names)
        self.assertTrue((folder / "report.html").is_file())
        view = mesh_view(read_results(folder), "tri")
        places = np.frombuffer(base64.b64decode(view["states"]["getme"]["points"]), dtype="<u2").reshape(-1, 3)
        self.assertEqual(view["lower"], [0, -BEND, 0])
        self.assertEqual(places[:, 1].max(), 65535)

    def test_a_row_without_all_nodes_is_not_read(self):
        path = Path(self.folder / "m.vtu")
        write_labelled(path, one_cell(TRI6).points, [(TRI6, range(5))])
        with self.assertRaisesRegex(Exception, "not a complete VTU file"):
            read_vtu(path)
