#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""calculix_solve.py IN OUT --clamp GROUP --load GROUP --traction "TX TY TZ" --E E --nu NU --at NODE: linear elasticity by CalculiX.

IN is a mesh in Gmsh's format 2.2 (msh22), as it keeps groups of points, edges and faces. OUT is a JSON file with the largest
displacement, the energy (twice the elastic energy), and the displacement and von Mises stress at one node. The traction, a force
per area, acts on the faces of a group. Planar meshes have the thickness 1. Needs ccx (calculix-ccx) and python3-numpy."""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

# Gmsh's type of a cell: its dimension, number of nodes, and CalculiX's element in plane strain or plane stress, or in space.
CELLS = {15: (0, 1, None), 1: (1, 2, None), 2: (2, 3, "{}3"), 3: (2, 4, "{}4"), 4: (3, 4, "C3D4"), 5: (3, 8, "C3D8"), 6: (3, 6, "C3D6")}
PLANE = {"strain": "CPE", "stress": "CPS"}
GAUSS = 1 / np.sqrt(3)


class Failure(Exception):
    """A sentence for the user."""


class Mesh:
    """Nodes by their number, and cells as (number, Gmsh's type, group, nodes)."""

    def __init__(self, path):
        """Reads a .msh file, version 2.2, as text."""
        lines = iter(Path(path).read_text(encoding="utf-8").splitlines())
        self.names, self.nodes, self.cells = {}, {}, []
        for line in lines:
            if line == "$MeshFormat" and not next(lines).startswith("2.2 0"):
                raise Failure(f"{path} is not a text file in Gmsh's format 2.2; use 'set format = msh22'")
            elif line == "$PhysicalNames":
                for _ in range(int(next(lines))):
                    dim, tag, name = next(lines).split(maxsplit=2)
                    self.names[int(dim), int(tag)] = name.strip('"')
            elif line == "$Nodes":
                for _ in range(int(next(lines))):
                    number, *x = next(lines).split()
                    self.nodes[int(number)] = np.array(x, dtype=float)
            elif line == "$Elements":
                for _ in range(int(next(lines))):
                    self.add_cell([int(word) for word in next(lines).split()])
        if not self.nodes or not self.cells:
            raise Failure(f"{path} has no nodes or no cells in Gmsh's format 2.2; use 'set format = msh22'")
        self.dim = max(CELLS[kind][0] for _, kind, _, _ in self.cells)

    def add_cell(self, words):
        number, kind, n_tags = words[:3]
        if kind not in CELLS:
            raise Failure(f"cell {number} has Gmsh's type {kind}; CalculiX takes linear cells: triangles, quadrilaterals, tetrahedra, "
                          "hexahedra and prisms")
        self.cells.append((number, kind, words[3] if n_tags else 0, words[3 + n_tags:]))

    def group(self, name, dim):
        """Returns the nodes of each cell of a group of this dimension."""
        cells = [nodes for _, kind, tag, nodes in self.cells if CELLS[kind][0] == dim and self.names.get((dim, tag)) == name]
        if not cells:
            known = sorted({label for (d, tag), label in self.names.items() if d == dim})
            raise Failure(f"the mesh has no cells of dimension {dim} in a group '{name}'; its groups of this dimension are: "
                          f"{', '.join(known) or 'none'}")
        return cells

    def node(self, name):
        """Returns the number of the node that is a group of its own, or that has this number."""
        if name.isdigit():
            if int(name) not in self.nodes:
                raise Failure(f"the mesh has no node {name}")
            return int(name)
        points = self.group(name, 0)
        if len(points) != 1:
            raise Failure(f"the group '{name}' has {len(points)} nodes; --at needs a group of one node")
        return points[0][0]


def face_shares(x):
    """Returns the integral of the shape function of each corner over an edge, a triangle or a quadrilateral."""
    if len(x) == 2:
        return np.full(2, np.linalg.norm(x[1] - x[0]) / 2)
    if len(x) == 3:
        return np.full(3, np.linalg.norm(np.cross(x[1] - x[0], x[2] - x[0])) / 6)
    shares, a, b = np.zeros(4), np.array([-1, 1, 1, -1]), np.array([-1, -1, 1, 1])
    for s in (-GAUSS, GAUSS):
        for t in (-GAUSS, GAUSS):
            along_s, along_t = a * (1 + b * t) / 4 @ x, b * (1 + a * s) / 4 @ x
            shares += (1 + a * s) * (1 + b * t) / 4 * np.linalg.norm(np.cross(along_s, along_t))
    return shares


def nodal_loads(mesh, group, traction):
    """Returns {node: force} for a traction on a group of the boundary."""
    loads = {}
    for face in mesh.group(group, mesh.dim - 1):
        for node, share in zip(face, face_shares(np.array([mesh.nodes[node] for node in face]))):
            loads[node] = loads.get(node, 0) + share * traction
    return loads


def deck(mesh, clamped, loads, options):
    """Returns CalculiX's input."""
    lines = ["*NODE, NSET=NALL"] + [", ".join(map(str, (node, *x.tolist()))) for node, x in mesh.nodes.items()]
    for kind, (dim, _, element) in CELLS.items():
        cells = [(number, nodes) for number, its_kind, _, nodes in mesh.cells if its_kind == kind]
        if dim == mesh.dim and cells:
            lines.append(f"*ELEMENT, TYPE={element.format(PLANE[options.plane])}, ELSET=EALL")
            lines += [", ".join(map(str, (number, *nodes))) for number, nodes in cells]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{options.E!r}, {options.nu!r}", "*SOLID SECTION, ELSET=EALL, MATERIAL=M"]
    lines += ["1."] if mesh.dim == 2 else []
    lines += ["*BOUNDARY"] + [f"{node}, 1, {mesh.dim}" for node in clamped]
    lines += ["*STEP", "*STATIC", "*CLOAD"]
    lines += [f"{node}, {axis + 1}, {float(force[axis])!r}" for node, force in loads.items() for axis in range(mesh.dim) if force[axis]]
    lines += ["*NODE PRINT, NSET=NALL", "U", "*EL FILE, OUTPUT=2D" if mesh.dim == 2 else "*EL FILE", "S", "*END STEP"]
    return "\n".join(lines) + "\n"


def run_ccx(text):
    """Returns the text of CalculiX's .dat and .frd files."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "job.inp").write_text(text, encoding="utf-8")
        try:
            run = subprocess.run(["ccx", "job"], cwd=folder, text=True, errors="replace", stdin=subprocess.DEVNULL,
                                 capture_output=True, check=False)
        except OSError:
            raise Failure("there is no program ccx; on Debian: apt install calculix-ccx") from None
        complaints = [line.strip() for line in run.stdout.splitlines() if "*ERROR" in line]
        files = [Path(folder) / "job.dat", Path(folder) / "job.frd"]
        if run.returncode or complaints or not all(file.is_file() for file in files):
            why = complaints[0] if complaints else f"exit code {run.returncode}"
            raise Failure(f"CalculiX has not solved the problem: {why}")
        return [file.read_text(encoding="utf-8", errors="replace") for file in files]


def displacements(dat):
    """Returns {node: displacement}, with the 7 digits that CalculiX prints."""
    rows = [line.split() for line in dat.splitlines() if line[:10].strip().isdigit()]
    try:
        return {int(row[0]): np.array(row[1:4], dtype=float) for row in rows}
    except ValueError:
        raise Failure("CalculiX printed a displacement that is no number; does the clamp hold the part?") from None


def von_mises(frd, node):
    """Returns the von Mises stress at a node from the stresses that CalculiX extrapolates and averages there, with 6 digits."""
    is_stress = False
    for line in frd.splitlines():
        if line.startswith(" -4"):
            is_stress = line.split()[1] == "STRESS"
        elif is_stress and line.startswith(" -1") and int(line[3:13]) == node:
            try:
                xx, yy, zz, xy, yz, zx = (float(line[13 + 12 * i:25 + 12 * i]) for i in range(6))
            except ValueError:
                break
            return np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * (xy ** 2 + yz ** 2 + zx ** 2))
    raise Failure(f"CalculiX gives no stress at node {node}")


def solve(options):
    """Returns the numbers."""
    if not 0 < options.E < np.inf or not -1 < options.nu < 0.5:
        raise Failure(f"E is {options.E:g} and nu is {options.nu:g}, but E has to be positive and nu between -1 and 0.5")
    mesh = Mesh(options.mesh)
    at = mesh.node(options.at)
    clamped = sorted({node for group in options.clamp for face in mesh.group(group, mesh.dim - 1) for node in face})
    loads = nodal_loads(mesh, options.load, options.traction)
    dat, frd = run_ccx(deck(mesh, clamped, loads, options))
    u = displacements(dat)
    missing = [node for node in (at, *loads) if node not in u]
    if missing:
        raise Failure(f"CalculiX gives no displacement of node {missing[0]}")
    numbers = {"u_max": max(np.linalg.norm(value) for value in u.values()),
               "energy": sum(force @ u[node] for node, force in loads.items()),  # force times displacement: the square of the energy norm
               "u_at": np.linalg.norm(u[at]), "von_mises_at": von_mises(frd, at)}
    wrong = [name for name, value in numbers.items() if not np.isfinite(value)]
    if wrong:
        raise Failure(f"CalculiX gives no finite {wrong[0]}; does the clamp hold the part?")
    return {name: float(value) for name, value in numbers.items()}


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Failure(message + "; --help shows all options")


def three_numbers(text):
    numbers = [float(word) for word in text.split()]
    if len(numbers) not in (2, 3) or not np.isfinite(numbers).all():
        raise argparse.ArgumentTypeError(f"'{text}' is not two or three numbers")
    return np.array((numbers + [0.0])[:3])


def write(numbers, path):
    """Writes the numbers as JSON, all or nothing."""
    part = Path(path + ".part")
    part.write_text(json.dumps(numbers), encoding="utf-8")
    os.replace(part, path)


def parsed():
    """Returns the options of the command line."""
    parser = Parser(description="Solves linear elasticity by CalculiX.")
    parser.add_argument("mesh", metavar="IN", help="mesh in Gmsh's format 2.2, as text")
    parser.add_argument("out", metavar="OUT", help="JSON file with the numbers")
    parser.add_argument("--clamp", required=True, action="append", metavar="GROUP", help="group of edges or faces that is held; may be repeated")
    parser.add_argument("--load", required=True, metavar="GROUP", help="group of edges or faces that is loaded")
    parser.add_argument("--traction", required=True, type=three_numbers, metavar='"TX TY TZ"', help="force per area on the load group")
    parser.add_argument("--E", required=True, type=float, help="Young's modulus, in the unit of the traction")
    parser.add_argument("--nu", required=True, type=float, help="Poisson's ratio")
    parser.add_argument("--at", required=True, metavar="NODE", help="group of one node, or the number of a node")
    parser.add_argument("--plane", choices=PLANE, default="strain", help="state of planar meshes (default: strain)")
    return parser.parse_args()


def main():
    try:
        options = parsed()
        write(solve(options), options.out)
    except Failure as failure:
        sys.exit(f"calculix_solve.py: {failure}")
    except OSError as error:
        sys.exit(f"calculix_solve.py: {error.filename}: {error.strerror}")
    except (ValueError, IndexError, KeyError, StopIteration) as error:
        sys.exit(f"calculix_solve.py: {options.mesh} is damaged: {type(error).__name__}: {error}")


if __name__ == "__main__":
    main()
