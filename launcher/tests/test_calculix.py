# SPDX-License-Identifier: GPL-3.0-or-later
"""CalculiX as a solver, by its adapter: against the program's own elasticity, and against known displacements. Skipped without ccx."""

import csv
import itertools
import json
import tempfile
import unittest
from pathlib import Path

import numpy as np

from .build_folder import SMOOTHFEM, SOURCE, run
from .test_adapters import needs

ADAPTER = SOURCE / "adapters" / "calculix_solve.py"
LOADS = ("--clamp", "clamp", "--load", "load", "--E", 200e9, "--nu", 0.3, "--at", "tip", "--traction")
STUDY = """set meshes  = box
set methods = getme-simultaneous
set solvers = own, ccx
set degrees = 1
set timing runs = 1
subsection mesh box
  set file = box.msh
end
subsection solver own
  set type         = elasticity
  set E            = 200e9
  set points       = 2
  set cg_tolerance = 1e-13
  set displacement group=clamp = 0 ; 0 ; 0
  set traction group=load      = 1e5 ; -1e6 ; 0
end
subsection solver ccx
  set command = {adapter} {{in}} {{out}} --clamp clamp --load load --traction "1e5 -1e6 0" --E 200e9 --nu 0.3 --at tip
  set format  = msh22
end
"""
# Gmsh's types of the cells and of their faces on the ends of the box.
TYPES = {"triangles": (2, 1), "quadrilaterals": (3, 1), "tetrahedra": (4, 2), "hexahedra": (5, 3), "prisms": (6, 3)}
ORDERS = {order: (-1) ** sum(a > b for a, b in itertools.combinations(order, 2)) for order in itertools.permutations(range(3))}


def corners(kind):
    """Returns the cells of one block of the grid, as steps from its first node."""
    a, b, c, d = (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)
    low = {"triangles": [(a, b, c), (a, c, d)], "prisms": [(a, b, c), (a, c, d)], "tetrahedra": []}.get(kind, [(a, b, c, d)])
    if kind in ("hexahedra", "prisms"):
        return [face + tuple((x, y, 1) for x, y, _ in face) for face in low]
    for order, sign in ORDERS.items() if kind == "tetrahedra" else ():  # six around a diagonal, along the edges in every order
        first, second = (tuple(int(axis in order[:n]) for axis in range(3)) for n in (1, 2))
        low.append(((0, 0, 0), *((first, second) if sign > 0 else (second, first)), (1, 1, 1)))
    return low


def box(kind, n=(4, 2, 2), move=0.1):
    """Returns a .msh file of a box of n cells with the edge length 1/2, whose inner nodes are moved. The groups clamp and load are its
    ends, tip is a corner of the loaded end."""
    planar = kind in ("triangles", "quadrilaterals")
    n = (*n[:2], 0) if planar else n
    numbers = np.arange(1, (n[0] + 1) * (n[1] + 1) * (n[2] + 1) + 1).reshape(n[0] + 1, n[1] + 1, n[2] + 1)
    points = np.stack(np.meshgrid(*[np.arange(k + 1.0) / 2 for k in n], indexing="ij"), axis=-1)
    inner = (slice(1, -1), slice(1, -1), 0, slice(2)) if planar else (slice(1, -1),) * 3
    points[inner] += np.random.default_rng(1).uniform(-move, move, points[inner].shape)
    cell_type, face_type = TYPES[kind]
    lines = [f"15 2 4 4 {numbers[-1, -1, -1]}"]
    for group, end in ((1, 0), (2, -1)):
        for y, z in itertools.product(range(n[1]), range(max(n[2], 1))):
            face = numbers[end, y:y + 2, 0] if planar else numbers[end, [y, y + 1, y + 1, y], [z, z, z + 1, z + 1]]
            for part in (face[[0, 1, 2]], face[[0, 2, 3]]) if face_type == 2 else (face,):
                lines.append(f"{face_type} 2 {group} {group} {' '.join(map(str, part))}")
    for block in itertools.product(range(n[0]), range(n[1]), range(max(n[2], 1))):
        for cell in corners(kind):
            lines.append(f"{cell_type} 2 3 3 " + " ".join(str(numbers[tuple(np.add(block, step))]) for step in cell))
    dim = 2 if planar else 3
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "4", '0 4 "tip"', f'{dim - 1} 1 "clamp"', f'{dim - 1} 2 "load"',
                      f'{dim} 3 "part"', "$EndPhysicalNames", "$Nodes", str(numbers.size),
                      *(f"{i} {x[0]} {x[1]} {x[2]}" for i, x in enumerate(points.reshape(-1, 3).tolist(), start=1)), "$EndNodes", "$Elements",
                      str(len(lines)), *(f"{i} {line}" for i, line in enumerate(lines, start=1)), "$EndElements", ""])


