# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear elasticity with linear triangles or tetrahedra, by numpy and scipy alone: a solver for studies.

The displacement is given on the whole boundary; there is no load inside. Planar problems are in plane strain."""

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve


class ElasticityP1:
    parameters = {"E": (1.0, "Young's modulus"), "nu": (0.3, "Poisson's ratio"), "bend": (0.1, "size of the given displacement")}
    numbers = {"energy": ("", "Square of the energy norm of the displacement."),
               "u_max": ("", "Largest displacement of a node.")}
    gives_matrix = True  # condition number, CG and multigrid are then recorded

    def initialize(self, mesh):
        """Computes the dofs of each cell, and the free dofs: they depend on the topology alone."""
        self.cells, dim = np.asarray(mesh.cells), mesh.points.shape[1]
        self.dofs = (self.cells[:, :, None] * dim + np.arange(dim)).reshape(len(self.cells), -1)
        free = np.ones(len(mesh.points), dtype=bool)
        free[mesh.fixed] = False
        self.free = np.flatnonzero(np.repeat(free, dim))

    def solve(self, mesh):
        """Returns the numbers of one mesh."""
        x = mesh.points
        stiffness = self.stiffness(x)
        u = self.given(x).ravel()
        u[self.free] = 0.0
        inner, load = stiffness[self.free][:, self.free].tocsc(), -(stiffness @ u)[self.free]
        u[self.free] = spsolve(inner, load)
        return {"energy": u @ stiffness @ u, "u_max": np.linalg.norm(u.reshape(x.shape), axis=1).max(),
                "matrix": inner, "right_hand_side": load}

    def given(self, x):
        """The displacement on the boundary. It solves the equations inside, too, for any E and nu."""
        u = np.zeros_like(x)
        u[:, 0] = self.bend * (x[:, 0] ** 2 - x[:, 1] ** 2)
        u[:, 1] = -2 * self.bend * x[:, 0] * x[:, 1]
        return u

    def stiffness(self, x):
        """The sum over cells of volume * B^T C B, with the strains B u."""
        n_nodes, dim = x.shape
        corners = x[self.cells]
        jacobian = corners[:, 1:] - corners[:, :1]  # rows: edges from the first corner
        gradients = np.linalg.inv(jacobian).transpose(0, 2, 1)  # of the shape functions but the first
        gradients = np.concatenate([-gradients.sum(axis=1, keepdims=True), gradients], axis=1)
        volume = np.abs(np.linalg.det(jacobian)) / (2 if dim == 2 else 6)
        mu = self.E / (2 * (1 + self.nu))
        lame = self.E * self.nu / ((1 + self.nu) * (1 - 2 * self.nu))
        # a(phi_i e_a, phi_j e_b) = lambda g_ia g_jb + mu (g_ib g_ja + delta_ab g_i . g_j)
        products = np.einsum("eia,ejb->eiajb", gradients, gradients)
        same = np.einsum("eik,ejk,ab->eiajb", gradients, gradients, np.eye(dim))
        cells = lame * products + mu * (products.transpose(0, 1, 4, 3, 2) + same)
        entries = (cells * volume[:, None, None, None, None]).reshape(len(volume), -1)
        n = self.dofs.shape[1]
        rows, columns = np.repeat(self.dofs, n, axis=1), np.tile(self.dofs, (1, n))
        return sp.csr_matrix((entries.ravel(), (rows.ravel(), columns.ravel())), shape=(n_nodes * dim,) * 2)
