#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""mfem_optimize.py PROGRAM IN OUT ITERATIONS [OPTION...]: MFEM's mesh-optimizer (TMOP) on a legacy VTK file of text.

PROGRAM is mesh-optimizer or its path; options such as -mid 2 -tid 1 are passed to it. It keeps nodes of the boundary
(-fix-bnd), but no other fixed nodes. Its Newton iterations start again from IN in each call. Needs python3-numpy."""

import shutil
import subprocess
import sys

import numpy as np


def optimized_points(path):
    """Returns the nodes of MFEM's file, n x 2 or n x 3. Linear elements have their nodes in the order of the vertices."""
    with open(path, encoding="utf-8") as stream:
        space, values = stream.read().split("\nnodes\n")[1].split("\n\n", 1)
    facts = dict(line.split(": ") for line in space.splitlines() if ": " in line)
    if not facts["FiniteElementCollection"].endswith("_P1") or facts["Ordering"] != "0":
        sys.exit(f"{path} has no linear elements ordered by nodes: {facts}")
    return np.array(values.split(), dtype=float).reshape(int(facts["VDim"]), -1).T


def main(program, source, target, n_iterations, *options):
    """Writes IN with the node positions of MFEM to OUT."""
    if not shutil.which(program):
        sys.exit(f"there is no program {program}")
    end = subprocess.run([program, "-m", source, "-o", "1", "-ni", n_iterations, "-fix-bnd", "-no-vis", *options],
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    print(end.stdout)
    if end.returncode != 0:
        reasons = [line for line in end.stdout.splitlines() if "MFEM abort" in line or "Verification failed" in line]
        sys.exit((reasons or [f"{program} ended with {end.returncode}"])[0])
    points = optimized_points("optimized.mesh")
    with open(source, encoding="utf-8") as stream:
        lines = stream.read().splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("POINTS ")) + 1
    n_nodes = int(lines[first - 1].split()[1])
    if len(points) != n_nodes:
        sys.exit(f"MFEM has {len(points)} of {n_nodes} nodes")
    in_space = np.zeros((n_nodes, 3))
    in_space[:, :points.shape[1]] = points
    lines[first:first + n_nodes] = (" ".join(map(repr, point)) for point in in_space.tolist())
    with open(target, "w", encoding="utf-8") as stream:
        stream.write("\n".join(lines) + "\n")


main(*sys.argv[1:])
