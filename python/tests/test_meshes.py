# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests meshes of the Python module: creation from arrays, views as arrays, reading and writing."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

from .built import MESHES, QUADRILATERALS, SQUARE, address, distorted, smoothfem


class Meshes(unittest.TestCase):
    def test_from_arrays(self):
        mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
        self.assertEqual((mesh.n_nodes, mesh.n_cells, mesh.dim, mesh.spacedim, mesh.kind), (9, 4, 2, 2, "planar"))
        np.testing.assert_array_equal(mesh.points, SQUARE)
        np.testing.assert_array_equal(mesh.cells, QUADRILATERALS)
        np.testing.assert_array_equal(mesh.free, [4])
        np.testing.assert_array_equal(mesh.fixed, [0, 1, 2, 3, 5, 6, 7, 8])
        lists = smoothfem.Mesh(SQUARE.tolist(), QUADRILATERALS.tolist())
        np.testing.assert_array_equal(lists.points, SQUARE)
        np.testing.assert_array_equal(lists.cells, QUADRILATERALS)
        self.assertEqual(repr(mesh), "<smoothfem.Mesh: planar, 9 nodes, 4 cells>")

    def test_cells_of_second_order(self):
        points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [.5, 0, 0], [.5, .5, 0], [0, .5, 0], [0, 0, .5], [.5, 0, .5], [0, .5, .5]]
        rows = np.array([[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]])  # as in meshio and VTK
        mesh = smoothfem.Mesh(np.array(points), {"tetra10": rows})
        self.assertEqual((mesh.order, mesh.n_nodes, mesh.n_cells), (2, 10, 1))
        np.testing.assert_array_equal(mesh.cells, rows[:, :4])
        np.testing.assert_array_equal(mesh.midside_nodes["tetra"], rows[:, 4:])
        self.assertAlmostEqual(smoothfem.quality(mesh, "size")[0], 1 / 6, places=15)
        mesh.points[5] += [.1, .1, 0]  # the edge bends outwards: its curve is a parabola
        self.assertGreater(smoothfem.quality(mesh, "size")[0], 1 / 6)
        self.assertEqual(smoothfem.Mesh(SQUARE, QUADRILATERALS).order, 1)
        self.assertEqual(smoothfem.Mesh(SQUARE, QUADRILATERALS).midside_nodes, {})
        with self.assertRaisesRegex(smoothfem.InputError, "tetra10.*10 nodes"):
            smoothfem.Mesh(np.array(points), {"tetra10": rows[:, :9]})
        disc = smoothfem.generate("disc", elements="quadrilaterals", edge_scale=16, order=2)
        self.assertAlmostEqual(smoothfem.quality(disc, "size").sum(), np.pi, places=4)
        with self.assertRaisesRegex(smoothfem.InputError, "'roof' has no meshes of second order"):
            smoothfem.generate("roof", order=2)

    def test_mixed_cells_have_blocks(self):
        cells = [[0, 1, 4, 3], [1, 2, 4], [2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]]
        mesh = smoothfem.Mesh(SQUARE, cells)
        self.assertEqual([list(cell) for cell in mesh.cells], cells)
        self.assertEqual(sorted(mesh.blocks), ["quadrilateral", "triangle"])
        np.testing.assert_array_equal(mesh.blocks["triangle"], [[1, 2, 4], [2, 5, 4]])
        np.testing.assert_array_equal(mesh.blocks["quadrilateral"], [cells[0], cells[3], cells[4]])

    def test_cells_by_meshios_names(self):
        cells = {"line": [[0, 1]], "triangle": [[1, 2, 4], [2, 5, 4]], "quad": [[0, 1, 4, 3], [3, 4, 7, 6], [4, 5, 8, 7]]}
        flat = np.column_stack([SQUARE, np.full(9, 2.0)])
        for points in (SQUARE, flat):
            mesh = smoothfem.Mesh(points, cells)
            self.assertEqual((mesh.kind, sorted(mesh.cells_dict)), ("planar", ["quad", "triangle"]))
            np.testing.assert_array_equal(mesh.cells_dict["quad"], cells["quad"])
        self.assertEqual(smoothfem.Mesh(flat, QUADRILATERALS, cell_type="quad").kind, "planar")
        self.assertEqual(smoothfem.Mesh(flat, {"quad": QUADRILATERALS}, dim=2).kind, "surface")
        pentagon = smoothfem.Mesh(SQUARE, {"polygon5": [[0, 1, 2, 4, 3]]})
        self.assertEqual(list(pentagon.cells_dict), ["polygon5"])
        for name, points in CELLS.items():
            self.assertEqual(list(smoothfem.Mesh(np.array(points, float), {name: [range(len(points))]}).cells_dict), [name])

    def test_edges_neighbours_and_boundary(self):
        mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
        self.assertEqual(mesh.edges.shape, (12, 2))
        self.assertIs(mesh.edges, mesh.edges)
        offsets, nodes = mesh.node_neighbours
        self.assertEqual(nodes[offsets[4]:offsets[5]].tolist(), [1, 3, 5, 7])
        self.assertEqual(sorted(np.unique(mesh.boundary_facets["line"])), mesh.fixed.tolist())
        self.assertEqual(mesh.boundary_facets["line"].shape, (8, 2))
        wedge = smoothfem.Mesh(np.array(CELLS["wedge"], float), {"wedge": [range(6)]})
        self.assertEqual({name: len(rows) for name, rows in wedge.boundary_facets.items()}, {"triangle": 2, "quad": 3})
        self.assertEqual(len(wedge.edges), 9)

    def test_volume_and_surface(self):
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
        self.assertEqual(smoothfem.Mesh(corners, [[0, 1, 2, 3]]).kind, "volume")
        roof = np.column_stack([SQUARE, 0.1 * SQUARE[:, 0] ** 2])
        surface = smoothfem.Mesh(roof, QUADRILATERALS, dim=2)
        self.assertEqual((surface.kind, surface.dim, surface.spacedim), ("surface", 2, 3))

    def test_shows_what_the_file_says(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "two.vtk"
            file.write_text("# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 double\n"
                            "0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0\nCELLS 2 10\n4 0 1 4 3\n4 1 2 5 4\nCELL_TYPES 2\n9 9\n"
                            "CELL_DATA 2\nSCALARS MaterialID int 1\nLOOKUP_TABLE default\n4 7\n"
                            "POINT_DATA 6\nVECTORS v double\n" + "1 2 3\n" * 6)
            mesh = smoothfem.read(file)
            np.testing.assert_array_equal(mesh.tags, [4, 7])
            np.testing.assert_array_equal(mesh.data["cell"]["MaterialID"], [4, 7])
            np.testing.assert_array_equal(mesh.data["point"]["v"], [[1, 2, 3]] * 6)
            np.testing.assert_array_equal(mesh.fixed_reasons["interface"], [1, 4])
            self.assertEqual(mesh.names, {})

    def test_four_columns_in_a_plane_are_no_tetrahedra_by_guess(self):
        with self.assertRaisesRegex(smoothfem.InputError, "the same z: give points"):
            smoothfem.Mesh(np.column_stack([SQUARE, np.zeros(9)]), QUADRILATERALS)

    def test_fixed_nodes_by_flags_or_numbers(self):
        flags = np.zeros(9, dtype=bool)
        flags[[0, 2, 6, 8]] = True
        for fixed in (flags, [0, 2, 6, 8]):
            np.testing.assert_array_equal(smoothfem.Mesh(SQUARE, QUADRILATERALS, fixed=fixed).fixed, [0, 2, 6, 8])

    def test_reading_warns_of_cells_that_it_turns_over(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "clockwise.mesh"
            path.write_text("planar_polygonal_mesh\nnodes 4\n0 0\n1 0\n1 1\n0 1\npolygons 1\n4 3 2 1 0\nfixed_node_indices 0\n")
            with self.assertWarnsRegex(UserWarning, r"clockwise\.mesh: turned over 1 of 1 cells"):
                mesh = smoothfem.read(path)
        np.testing.assert_array_equal(mesh.cells, [[3, 0, 1, 2]])

    def test_points_are_the_memory_of_the_mesh(self):
        mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
        self.assertEqual(address(mesh), smoothfem._core.address(mesh))
        before = smoothfem.quality(mesh)
        mesh.points[4] = 1.5, 1.5
        self.assertFalse(np.array_equal(smoothfem.quality(mesh), before))
        mesh.points += 1.0
        mesh.points = SQUARE
        np.testing.assert_array_equal(mesh.points, SQUARE)
        self.assertEqual(address(mesh), smoothfem._core.address(mesh))

    def test_points_outlive_their_mesh(self):
        points = smoothfem.Mesh(SQUARE, QUADRILATERALS).points
        np.testing.assert_array_equal(points, SQUARE)

    def test_numbers_are_read_only(self):
        mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
        for numbers in (mesh.cells, mesh.free, mesh.fixed, mesh.blocks["quadrilateral"]):
            with self.assertRaises(ValueError):
                numbers.flat[0] = 0
        mesh.blocks.clear()
        self.assertEqual(list(mesh.blocks), ["quadrilateral"])

    def test_copies_are_independent(self):
        mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
        other = mesh.copy()
        other.points[4] = 1.2, 1.2
        np.testing.assert_array_equal(mesh.points, SQUARE)

    def test_refuses_what_is_no_mesh(self):
        inner = SQUARE.copy()
        inner[4, 0] = np.nan
        for sentence, make in (
                ("n x 2 or n x 3", lambda: smoothfem.Mesh(SQUARE[:, :1], QUADRILATERALS)),
                ("node 4 has a coordinate", lambda: smoothfem.Mesh(inner, QUADRILATERALS)),
                ("cell 0 has the node number -1", lambda: smoothfem.Mesh(SQUARE, -QUADRILATERALS[:, ::-1] + 2)),
                ("cell 1 is not a sequence of whole numbers", lambda: smoothfem.Mesh(SQUARE, [[0, 1, 4], [0.5, 1, 4]])),
                ("cell 0", lambda: smoothfem.Mesh(SQUARE, [[0, 1, 9]])),
                ("nodes 0 to 8", lambda: smoothfem.Mesh(SQUARE, QUADRILATERALS, fixed=[9])),
                ("one a node", lambda: smoothfem.Mesh(SQUARE, QUADRILATERALS, fixed=[True])),
                ("dimension of the cells", lambda: smoothfem.Mesh(SQUARE, QUADRILATERALS, dim=3)),
                ("given as x", lambda: smoothfem.Mesh(SQUARE, QUADRILATERALS, dim="x")),
                ("needs points and cells", lambda: smoothfem.Mesh(SQUARE)),
                ("type 'tri' cannot be taken", lambda: smoothfem.Mesh(SQUARE, {"tri": []})),
                ("no planar or volume cells", lambda: smoothfem.Mesh(SQUARE, {"line": [[0, 1]]})),
                ("this type have 4 nodes", lambda: smoothfem.Mesh(SQUARE, {"quad": [[0, 1, 4]]})),
                ("dim is 3, but the cells have dimension 2", lambda: smoothfem.Mesh(SQUARE, {"quad": QUADRILATERALS}, dim=3)),
                ("n x 2 or n x 3", lambda: smoothfem.Mesh("points", QUADRILATERALS)),
                ("cells is 3", lambda: smoothfem.Mesh(SQUARE, 3))):
            with self.subTest(sentence), self.assertRaisesRegex(smoothfem.InputError, sentence):
                make()
        mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
        with self.assertRaisesRegex(smoothfem.InputError, "9 x 2 numbers"):
            mesh.points = SQUARE[:3]
        with self.assertRaisesRegex(smoothfem.InputError, "node 4"):
            mesh.points = inner
        self.assertTrue(issubclass(smoothfem.InputError, ValueError))


class Block:
    """A block of cells as meshio has it."""

    def __init__(self, kind, data):
        self.type, self.data = kind, np.asarray(data)


class Foreign:
    """Stands for a mesh of meshio, or for a grid of PyVista: an object with these attributes."""

    def __init__(self, **attributes):
        self.__dict__.update(attributes)


# A unit cell of each type, with nodes in Gmsh's order.
CELLS = {"tetra": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
         "pyramid": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [.5, .5, 1]],
         "wedge": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]],
         "hexahedron": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]}
