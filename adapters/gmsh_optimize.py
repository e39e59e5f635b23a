#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""gmsh_optimize.py IN OUT METHOD ITERATIONS: Gmsh's smoothers and optimizers on a .msh file.

METHOD: Laplace2D, Relocate2D, Relocate3D, HighOrderElastic, HighOrder or `default`. `default` is Gmsh's optimizer of
tetrahedra. It swaps and collapses edges; smoothfem refuses meshes with changed cells. The two of high order move midside
nodes, so that they need `second_order = true`. HighOrderElastic keeps boundary nodes and moves all others, corners, too.
HighOrder of Gmsh 4.8 moves boundary nodes near cells with a scaled Jacobian below 0.1, as the mesh has no geometry;
smoothfem refuses such meshes. Needs python3-gmsh."""

import sys
import time

import gmsh


def main(source, target, method, n_iterations):
    """Optimizes the mesh and prints the time of the optimizer alone."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.Renumber", 0)  # nodes keep their numbers
    gmsh.option.setNumber("Mesh.SaveAll", 1)
    gmsh.open(source)
    gmsh.model.mesh.createTopology()  # without curves and surfaces, Gmsh treats boundary nodes as inner ones
    if gmsh.model.getDimension() == 2 and not method.startswith("HighOrder"):
        gmsh.model.mesh.createGeometry()  # surface nodes move in the parameter plane of their surface
    start = time.perf_counter()
    if int(n_iterations) > 0:
        gmsh.model.mesh.optimize("" if method == "default" else method, force=True, niter=int(n_iterations))
    print(f"time {time.perf_counter() - start:.9f} s")
    gmsh.write(target)
    gmsh.finalize()


main(*sys.argv[1:])
