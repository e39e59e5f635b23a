# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts meshes to formats of other programs and back, by the command `convert`."""

import importlib.util
import tempfile
import unittest
from pathlib import Path

import numpy as np

from .build_folder import SMOOTHFEM, run

CUBE = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 9 "wall"
3 4 "steel"
$EndPhysicalNames
$Nodes
12
1 0 0 0
2 1.1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1.2 1
8 0 1 1
9 0 0 2
10 1 0 2
11 1 1 2
12 0 1 2
$EndNodes
$Elements
3
1 3 2 9 1 1 2 3 4
2 5 2 4 1 1 2 3 4 5 6 7 8
3 5 2 6 1 5 6 7 8 9 10 11 12
$EndElements
"""

SURFACE = """# vtk DataFile Version 3.0
roof
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 4 double
0 0 0
1 0 0
1 1 0.5
0 1 0.25
CELLS 2 8
3 0 1 2
3 0 2 3
CELL_TYPES 2
5
5
"""


# A quadrilateral and a triangle, a line and a point, with fields of several components.
MIXED = """# vtk DataFile Version 3.0
mixed
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 double
0 0 0
1.1 0 0
1 1 0
0 1 0
2 0.4 0
CELLS 4 14
4 0 1 2 3
3 1 4 2
2 0 1
1 4
CELL_TYPES 4
9
5
3
1
"""

MIXED_FIELDS = """CELL_DATA 4
FIELD cells 2
MaterialID 1 4 int
7 7 5 6
stress 9 4 double
1 2 3 4 5 6 7 8 9  2 2 3 4 5 6 7 8 9  3 2 3 4 5 6 7 8 9  4 2 3 4 5 6 7 8 9
POINT_DATA 5
FIELD points 2
displacement 3 5 double
1 2 3  4 5 6  7 8 9  1 2 3  4 5 6
four 4 5 float
1 2 3 4  1 2 3 4  1 2 3 4  1 2 3 4  1 2 3 4
"""

# A prism between a tetrahedron and a pyramid.
VOLUMES = """# vtk DataFile Version 3.0
volumes
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 8 double
0 0 0
1 0 0
0 1 0
0 0 1
1 0 1
0 1 1
0.3 0.3 2
1.5 1.5 0.5
CELLS 3 18
6 0 2 1 3 5 4
4 3 4 5 6
5 1 2 5 4 7
CELL_TYPES 3
13
10
14
"""

# Two steps of a field on one triangle.
SERIES = """<Xdmf Version="3.0"><Domain><Grid GridType="Collection" CollectionType="Temporal">
<Grid GridType="Uniform">
<Topology TopologyType="Triangle"><DataItem Dimensions="1 3" NumberType="UInt" Format="XML">0 1 2</DataItem></Topology>
<Geometry GeometryType="XY"><DataItem Dimensions="3 2" Format="XML">0 0 1 0 0 1</DataItem></Geometry>
<Time Value="0"/>
<Attribute Name="u" Center="Node"><DataItem Dimensions="3" Format="XML">1 2 3</DataItem></Attribute>
</Grid>
<Grid GridType="Uniform">
<Topology TopologyType="Triangle"><DataItem Dimensions="1 3" NumberType="UInt" Format="XML">0 1 2</DataItem></Topology>
<Geometry GeometryType="XY"><DataItem Dimensions="3 2" Format="XML">0 0 2 0 0 2</DataItem></Geometry>
<Attribute Name="u" Center="Node"><DataItem Dimensions="3" Format="XML">4 5 6</DataItem></Attribute>
<Attribute Name="w" Center="Other"><DataItem Dimensions="1" Format="XML">7</DataItem></Attribute>
</Grid>
</Grid></Domain></Xdmf>
"""


def has_meshio():
    return importlib.util.find_spec("meshio") is not None


def write_exodus(path, n_dimensions, kind, elements, side_sets=(), node_sets=()):
    """Writes a file with one block 0. A set of sides has a number, a name, elements and sides. A set of nodes has a number, a
    name and nodes."""
    from scipy.io import netcdf_file
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0, 0], [0.5, 0.5, 0], [0, 0.5, 0], [0.3, 0.3, 0]], float)
    with netcdf_file(path, "w") as file:
        file.api_version = file.version = np.float32(5.1)
        file.floating_point_word_size, file.file_size, file.title = np.int32(8), np.int32(1), "test"

        def add(name, values, *dimensions):
            values = np.asarray(values)
            for dimension, size in zip(dimensions, values.shape):
                if dimension not in file.dimensions:
                    file.createDimension(dimension, size)
            variable = file.createVariable(name, "c" if values.dtype.kind == "S" else values.dtype.str[1:], dimensions)
            variable[:] = values
            return variable

        def add_groups(letters, dimension, groups):
            add(f"{letters}_status", np.ones(len(groups), np.int32), dimension)
            add(f"{letters}_prop1", np.array([group[0] for group in groups], np.int32), dimension).name = "ID"
            names = [list(group[1].ljust(33, chr(0))) for group in groups]
            add(f"{letters}_names", np.array(names).astype("S1"), dimension, "len_name")

        for name, size in (("time_step", None), ("len_string", 33), ("len_line", 81), ("four", 4), ("num_dim", n_dimensions),
                           ("num_elem", len(elements))):
            file.createDimension(name, size)
        for k, axis in enumerate("xyz"[:n_dimensions]):
            add("coord" + axis, points[:, k], "num_nodes")
        add_groups("eb", "num_el_blk", [(0, "")])
        add("connect1", np.array(elements, np.int32), "num_el_in_blk1", "num_nod_per_el1").elem_type = kind
        if side_sets:
            add_groups("ss", "num_side_sets", side_sets)
        for k, (_, _, cells, sides) in enumerate(side_sets, 1):
            add(f"elem_ss{k}", np.array(cells, np.int32), f"num_side_ss{k}")
            add(f"side_ss{k}", np.array(sides, np.int32), f"num_side_ss{k}")
        if node_sets:
            add_groups("ns", "num_node_sets", node_sets)
        for k, (_, _, nodes) in enumerate(node_sets, 1):
            add(f"node_ns{k}", np.array(nodes, np.int32), f"num_nod_ns{k}")


class Convert(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "cube.msh").write_text(CUBE)
        (self.folder / "roof.vtk").write_text(SURFACE)
        (self.folder / "mixed.vtk").write_text(MIXED + MIXED_FIELDS)
        (self.folder / "untagged.vtk").write_text(MIXED)
        (self.folder / "volumes.vtk").write_text(VOLUMES)

    def convert(self, source, target, code=0):
        done = run(SMOOTHFEM, "convert", source, target, folder=self.folder, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def grid(self, name):
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        self.convert(name, "read.vtu")
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.folder / "read.vtu"))
        reader.Update()
        return reader.GetOutput()

    def fields(self, name):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        grid = self.grid(name)
        return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
                for data in (grid.GetCellData(), grid.GetPointData()) for i in range(data.GetNumberOfArrays())}

    def mesh(self, name):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        grid = self.grid(name)
        tags = grid.GetCellData().GetArray("physical_tag")
        corners = [np.array([grid.GetPoint(grid.GetCell(c).GetPointId(k)) for k in range(grid.GetCell(c).GetNumberOfPoints())])
                   for c in range(grid.GetNumberOfCells())]
        return corners, vtk_to_numpy(tags).tolist() if tags else None

    def expect_same_cells(self, first, second, tolerance=0.0):
        def by_centre(cells):
            return sorted(cells, key=lambda corners: corners.mean(axis=0).round(6).tolist())
        for a, b in zip(by_centre(first), by_centre(second), strict=True):
            np.testing.assert_allclose(a, b, atol=tolerance)

    def test_exodus_keeps_blocks(self):
        said = self.convert("cube.msh", "cube.exo")
        self.assertIn("labelled facets", said)
        self.assertIn("names of groups", said)
        cells, tags = self.mesh("cube.exo")
        self.expect_same_cells(cells, [c for c in self.mesh("cube.msh")[0] if len(c) == 8])
        self.assertEqual(sorted(tags), [4, 6])

    def test_xdmf_keeps_facets_and_tags(self):
        if not has_meshio():
            self.skipTest("SKIPPED: python3-meshio is not installed")
        self.assertIn("names of groups", self.convert("cube.msh", "cube.xdmf"))
        cells, tags = self.mesh("cube.xdmf")
        self.expect_same_cells(cells, self.mesh("cube.msh")[0])
        self.assertEqual(sorted(tags), [4, 6, 9])

    def test_exodus_keeps_types_and_fields(self):
        self.convert("mixed.vtk", "mixed.exo")
        cells, _ = self.mesh("mixed.exo")
        np.testing.assert_array_equal(cells[0], [[1.1, 0, 0], [2, 0.4, 0], [1, 1, 0]])
        np.testing.assert_array_equal(cells[1], [[0, 0, 0], [1.1, 0, 0], [1, 1, 0], [0, 1, 0]])
        self.assertEqual(self.grid("mixed.exo").GetNumberOfPoints(), 5)
        fields = self.fields("mixed.exo")
        self.assertEqual(sorted(fields), ["MaterialID", "displacement", "fixed", "four", "stress"])
        self.assertEqual(fields["MaterialID"].tolist(), [7, 7])
        self.assertEqual(fields["MaterialID"].dtype.kind, "i")
        self.assertEqual(fields["stress"][:, 0].tolist(), [2, 1])
        self.assertEqual(fields["displacement"].tolist()[1], [4, 5, 6])
        self.assertEqual(fields["four"].tolist(), [[1, 2, 3, 4]] * 5)

    def exodus(self, name, *content, **sets):
        if importlib.util.find_spec("scipy") is None:
            self.skipTest("SKIPPED: python3-scipy is not installed")
        write_exodus(self.folder / name, *content, **sets)

    def test_exodus_sets_of_number_0_and_of_nodes(self):
        self.exodus("sets.e", 2, "QUAD4", [[1, 2, 3, 4]], side_sets=[(0, "bottom", [1], [1]), (3, "", [1], [2])],
                    node_sets=[(0, "bottom", [1, 2]), (7, "", [3]), (8, "fixed", [4])])
        said = self.convert("sets.e", "sets.msh")
        self.assertIn("the side set 0 (bottom) gets the number 4, as 0 means none", said)
        self.assertIn("node sets become fields at nodes: bottom, node_set_7, fixed_set", said)
        self.assertIn(b'1 4 "bottom"', (self.folder / "sets.msh").read_bytes())
        self.convert("sets.e", "again.e")
        for name in ("sets.e", "again.e"):
            fields = self.fields(name)
            self.assertEqual([fields[key].tolist() for key in ("bottom", "node_set_7", "fixed_set")],
                             [[1, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        cells, tags = self.mesh("sets.e")
        self.assertEqual({tag: corners.tolist() for corners, tag in zip(cells, tags) if len(corners) == 2},
                         {4: [[0, 0, 0], [1, 0, 0]], 3: [[1, 0, 0], [1, 1, 0]]})

    def test_exodus_sides_of_shells(self):
        self.exodus("shells.e", 3, "TRISHELL3", [[1, 2, 3], [1, 3, 4]],
                    side_sets=[(5, "top", [2], [1]), (6, "rim", [1, 2, 2], [3, 4, 5]), (7, "both", [1, 2], [2, 5])])
        said = self.convert("shells.e", "shells.vtu")
        self.assertIn("side sets that cover cells of the surface become fields at cells: top, both", said)
        cells, tags = self.mesh("shells.e")
        edges = sorted((tag, *corners[:, :2].ravel().tolist()) for corners, tag in zip(cells, tags) if len(corners) == 2)
        self.assertEqual(edges, [(6, 0, 0, 1, 0), (6, 0, 1, 0, 0), (6, 1, 1, 0, 1), (7, 0, 1, 0, 0)])
        fields = self.fields("shells.e")
        of_triangles = [len(corners) == 3 for corners in cells]
        self.assertEqual([fields[name][of_triangles].tolist() for name in ("top", "both")], [[0, 1], [1, 0]])

    def test_exodus_refuses_cells_that_are_not_linear(self):
        self.exodus("seven.e", 2, "TRI7", [[1, 2, 4, 5, 6, 7, 8]])
        self.assertIn("cells with 7 nodes; cells with nodes other than their corners cannot be read",
                      self.convert("seven.e", "out.vtu", code=2))
        self.exodus("patch.e", 2, "BEX_QUAD", [[1, 2, 3, 4]])
        self.assertIn("isogeometric analysis (BEX_QUAD)", self.convert("patch.e", "out.vtu", code=2))

    def test_xdmf_reads_the_last_step(self):
        if not has_meshio():
            self.skipTest("SKIPPED: python3-meshio is not installed")
        (self.folder / "series.xdmf").write_text(SERIES)
        said = self.convert("series.xdmf", "out.vtu")
        self.assertIn("only the last of 2 time steps is read", said)
        self.assertIn("the field 'w' has values elsewhere than at nodes and cells and is left out", said)
        self.assertEqual(self.fields("series.xdmf")["u"].tolist(), [4, 5, 6])
        self.assertEqual(self.mesh("series.xdmf")[0][0].tolist(), [[0, 0, 0], [2, 0, 0], [0, 2, 0]])

    def test_no_tags_come_from_nothing(self):
        self.convert("untagged.vtk", "untagged.exo")
        cells, tags = self.mesh("untagged.exo")
        self.assertEqual(sorted(map(len, cells)), [3, 4])
        self.assertIsNone(tags)

    def test_all_types_of_cells(self):
        names = ["volumes.exo"] + ["volumes.cgns", "volumes.xdmf"] * has_meshio()
        initial, _ = self.mesh("volumes.vtk")
        for name in names:
            with self.subTest(name):
                self.convert("volumes.vtk", name)
                self.expect_same_cells(self.mesh(name)[0], initial)

    def test_xdmf_leaves_out_points_only(self):
        if not has_meshio():
            self.skipTest("SKIPPED: python3-meshio is not installed")
        self.convert("mixed.vtk", "mixed.xdmf")
        self.assertEqual(sorted(map(len, self.mesh("mixed.xdmf")[0])), [2, 3, 4])
        self.assertEqual(self.fields("mixed.xdmf")["four"].tolist(), [[1, 2, 3, 4]] * 5)

    def test_a_file_that_reads_back_differently_is_not_left(self):
        (self.folder / "name.vtk").write_text(MIXED + MIXED_FIELDS.replace("stress", "\u00b5"))
        said = self.convert("name.vtk", "name.exo", code=2)
        self.assertIn("the field '\u00b5' is missing", said)
        self.assertEqual(list(self.folder.glob("*name.exo*")), [])

    def test_surfaces(self):
        initial = self.mesh("roof.vtk")[0]
        self.convert("roof.vtk", "roof.stl")
        self.expect_same_cells(self.mesh("roof.stl")[0], initial, 1e-7)
        if not has_meshio():
            self.skipTest("SKIPPED: python3-meshio is not installed")
        for name in ("roof.obj", "roof.ply"):
            self.convert("roof.vtk", name)
            self.expect_same_cells(self.mesh(name)[0], initial, 1e-7)

    def test_refuses_in_a_sentence(self):
        self.assertIn("cannot hold volume meshes", self.convert("cube.msh", "cube.stl", code=2))
        for name in ("damaged.exo", "damaged.cgns", "damaged.stl", "damaged.xdmf"):
            (self.folder / name).write_bytes(b"nothing of the kind" * 9)
            said = self.convert(name, "out.vtu", code=2)
            self.assertIn(f"smoothfem: {name}: ", said)
            self.assertNotIn("Traceback", said)
            self.assertFalse((self.folder / "out.vtu").exists())


if __name__ == "__main__":
    unittest.main()
