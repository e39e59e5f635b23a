# SPDX-License-Identifier: GPL-3.0-or-later
"""Optimal Delaunay triangulation (Chen, Mesh smoothing schemes based on optimal Delaunay triangulations, 13th
International Meshing Roundtable, 2004) for triangles and tetrahedra:

    smoothfem smooth in.vtu -m python:odt.py:OptimalDelaunay -o out.vtu
"""

import numpy as np


class OptimalDelaunay:
    """Each free node moves to the mean of the circumcentres of its simplices, weighted by their volumes."""

    title = "Optimal Delaunay"
    parameters = {"relaxation": (1.0, "fraction of the way that a node goes; 1 is the published step")}

    def initialize(self, mesh):
        if set(mesh.blocks) - {"triangle", "tetrahedron"}:
            raise ValueError(f"meshes of triangles or tetrahedra only, but there is a {list(mesh.blocks)[-1]}")
        self.cells, self.free = mesh.cells.astype(np.intp), mesh.free.astype(np.intp)

    def step(self, mesh):
        corners = mesh.points[self.cells]
        edges = corners[:, 1:] - corners[:, :1]  # from the first corner; relative to it, the centre c has 2 e . c = e . e
        volumes = np.linalg.det(edges)  # up to a factor, which cancels in the mean
        centres = corners[:, 0] + np.linalg.solve(edges, 0.5 * (edges**2).sum(axis=2)[..., None])[..., 0]

        def sums(numbers):
            every = np.bincount(self.cells.ravel(), np.repeat(numbers, self.cells.shape[1]), mesh.n_nodes)
            return every[self.free]

        moments = np.stack([sums(volumes * coordinate) for coordinate in centres.T], axis=1)
        wanted = moments / sums(volumes)[:, None]
        mesh.points[self.free] += self.relaxation * (wanted - mesh.points[self.free])