VOLUMES = {"tetra": 1 / 6, "pyramid": 1 / 3, "wedge": 1 / 2, "hexahedron": 1}


class Bridges(unittest.TestCase):
    def two_triangles(self):
        return Foreign(points=np.array([[0., 0], [1, 0], [1, 1], [0, 1]]),
                       cells=[Block("line", [[0, 1]]), Block("triangle", [[0, 1, 2], [0, 2, 3]])],
                       point_data={"heat": np.array([1., 2, 3, 4], np.float32)},
                       cell_data={"gmsh:physical": [np.array([7]), np.array([1, 2])], "flow": [np.zeros((1, 2)), np.array([[1., 2], [3, 4]])]},
                       field_data={"steel": np.array([1, 2]), "wall": np.array([7, 1])}, cell_sets={})

    def test_tags_names_and_data_come_from_meshio(self):
        mesh = smoothfem.from_meshio(self.two_triangles())
        self.assertEqual((mesh.kind, mesh.tags.tolist()), ("planar", [1, 2]))
        self.assertEqual(mesh.names, {(2, 1): "steel", (1, 7): "wall"})
        self.assertEqual(mesh.data["cell"]["flow"].tolist()[:2], [[1, 2], [3, 4]])
        self.assertEqual(mesh.data["point"]["heat"].tolist(), [1, 2, 3, 4])
        self.assertEqual(sorted(mesh.fixed_reasons), ["boundary", "interface"])

    def test_what_a_mesh_cannot_hold_is_said(self):
        with_sets = self.two_triangles()
        with_sets.cell_sets = {"inlet": []}
        with self.assertWarnsRegex(UserWarning, "cell_sets are left out"):
            smoothfem.from_meshio(with_sets)
        with_sets.cells = [Block("triangle10", [[0, 1, 2, 3, 0, 1, 2, 3, 0, 1]])]
        with self.assertRaisesRegex(smoothfem.InputError, "triangle10"):
            smoothfem.from_meshio(with_sets)

    def test_nodes_of_each_type_are_in_order(self):
        for kind, points in CELLS.items():
            mesh = smoothfem.from_meshio(Foreign(points=np.array(points, float), cells=[Block(kind, [range(len(points))])], point_data={}, cell_data={}))
            self.assertAlmostEqual(smoothfem.quality(mesh, "size")[0], VOLUMES[kind], places=12, msg=kind)

    def test_pyvista(self):
        class Grid(Foreign):
            def cast_to_unstructured_grid(self):
                return self
        points = np.array(CELLS["wedge"], float)
        for order in ([0, 1, 2, 3, 4, 5], [0, 2, 1, 3, 5, 4]):  # VTK's order, and Gmsh's, which many programs use
            mesh = smoothfem.from_pyvista(Grid(points=points, offset=[0, 6], cell_connectivity=order, celltypes=[13],
                                               point_data={}, cell_data={"MaterialID": np.array([5])}, field_data={}))
            self.assertAlmostEqual(smoothfem.quality(mesh, "size")[0], .5, places=12)
            self.assertEqual(mesh.tags.tolist(), [5])

    def test_there_and_back_by_meshio(self):
        try:
            import meshio
        except ImportError:
            self.skipTest("SKIPPED: python3-meshio is not installed")
        mesh = smoothfem.from_meshio(self.two_triangles())
        there = smoothfem.to_meshio(mesh)
        self.assertIsInstance(there, meshio.Mesh)
        self.assertEqual(smoothfem.Mesh(there.points, there.cells_dict).cells.tolist(), mesh.cells.tolist())
        self.assertEqual(meshio.Mesh(mesh.points, mesh.cells_dict).cells_dict["triangle"].tolist(), mesh.cells.tolist())
        for call in (smoothfem.Mesh, smoothfem.quality, lambda m: smoothfem.smooth(m, "getme")):
            with self.assertRaisesRegex(smoothfem.InputError, "mesh of meshio: call smoothfem.from_meshio"):
                call(there)
        self.assertEqual({block.type: len(block.data) for block in there.cells}, {"line": 1, "triangle": 2})
        self.assertEqual([part.tolist() for part in there.cell_data["gmsh:physical"]], [[7], [1, 2]])
        self.assertEqual(there.field_data["wall"].tolist(), [7, 1])
        self.assertEqual(there.point_data["heat"].dtype, np.float32)
        back = smoothfem.from_meshio(there)
        self.assertEqual((back.tags.tolist(), back.names), (mesh.tags.tolist(), mesh.names))
        np.testing.assert_array_equal(back.data["cell"]["flow"], mesh.data["cell"]["flow"])
        for kind, points in CELLS.items():
            solid = smoothfem.Mesh(np.array(points, float), [range(len(points))], dim=3)
            self.assertEqual(smoothfem.to_meshio(solid).cells[0].data.tolist(), [list(range(len(points)))], kind)

    def test_there_and_back_by_pyvista(self):
        try:
            import pyvista
        except ImportError:
            self.skipTest("SKIPPED: pyvista is not installed")
        mesh = smoothfem.from_meshio(self.two_triangles())
        there = smoothfem.to_pyvista(mesh)
        self.assertIsInstance(there, pyvista.UnstructuredGrid)
        back = smoothfem.from_pyvista(there)
        self.assertEqual((back.tags.tolist(), back.names), (mesh.tags.tolist(), mesh.names))