class CalculiX(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def solve(self, *words, check=True, **more):
        return run(ADAPTER, "box.msh", "out.json", *words, folder=self.folder, check=check, **more)

    @needs("ccx")
    def test_has_the_numbers_of_the_programs_own_solver(self):
        """CalculiX prints displacements with 7 digits. The mesh is smoothed, and each record is solved."""
        for kind in ("tetrahedra", "hexahedra"):
            with self.subTest(kind):
                (self.folder / "box.msh").write_text(box(kind))
                (self.folder / "s.prm").write_text(STUDY.format(adapter=ADAPTER))
                run(SMOOTHFEM, "study", "s.prm", "--out", "out", "--quiet", "--force", "--no-figures", folder=self.folder)
                with open(self.folder / "out" / "iterations.csv", newline="", encoding="utf-8") as stream:
                    rows = list(csv.DictReader(stream))
                self.assertGreater(len(rows), 2)
                for row in rows:
                    self.assertEqual(row["status"], "ok")
                    for number in ("u_max", "energy"):
                        self.assertAlmostEqual(float(row[f"ccx.{number}"]) / float(row[f"own.{number}"]), 1.0, delta=1e-6)
                self.assertGreater(float(rows[-1]["q_mean"]), float(rows[0]["q_mean"]))
                for number in ("u_at", "von_mises_at"):
                    self.assertNotEqual(rows[0][f"ccx.{number}"], rows[-1][f"ccx.{number}"])

    @needs("ccx")
    def test_tension_is_exact(self):
        """Without contraction (nu = 0), every cell has the stress of the traction t, and the end moves by t L / E, with L = 2. On
        quadrilaterals and hexahedra CalculiX 2.20 extrapolates stresses with an error of 4e-5."""
        for kind in TYPES:
            with self.subTest(kind):
                (self.folder / "box.msh").write_text(box(kind))
                self.solve("--clamp", "clamp", "--load", "load", "--traction", "5 0 0", "--E", 1000, "--nu", 0, "--at", "tip")
                found = json.loads((self.folder / "out.json").read_text())
                area = 1.0  # of the loaded end; planar boxes have the thickness 1
                for name, known in {"u_max": 0.01, "u_at": 0.01, "von_mises_at": 5.0, "energy": 5 * area * 0.01}.items():
                    self.assertAlmostEqual(found[name] / known, 1.0, delta=1e-4 if name == "von_mises_at" else 2e-6, msg=name)

    @needs("ccx")
    def test_plane_stress_is_softer_and_a_node_has_a_number(self):
        (self.folder / "box.msh").write_text(box("quadrilaterals"))
        found = []
        for words in ((), ("--plane", "stress"), ("--plane", "stress", "--at", 15)):
            self.solve(*LOADS, "0 1e6", *words)
            found.append(json.loads((self.folder / "out.json").read_text()))
        self.assertGreater(found[1]["u_max"], 1.05 * found[0]["u_max"])
        self.assertEqual(found[1], found[2])

    @needs("ccx")
    def test_mistakes_are_one_sentence(self):
        """A failed run leaves no file of numbers."""
        (self.folder / "box.msh").write_text(box("tetrahedra"))
        (self.folder / "bad.msh").write_text("$MeshFormat\n4.1 0 8\n")
        (self.folder / "cut.msh").write_text(box("tetrahedra")[:900])
        (self.folder / "old.msh").write_text(box("tetrahedra").replace(" 4 2 3 3 ", " 11 2 3 3 "))
        for words, why in {("--clamp", "left"): "no cells of dimension 2 in a group 'left'; its groups of this dimension are: clamp, load",
                           ("--load", "part"): "no cells of dimension 2 in a group 'part'",
                           ("--at", "clamp"): "no cells of dimension 0 in a group 'clamp'", ("--at", "999"): "no node 999",
                           ("--nu", "0.5"): "nu between -1 and 0.5", ("--E", "0"): "E has to be positive",
                           ("--traction", "1"): "'1' is not two or three numbers", ("--E", "steel"): "invalid float value: 'steel'",
                           ("--weight", "1"): "unrecognized arguments: --weight 1; --help shows all options",
                           ("bad.msh",): "use 'set format = msh22'", ("cut.msh",): "cut.msh is damaged",
                           ("old.msh",): "CalculiX takes linear cells", ("none.msh",): "none.msh: No such file or directory"}.items():
            with self.subTest(words):
                mesh = [words[0]] if words[0].endswith(".msh") else ["box.msh"]
                outcome = run(ADAPTER, *mesh, "out.json", *LOADS, "0 1 0", *(words if mesh == ["box.msh"] else ()), folder=self.folder, check=False)
                self.assertEqual((outcome.returncode, outcome.stderr.count("\n")), (1, 1), outcome.stderr)
                self.assertIn(why, outcome.stderr)
                self.assertFalse((self.folder / "out.json").exists())

    def test_a_missing_program_is_named(self):
        (self.folder / "box.msh").write_text(box("tetrahedra"))
        outcome = run("/usr/bin/python3", ADAPTER, "box.msh", "out.json", *LOADS, "0 1 0", folder=self.folder, check=False, PATH=self.folder)
        self.assertEqual((outcome.returncode, outcome.stderr),
                         (1, "calculix_solve.py: there is no program ccx; on Debian: apt install calculix-ccx\n"))


if __name__ == "__main__":
    unittest.main()
