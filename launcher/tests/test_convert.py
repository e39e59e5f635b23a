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


class Convert(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "cube.msh").write_text(CUBE)
        (self.folder / "roof.vtk").write_text(SURFACE)

    def convert(self, source, target, code=0):
        done = run(SMOOTHFEM, "convert", source, target, folder=self.folder, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def mesh(self, name):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        self.convert(name, "read.vtu")
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.folder / "read.vtu"))
        reader.Update()
        grid = reader.GetOutput()
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
        if not importlib.util.find_spec("meshio"):
            self.skipTest("SKIPPED: python3-meshio is not installed")
        self.assertIn("names of groups", self.convert("cube.msh", "cube.xdmf"))
        cells, tags = self.mesh("cube.xdmf")
        self.expect_same_cells(cells, self.mesh("cube.msh")[0])
        self.assertEqual(sorted(tags), [4, 6, 9])

    def test_surfaces(self):
        initial = self.mesh("roof.vtk")[0]
        self.convert("roof.vtk", "roof.stl")
        self.expect_same_cells(self.mesh("roof.stl")[0], initial, 1e-7)
        if not importlib.util.find_spec("meshio"):
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
