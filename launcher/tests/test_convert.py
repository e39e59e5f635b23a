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


def has_meshio():
    return importlib.util.find_spec("meshio") is not None


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
