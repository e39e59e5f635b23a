# SPDX-License-Identifier: GPL-3.0-or-later
"""Adapters, and external programs without an adapter, take part in a study, with a record for each iteration. Tests of programs
that are not on PATH are skipped."""

import csv
import importlib.util
import math
import shutil
import tempfile
import textwrap
import unittest
from pathlib import Path

import numpy as np

from .build_folder import SMOOTHFEM, SOURCE, run

STUDY = """set dimension = {dimension}
set meshes = m
set methods = {methods}
set degrees = {degrees}
set timing runs = 1
subsection mesh m
  set domain = {domain}
  set elements = {elements}
  set edge scale = {scale}
  set distort to = {quality}
end
subsection solution
  set name = {solution}
end
"""


def adapter(command, file_format, iterations):
    """Returns the keys of a method that runs an adapter. The adapter prints its time."""
    return {"command": SOURCE / "adapters" / command, "format": file_format, "max_iterations": iterations,
            "time_pattern": "time ([0-9.]+) s"}


def needs(program):
    return unittest.skipUnless(shutil.which(program), f"{program} is not on PATH")


needs_torch = unittest.skipUnless(importlib.util.find_spec("torch"), "python3-torch is not installed")


class Study(unittest.TestCase):
    """Runs studies in a folder."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def study(self, methods, degrees="", **mesh):
        """Returns the rows of summary.csv by method, and of iterations.csv. methods: their keys."""
        text = STUDY.format(methods=", ".join(methods), degrees=degrees, **mesh)
        for label, keys in methods.items():
            text += f"subsection method {label}\n" + "".join(f"  set {key} = {keys[key]}\n" for key in keys) + "end\n"
        (self.folder / "s.prm").write_text(text)
        run(SMOOTHFEM, "study", "s.prm", "--out", "out", "--quiet", "--force", "--no-figures", folder=self.folder)
        tables = []
        for name in ("summary.csv", "iterations.csv"):
            with open(self.folder / "out" / name, newline="", encoding="utf-8") as stream:
                tables.append(list(csv.DictReader(stream)))
        return {row["method"]: row for row in tables[0]}, tables[1]

    def check(self, summary, rows, label, iterations, resolution=0.0):
        """Asserts that a method has improved the mesh and has a record of each of these iterations, with a time. The time is 0
        if it is below the resolution."""
        self.assertEqual(summary[label]["status"], "not solved", label)
        self.assertGreater(float(summary[label]["q_mean"]), float(summary["initial"]["q_mean"]), label)
        mine = [row for row in rows if row["method"] == label]
        self.assertEqual([row["iteration"] for row in mine], iterations, label)
        for row in mine[1:]:
            self.assertLess(0.0, float(row["smoothing_seconds"]) + resolution)
            self.assertLess(float(row["smoothing_seconds"]), float(row["wall_seconds"]))


class Debian(Study):
    """Tests of programs that are Debian packages."""

    def test_planar(self):
        summary, rows = self.study(
            {"gmsh": adapter("gmsh_optimize.py {in} {out} Laplace2D {iterations}", "msh", 4)},
            dimension=2, domain="gear", elements="triangles", scale=4, quality=0.7, solution="gear")
        self.check(summary, rows, "gmsh", ["0", "1", "2", "4"])

    def test_planar_quadrilaterals(self):
        summary, rows = self.study(
            {"sfepy": adapter("sfepy_taubin.py {in} {out} {iterations}", "vtk", 4)},
            dimension=2, domain="gear", elements="quadrilaterals", scale=3, quality=0.8, solution="gear")
        self.check(summary, rows, "sfepy", ["0", "1", "2", "4"])

    def test_volume(self):
        summary, rows = self.study(
            {"gmsh": adapter("gmsh_optimize.py {in} {out} Relocate3D {iterations}", "msh", 2),
             "swaps": adapter("gmsh_optimize.py {in} {out} default {iterations}", "msh", 1),
             "sfepy": adapter("sfepy_taubin.py {in} {out} {iterations}", "vtk", 2)},
            dimension=3, domain="flange", elements="tetrahedra", scale=4, quality=0.7, solution="volume")
        self.check(summary, rows, "gmsh", ["0", "1", "2"])
        self.check(summary, rows, "sfepy", ["0", "1", "2"])
        self.assertRegex(summary["swaps"]["status"], r"^not solved$|^failed: its mesh has ")

    def test_gmsh_moves_midside_nodes(self):
        """Four TRI6 around the middle of a square; its lower side bulges into the first one. Only with `second_order` does Gmsh
        get midside nodes. It moves all nodes inside and keeps the boundary."""
        points = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1), (1, .35), (2, 1), (1, 2), (0, 1), (.5, .5), (1.5, .5), (1.5, 1.5),
                  (.5, 1.5)]
        cells = [(0, 1, 4, 5, 10, 9), (1, 2, 4, 6, 11, 10), (2, 3, 4, 7, 12, 11), (3, 0, 4, 8, 9, 12)]
        lines = ["# vtk DataFile Version 3.0", "square", "ASCII", "DATASET UNSTRUCTURED_GRID", "POINTS 13 double",
                 *(f"{x} {y} 0" for x, y in points), "CELLS 4 28", *("6 " + " ".join(map(str, cell)) for cell in cells),
                 "CELL_TYPES 4", *["22"] * len(cells)]
        (self.folder / "square.vtk").write_text("\n".join(lines) + "\n")
        command = f"command={SOURCE}/adapters/gmsh_optimize.py {{in}} {{out}} HighOrderElastic 1"
        run(SMOOTHFEM, "smooth", "square.vtk", "-m", "command", "--set", command, "--set", "format=msh", "--set",
            "second_order=true", "--allow-worse", "-o", "out.inp", folder=self.folder)
        text = (self.folder / "out.inp").read_text().upper()
        rows = [line.split(",") for line in text.split("*NODE", 1)[1].split("*ELEMENT")[0].splitlines() if line[:1].isdigit()]
        moved = [math.dist(point, map(float, row[1:3])) for point, row in zip(points, rows, strict=True)]
        self.assertEqual(moved[:4] + moved[5:9], [0] * 8)
        self.assertGreater(min(moved[4:5] + moved[9:]), 1e-3)

    def test_netgen(self):
        """Compiles the driver as its first lines describe."""
        text = (SOURCE / "adapters" / "netgen_driver.cc").read_text(encoding="utf-8")
        lines = text[text.index("//   mpicxx"):text.index("// LIB:")].replace("//", "").replace("\\\n", "")
        library = next(path for path in run("dpkg", "-L", "libnglib-dev").stdout.split() if path.endswith("/netgen/libmesh.so"))
        words = lines.replace("LIB/netgen", str(Path(library).parent)).split()
        words[words.index("netgen_driver.cc")] = str(SOURCE / "adapters" / "netgen_driver.cc")
        run(*words, "-O0", folder=self.folder)
        summary, rows = self.study(
            {"netgen": adapter(f"{self.folder / 'netgen_driver'} {{in}} {{out}} {{iterations}}", "vtk", 4)},
            dimension=3, domain="flange", elements="tetrahedra", scale=4, quality=0.5, solution="volume")
        self.check(summary, rows, "netgen", ["0", "1", "2", "4"])
        self.assertGreater(float(summary["netgen"]["q_mean"]), 0.7)


FLANGE = {"dimension": 3, "domain": "flange", "elements": "tetrahedra", "scale": 4, "quality": 0.5,
          "solution": "volume"}
HEXAHEDRA = {**FLANGE, "elements": "hexahedra", "quality": 0.3}
GEAR = {"dimension": 2, "domain": "gear", "elements": "triangles", "scale": 4, "quality": 0.6, "solution": "gear"}
# Mmg prints "0.301s", after a minute "1m5s ( 65.123s)".
MMG_TIME = r"PHASE 2 COMPLETED\.(?: .*\(| ) *([0-9.]+)s"


class Mmg(Study):
    def mmg(self, program, n_runs, options=""):
        return {"command": f"{program} -noinsert -noswap -nosurf {options} -v 1 {{in}} {{out}}", "format": "medit",
                "repeat": n_runs, "time_pattern": MMG_TIME}

    @needs("mmg2d_O3")
    def test_planar(self):
        summary, rows = self.study({"mmg": self.mmg("mmg2d_O3", 3)}, **GEAR)
        self.check(summary, rows, "mmg", ["0", "1", "2", "3"], resolution=1e-9)

    @needs("mmg3d_O3")
    def test_volume(self):
        """Without insertions and swaps, target sizes have no effect, and a second run moves no nodes."""
        summary, rows = self.study({"mmg": self.mmg("mmg3d_O3", 2), "optim": self.mmg("mmg3d_O3", 1, "-optim"),
                                    "sizes": self.mmg("mmg3d_O3", 1, "-hsiz 0.3")}, **FLANGE)
        self.check(summary, rows, "mmg", ["0", "1", "2"], resolution=1e-9)
        for other in ("optim", "sizes"):
            self.assertEqual(summary[other]["q_mean"], summary["mmg"]["q_mean"], other)
        self.assertEqual(*(row["q_mean"] for row in rows if row["method"] == "mmg" and row["iteration"] in ("1", "2")))


class HexSmoothing(Study):
    def hexsmoothing(self, **keys):
        return {"command": "parallelMixedSmoothing {in} {out} {iterations}", "format": "medit", "max_iterations": 4,
                "time_pattern": "Parallel smoothing > Smoothing = ([0-9.]+)s", **keys}

    @needs("parallelMixedSmoothing")
    def test_boundary_stays_where_the_file_has_it(self):
        """Only nodes of faces in the file are fixed. The VTK output has four decimals."""
        summary, rows = self.study(
            {"medit": self.hexsmoothing(), "bare": self.hexsmoothing(format="mesh"),
             "rounded": self.hexsmoothing(out_format="vtk")}, **FLANGE)
        self.check(summary, rows, "medit", ["0", "1", "2", "4"], resolution=1e-9)
        for label in ("bare", "rounded"):
            self.assertRegex(summary[label]["status"], r"^failed: it has moved \d+ fixed nodes", label)

    @needs("parallelMixedSmoothing")
    def test_hexahedra(self):
        summary, rows = self.study({"hexsmoothing": self.hexsmoothing()}, **HEXAHEDRA)
        self.check(summary, rows, "hexsmoothing", ["0", "1", "2", "4"], resolution=1e-9)


class Mfem(Study):
    def mfem(self, options):
        command = f"mfem_optimize.py mesh-optimizer {{in}} {{out}} {{iterations}} -qo 4 {options}"
        return {"command": SOURCE / "adapters" / command, "max_iterations": 4}

    @needs("mesh-optimizer")
    def test_all_elements(self):
        for mesh in (GEAR, {**GEAR, "elements": "quadrilaterals"}, FLANGE, HEXAHEDRA):
            metric = "-mid 2 -tid 1" if mesh["dimension"] == 2 else "-mid 303 -tid 1"
            with self.subTest(elements=mesh["elements"]):
                summary, rows = self.study({"mfem": self.mfem(metric)}, **mesh)
                self.check(summary, rows, "mfem", ["0", "1", "2", "4"], resolution=1e-9)

    def test_its_nodes_are_those_of_the_file(self):
        """The fake program writes all x, then all y."""
        program = self.folder / "optimizer"
        program.write_text("#!/bin/sh\necho $* > words\ncat > optimized.mesh << end\n" + textwrap.dedent("""\
            MFEM mesh v1.0

            vertices
            4

            nodes
            FiniteElementSpace
            FiniteElementCollection: H1_2D_P1
            VDim: 2
            Ordering: 0

            0
            1
            1.25
            0
            0
            0
            1.5
            1
            end
            """))
        program.chmod(0o755)
        (self.folder / "in.vtk").write_text(
            "# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
            "0 0 0\n1 0 0\n1 1 0\n0 1 0\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n9\n")
        run(SOURCE / "adapters" / "mfem_optimize.py", program, "in.vtk", "out.vtk", 7, "-mid", 2, folder=self.folder)
        self.assertEqual((self.folder / "words").read_text(), "-m in.vtk -o 1 -ni 7 -fix-bnd -no-vis -mid 2\n")
        before, after = ((self.folder / name).read_text().splitlines() for name in ("in.vtk", "out.vtk"))
        self.assertEqual([line.split() for line in after[5:9]],
                         [["0.0", "0.0", "0.0"], ["1.0", "0.0", "0.0"], ["1.25", "1.5", "0.0"], ["0.0", "1.0", "0.0"]])
        self.assertEqual(before[:5] + before[9:], after[:5] + after[9:])
        program.unlink()
        missing = run(SOURCE / "adapters" / "mfem_optimize.py", program, "in.vtk", "out.vtk", 7, folder=self.folder,
                      check=False)
        self.assertEqual((missing.returncode, missing.stderr), (1, f"there is no program {program}\n"))


@needs_torch
class Networks(Study):
    def test_exact_network(self):
        """Networks that return the mean of the neighbours give Laplace smoothing, up to the precision of float. In the convex
        square it makes no cell invalid, so the loop resets no node."""
        import torch

        class Mean(torch.nn.Module):
            def forward(self, polygon):
                return polygon.mean(dim=1)

        for n in range(3, 20):
            torch.jit.script(Mean()).save(str(self.folder / f"{n}.pt"))
        stopping = {"tolerance": 0, "max_iterations": 4}
        summary, rows = self.study(
            {"laplace": stopping, "nn": {"type": f"python:{SOURCE / 'adapters' / 'nn_smoothing.py'}:NeuralNetwork",
                                         "weights": self.folder, **stopping}},
            degrees=1, dimension=2, domain="square", elements="triangles", scale=4, quality=0.7, solution="sine")
        self.assertEqual(summary["nn"]["status"], "ok")
        laplace, nn = ([row for row in rows if row["method"] == label] for label in ("laplace", "nn"))
        self.assertEqual(len(nn), 5)
        for row, known in zip(nn, laplace, strict=True):
            for column in ("q_min", "q_mean", "l2_error"):
                self.assertTrue(math.isclose(float(row[column]), float(known[column]), rel_tol=1e-4, abs_tol=1e-6), column)

    def test_weights_are_taken_out_of_pickles(self):
        """Converts a network in torch's old format, and a pickle that would execute code if it were loaded."""
        import torch

        torch.manual_seed(3)
        layers = torch.nn.Sequential(torch.nn.Linear(10, 20), torch.nn.Sigmoid(), torch.nn.Linear(20, 7),
                                     torch.nn.Sigmoid(), torch.nn.Linear(7, 2))
        (self.folder / "from").mkdir()
        torch.save(layers, self.folder / "from" / "opt5.pkl", _use_new_zipfile_serialization=False)
        convert = SOURCE / "adapters" / "nn_weights.py"
        run(convert, "from", "to", folder=self.folder)
        polygon = torch.rand(1, 5, 2)
        np.testing.assert_allclose(torch.jit.load(str(self.folder / "to" / "5.pt"))(polygon).detach(),
                                   layers(polygon.reshape(1, 10)).detach(), atol=1e-6)

        (self.folder / "from" / "opt5.pkl").write_bytes(b"cos\nsystem\n(S'touch loaded'\ntR." * 5)
        self.assertNotEqual(run(convert, "from", "bad", folder=self.folder, check=False).returncode, 0)
        self.assertFalse((self.folder / "loaded").exists())


if __name__ == "__main__":
    unittest.main()