class Rules(unittest.TestCase):
    """Rules for nodes that by default stay, and ideal cells, in smooth()."""

    def test_interfaces_boundaries_and_targets(self):
        x, y = np.meshgrid(np.arange(5.), np.arange(5.))
        points = np.c_[x.ravel(), y.ravel()]
        corner = (np.arange(4)[:, None] * 5 + np.arange(4)).ravel()
        cells = np.c_[corner, corner + 1, corner + 6, corner + 5]
        points[12] += .3
        points[2, 0] += .3
        tags = np.where(points[cells].mean(axis=1)[:, 0] < 2, 1, 2)
        mesh = smoothfem.from_meshio(Foreign(points=points, cells=[Block("quad", cells)], point_data={}, cell_data={"gmsh:physical": [tags]}))
        moved = {}
        for rules in ({}, {"interfaces": "free"}, {"boundary": "slide"}, {"target": "initial-size"}):
            copy = mesh.copy()
            smoothfem.smooth(copy, "getme", **rules)
            moved[tuple(rules)] = np.flatnonzero((copy.points != mesh.points).any(axis=1)).tolist()
        self.assertNotIn(12, moved[()])
        self.assertIn(12, moved["interfaces",])
        self.assertNotIn(2, moved["interfaces",])
        self.assertIn(1, moved["boundary",])
        self.assertTrue(moved["target",])
        with self.assertRaisesRegex(smoothfem.InputError, "no periodic partners"):
            smoothfem.smooth(mesh, "getme", periodic="smooth")
        with self.assertRaisesRegex(smoothfem.InputError, "slide"):
            smoothfem.smooth(mesh, "getme", boundary="sldie")


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_come_back_as_they_were(self):
        for elements in MESHES:
            with self.subTest(elements):
                mesh = distorted(elements)
                smoothfem.write(mesh, self.folder / "m.vtu", cell={"q": smoothfem.quality(mesh)})
                again = smoothfem.read(self.folder / "m.vtu")
                np.testing.assert_array_equal(again.points, mesh.points)
                np.testing.assert_array_equal(again.cells, mesh.cells)
                self.assertIn(b'"q"', (self.folder / "m.vtu").read_bytes())

    def test_refused_in_a_sentence(self):
        with self.assertRaisesRegex(smoothfem.InputError, "nothing.vtu"):
            smoothfem.read(self.folder / "nothing.vtu")
        mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
        with self.assertRaises(smoothfem.InputError):
            smoothfem.write(mesh, self.folder / "m.doc")
        with self.assertRaises(smoothfem.InputError):
            smoothfem.write(mesh, self.folder / "m.vtu", cell={"q": [1.0]})


if __name__ == "__main__":
    unittest.main()
