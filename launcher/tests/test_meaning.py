# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mesh file means comes back from `smooth`: whole commands on small files, one test for each kind of report by users.

Results are read by meshio. Without python3-meshio the tests are skipped."""

import contextlib
import io
import re
import tempfile
import unittest
from pathlib import Path

import numpy as np

from .build_folder import SMOOTHFEM, run

try:
    import meshio
except ImportError:
    meshio = None

GMSH = {"vertex": 15, "line": 1, "triangle": 2, "quad": 3, "tetra": 4, "hexahedron": 5}
N = 8


def grid(n=N, shake=0.2, seed=1):
    """Returns points of a unit square with shaken inner nodes, and its triangles, all counterclockwise."""
    x, y = np.meshgrid(np.arange(n + 1), np.arange(n + 1))
    points = np.c_[x.ravel(), y.ravel(), np.zeros(x.size)] / n
    inner = ((points[:, :2] > 0) & (points[:, :2] < 1)).all(axis=1)
    points[inner, :2] += np.random.default_rng(seed).uniform(-shake, shake, (inner.sum(), 2)) / n
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    triangles = np.concatenate([np.c_[corner, corner + 1, corner + n + 2], np.c_[corner, corner + n + 2, corner + n + 1]])
    return points, triangles


def cube(n=4, shake=0.15, seed=1):
    """Returns points of a unit cube with shaken inner nodes, and its hexahedra."""
    i, j, k = (a.ravel() for a in np.meshgrid(*3 * [np.arange(n + 1)], indexing="ij"))
    points = np.c_[i, j, k] / n
    inner = ((points > 0) & (points < 1)).all(axis=1)
    points[inner] += np.random.default_rng(seed).uniform(-shake, shake, (inner.sum(), 3)) / n

    def at(a, b, c):
        return (a * (n + 1) + b) * (n + 1) + c
    a, b, c = (q.ravel() for q in np.meshgrid(*3 * [np.arange(n)], indexing="ij"))
    return points, np.c_[at(a, b, c), at(a + 1, b, c), at(a + 1, b + 1, c), at(a, b + 1, c),
                         at(a, b, c + 1), at(a + 1, b, c + 1), at(a + 1, b + 1, c + 1), at(a, b + 1, c + 1)]


def msh(points, *blocks, names=(), extra=""):
    """Returns the text of a .msh file of version 2.2. blocks: (type, tags, rows of nodes). names: (dimension, tag, name)."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat"]
    if names:
        lines += ["$PhysicalNames", str(len(names)), *(f'{dim} {tag} "{name}"' for dim, tag, name in names), "$EndPhysicalNames"]
    lines += ["$Nodes", str(len(points)), *(f"{i + 1} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(np.asarray(points, float).tolist())), "$EndNodes"]
    elements = [(GMSH[kind], tag, row) for kind, tags, rows in blocks for tag, row in zip(np.broadcast_to(tags, len(rows)), rows, strict=True)]
    lines += ["$Elements", str(len(elements)), *(f"{e + 1} {kind} 2 {tag} {tag} {' '.join(str(i + 1) for i in row)}" for e, (kind, tag, row) in enumerate(elements)),
              "$EndElements"]
    return "\n".join(lines) + "\n" + extra


def areas(points, triangles):
    a, b, c = (points[triangles[:, k], :2] for k in range(3))
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


@unittest.skipIf(meshio is None, "SKIPPED: python3-meshio is not installed")
class Meaning(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def smooth(self, name, text, *options, method="getme", out=None, code=0):
        """Smooths a file of this text. Returns all messages, and the result."""
        (self.folder / name).write_text(text)
        out = out or "out" + Path(name).suffix
        done = run(SMOOTHFEM, "smooth", name, "-m", method, "-o", out, "--threads", "1", *options, folder=self.folder, check=False)
        said = done.stdout + done.stderr
        self.assertEqual(done.returncode, code, said)
        if code:
            return said, None
        if Path(out).suffix in (".inp", ".mesh"):  # meshio does not read all of these
            run(SMOOTHFEM, "convert", out, "read.vtu", "--quiet", folder=self.folder)
            out = "read.vtu"
        with contextlib.redirect_stdout(io.StringIO()):
            return said, meshio.read(self.folder / out)

    def test_borders_of_materials_stay(self):
        points, triangles = grid()
        on_border = np.abs(points[:, 0] - 0.5) < 0.05
        points[on_border, 0] = 0.5
        tags = np.where(points[triangles].mean(axis=1)[:, 0] < 0.5, 1, 2)
        column = np.flatnonzero(on_border)
        line = np.c_[column[:-1], column[1:]]
        for blocks in ([("triangle", tags, triangles)], [("line", 5, line), ("triangle", 1, triangles)]):
            for method in ("smart-laplace", "getme", "global-optimization"):
                said, result = self.smooth("in.msh", msh(points, *blocks), method=method)
                np.testing.assert_array_equal(result.points[on_border], points[on_border])
                self.assertIn("on interfaces", said)
            self.assertGreater(np.abs(result.points - points).max(), 0.01)
            said, result = self.smooth("in.msh", msh(points, *blocks), "--interfaces", "slide")
            np.testing.assert_allclose(result.points[on_border, 0], 0.5, atol=1e-12)
            self.assertGreater(np.abs(result.points - points)[on_border, 1].max(), 1e-4)
            _, result = self.smooth("in.msh", msh(points, *blocks), "--interfaces", "free")
            self.assertGreater(np.abs(result.points[on_border, 0] - 0.5).max(), 1e-4)

    def test_clockwise_cells_are_turned_over_and_folded_ones_are_not(self):
        points, triangles = grid()
        triangles[::2] = triangles[::2, ::-1]
        for options in ((), ("--untangle",)):
            said, _ = self.smooth("in.msh", msh(points, ("triangle", 1, triangles)), *options)
            self.assertRegex(said, "turned over 64 of 128 cells")
        self.smooth("in.msh", msh(points, ("triangle", 1, triangles)), "--keep-orientation", code=2)
        points, triangles = grid(shake=0)
        points[N + 2 + N // 2, :2] += 2.5 / N
        said, _ = self.smooth("in.msh", msh(points, ("triangle", 1, triangles)), code=2)
        self.assertIn("--untangle", said)

    def test_arrays_of_vtk_files_count_as_tags_and_come_back(self):
        points, hexahedra = cube()
        faces = hexahedra[points[hexahedra][:, :, 0].min(axis=1) == 0][:, [0, 3, 7, 4]]
        mesh = meshio.Mesh(points, [("hexahedron", hexahedra), ("quad", faces)], point_data={"heat": points[:, 0]},
                           cell_data={"MaterialID": [np.arange(len(hexahedra)) % 2, np.full(len(faces), 3)]})
        for suffix in (".vtk", ".vtu"):
            meshio.write(self.folder / "made.vtk", mesh, file_format="vtk42", binary=False)
            _, result = self.smooth("in.vtk", (self.folder / "made.vtk").read_text(), "--allow-worse", out="out" + suffix)
            self.assertEqual({block.type: len(block.data) for block in result.cells}, {"hexahedron": 64, "quad": 16})
            self.assertEqual(sorted(set(np.concatenate(result.cell_data["MaterialID"]).tolist())), [0, 1, 3])
            np.testing.assert_array_equal(result.point_data["heat"], points[:, 0])

    def test_periodic_partners_stay_together(self):
        points, hexahedra = cube()
        low, high = np.flatnonzero(points[:, 0] == 0), np.flatnonzero(points[:, 0] == 1)
        for pair in (low, high):
            points[pair[12]] += (0, 0.08, 0.05)  # the node in the middle of the side
        pairs = "\n".join(f"{b + 1} {a + 1}" for a, b in zip(low, high, strict=True))
        text = msh(points, ("hexahedron", 1, hexahedra), extra=f"$Periodic\n1\n2 2 1\n{len(low)}\n{pairs}\n$EndPeriodic\n")
        for options in ((), ("--boundary", "slide"), ("--periodic", "smooth")):
            _, result = self.smooth("in.msh", text, *options)
            np.testing.assert_allclose(result.points[high] - result.points[low], np.broadcast_to((1, 0, 0), (25, 3)), atol=1e-12)
            self.assertIn("$Periodic", (self.folder / "out.msh").read_text())
            self.assertEqual(bool(options), bool(np.abs(result.points[low] - points[low]).max() > 0.01), options)

    def test_versions_groups_and_fields_of_msh_come_back(self):
        points, triangles = grid()
        data = "$NodeData\n1\n\"heat\"\n1\n0\n3\n0\n1\n81\n" + "".join(f"{i + 1} {i}\n" for i in range(81)) + "$EndNodeData\n"
        said, result = self.smooth("in.msh", msh(points, ("triangle", 4, triangles), names=((2, 4, "steel"),), extra=data))
        self.assertTrue((self.folder / "out.msh").read_text().startswith("$MeshFormat\n2.2 0 8\n"))
        self.assertEqual(result.field_data["steel"].tolist(), [4, 2])
        np.testing.assert_array_equal(result.point_data["heat"].ravel(), np.arange(81))
        self.assertIn("passed on unchanged", said)
        _, result = self.smooth("in.msh", msh(points, ("triangle", 4, triangles)), "--to", "msh41-text")
        self.assertTrue((self.folder / "out.msh").read_text().startswith("$MeshFormat\n4.1 0 8\n"))

    def test_hanging_nodes_are_told_and_stay(self):
        # Two squares; the right one has an edge for each half of the common side.
        points = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0], [1, .5, 0], [2, .5, 0]]
        said, result = self.smooth("in.msh", msh(points, ("quad", 1, [[0, 1, 4, 3], [1, 2, 7, 6], [6, 7, 5, 4]])))
        self.assertIn("1 hanging node", said)
        np.testing.assert_array_equal(result.points[6], points[6])

    def test_coincident_nodes_are_told_and_merged(self):
        points, triangles = grid()
        left = points[triangles].mean(axis=1)[:, 0] < 0.5
        seam = np.unique(triangles[left])[np.isin(np.unique(triangles[left]), np.unique(triangles[~left]))]
        doubled = np.concatenate([points, points[seam]])
        cut = triangles.copy()
        for copy, node in enumerate(seam):
            cut[left & (cut == node).any(axis=1)] = np.where(cut[left & (cut == node).any(axis=1)] == node, len(points) + copy,
                                                             cut[left & (cut == node).any(axis=1)])
        text = msh(doubled, ("triangle", 1, cut))
        said, result = self.smooth("in.msh", text)
        self.assertRegex(said, f"{len(seam)} coincident nodes")
        np.testing.assert_array_equal(result.points[seam], points[seam])
        said, result = self.smooth("in.msh", text, "--merge")
        self.assertEqual(len(result.points), len(points))
        self.assertGreater(np.abs(result.points[seam[1:-1]] - points[seam[1:-1]]).max(), 0.001)

    def test_abaqus_decks_come_back_whole(self):
        points, triangles = grid(4)
        deck = "*HEADING\na job\n*NODE, NSET=ALL\n" + "".join(f"{10 * i + 1}, {x!r}, {y!r}, {z!r}\n" for i, (x, y, z) in enumerate(points.tolist())) + \
            "*ELEMENT, TYPE=CPS3, ELSET=PLATE\n" + "".join(f"{7 * e + 1}, {', '.join(str(10 * i + 1) for i in row)}\n" for e, row in enumerate(triangles.tolist())) + \
            "*ELEMENT, TYPE=SPRING1, ELSET=SPRINGS\n9001, 11\n*NSET, NSET=CLAMPED\n1, 51, 101\n*MATERIAL, NAME=STEEL\n*ELASTIC\n2.1e11, 0.3\n" \
            "*STEP\n*STATIC\n*BOUNDARY\nCLAMPED, 1, 2\n*END STEP\n"
        said, result = self.smooth("job.inp", deck)
        text = (self.folder / "out.inp").read_text()
        for line in ("*NSET, NSET=CLAMPED", "*MATERIAL, NAME=STEEL", "CLAMPED, 1, 2", "9001, 11", "*END STEP"):
            self.assertIn(line, text)
        self.assertIn("SPRING1", said)
        self.assertEqual(len(result.cells_dict["triangle"]), 32)

    def test_required_edges_and_corners_of_medit_stay(self):
        points, triangles = grid()
        middle = np.arange(N + 1) + (N // 2) * (N + 1)
        edges = np.c_[middle[:-1], middle[1:]]
        text = "MeshVersionFormatted 2\nDimension 2\nVertices\n81\n" + "".join(f"{x!r} {y!r} 0\n" for x, y, _ in points.tolist()) + \
            f"Edges\n{N}\n" + "".join(f"{a + 1} {b + 1} 0\n" for a, b in edges) + f"RequiredEdges\n{N}\n" + "".join(f"{e + 1}\n" for e in range(N)) + \
            "Corners\n1\n21\nTriangles\n128\n" + "".join(f"{a + 1} {b + 1} {c + 1} 1\n" for a, b, c in triangles) + "End\n"
        said, result = self.smooth("in.mesh", text, out="out.vtu")
        for node in (*middle, 20):
            np.testing.assert_array_equal(result.points[node], points[node])
        self.assertIn("required", said)
        self.smooth("in.mesh", text, out="out.mesh")
        out = (self.folder / "out.mesh").read_text()
        self.assertTrue(re.search(r"RequiredEdges\s+8\b", out) and re.search(r"Corners\s+1\s+21\b", out))

    def test_layers_are_told_and_kept(self):
        points, triangles = grid(12, shake=0)
        heights = np.concatenate([[0], np.cumsum(1e-3 * 1.5 ** np.arange(12))])
        points[:, 1] = np.repeat(heights, 13)
        x = np.arange(13) / 12
        points[:, 0] = np.tile(x, 13)
        text = msh(points, ("line", 3, [[i, i + 1] for i in range(12)]), ("triangle", 1, triangles), names=((1, 3, "wall"),))
        said, _ = self.smooth("in.msh", text)
        self.assertIn("--keep-layers", said)
        self.assertIn("wall", said)
        _, result = self.smooth("in.msh", text, "--keep-layers", "group=wall")
        np.testing.assert_array_equal(result.points[13:26], points[13:26])

    def test_sizes_are_told_and_kept(self):
        points, triangles = grid(12)
        points[:, :2] = points[:, :2] * (0.1 + points[:, :1])
        self.assertGreater(areas(points, triangles).min(), 0)
        text = msh(points, ("triangle", 1, triangles))
        said, _ = self.smooth("in.msh", text)
        self.assertIn("cell sizes: ", said)
        for method in ("getme", "getme-adaptive", "global-optimization"):
            _, result = self.smooth("in.msh", text, "--target", "initial-size", method=method)
            factors = areas(result.points, triangles) / areas(points, triangles)
            self.assertTrue(0.5 < factors.min() and factors.max() < 2, (method, factors.min(), factors.max()))

    def test_the_plane_does_not_matter(self):
        points, triangles = grid()
        _, flat = self.smooth("in.msh", msh(points, ("triangle", 1, triangles)))
        noisy = points + np.c_[np.zeros((81, 2)), np.random.default_rng(2).uniform(-1e-12, 1e-12, 81)]
        _, result = self.smooth("in.msh", msh(noisy, ("triangle", 1, triangles)))
        np.testing.assert_allclose(result.points, flat.points, atol=1e-9)
        _, result = self.smooth("in.msh", msh(points[:, [0, 2, 1]], ("triangle", 1, triangles[:, ::-1])))
        np.testing.assert_allclose(result.points[:, [0, 2, 1]], flat.points, atol=1e-9)

    def test_a_perfect_mesh_ends_at_once(self):
        points, hexahedra = cube(8)
        said, _ = self.smooth("in.msh", msh(points, ("hexahedron", 1, hexahedra)))
        transformations = int(re.search(r"/(\d+) iterations", said).group(1))
        self.assertLess(transformations, 2 * len(hexahedra), "the last digits of q = 1 took millions")


if __name__ == "__main__":
    unittest.main()
