# SPDX-License-Identifier: GPL-3.0-or-later
"""Poisson's equation with u = |x|^2 by linear elements and numpy: a class for studies, and a program.

    poisson_in_python.py IN OUT    IN: a mesh (legacy VTK, text); OUT: its errors (JSON)"""

import itertools
import json
import sys

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

CORNERS = {2: [(0, 0), (1, 0), (1, 1), (0, 1)]}
CORNERS[3] = [(*c, z) for z in (0, 1) for c in CORNERS[2]]


def rule(dim, n_corners):
    """Points of the reference cell, and weights: 3 Gauss points in each direction, or 5 collapsed ones on simplices."""
    is_simplex = n_corners == dim + 1
    x, w = np.polynomial.legendre.leggauss(5 if is_simplex else 3)
    points = np.array(list(itertools.product((x + 1) / 2, repeat=dim)))
    weights = np.prod(list(itertools.product(w / 2, repeat=dim)), axis=1)
    if is_simplex:
        for d in range(1, dim):  # x_d becomes x_d (1 - x_0 - ... - x_{d-1})
            rest = 1 - points[:, :d].sum(axis=1)
            points[:, d] *= rest
            weights = weights * rest
    return points, weights


def shapes(dim, n_corners, points):
    """Values and gradients of the linear functions: arrays of (points, corners) and (points, corners, dim)."""
    if n_corners == dim + 1:
        values = np.column_stack([1 - points.sum(axis=1), points])
        gradients = np.broadcast_to(np.vstack([-np.ones(dim), np.eye(dim)]), (len(points), dim + 1, dim))
        return values, gradients
    factors = np.array([[[x if c else 1 - x for x, c in zip(p, corner)] for corner in CORNERS[dim]] for p in points])
    slopes = np.array([[1.0 if c else -1.0 for c in corner] for corner in CORNERS[dim]])
    gradients = np.stack([slopes[:, d] * np.prod(np.delete(factors, d, axis=2), axis=2) for d in range(dim)], axis=2)
    return factors.prod(axis=2), gradients


def errors(x, cells, free):
    """Solves, and returns the errors in the L2 and H1 norms. x: nodes; cells: a row for each; free: the nodes without a given value."""
    dim, n = x.shape[1], cells.shape[1]
    points, weights = rule(dim, n)
    values, slopes = shapes(dim, n, points)
    jacobian = np.einsum("qka,ekd->eqda", slopes, x[cells])
    gradients = np.einsum("qka,eqad->eqkd", slopes, np.linalg.inv(jacobian))
    volume = weights * np.abs(np.linalg.det(jacobian))
    positions = np.einsum("qk,ekd->eqd", values, x[cells])
    entries = np.einsum("eq,eqid,eqjd->eij", volume, gradients, gradients)
    rows, columns = np.repeat(cells, n, axis=1), np.tile(cells, (1, n))
    stiffness = sp.csr_matrix((entries.ravel(), (rows.ravel(), columns.ravel())), (len(x), len(x)))
    load = np.bincount(cells.ravel(), (-2 * dim * np.einsum("eq,qk->ek", volume, values)).ravel(), len(x))
    u = (x ** 2).sum(axis=1)
    u[free] = 0.0
    u[free] = spsolve(stiffness[free][:, free].tocsc(), (load - stiffness @ u)[free])
    difference = np.einsum("qk,ek->eq", values, u[cells]) - (positions ** 2).sum(axis=2)
    slope = np.einsum("eqkd,ek->eqd", gradients, u[cells]) - 2 * positions
    l2 = (volume * difference ** 2).sum()
    return {"l2_error": float(np.sqrt(l2)), "h1_error": float(np.sqrt(l2 + (volume * (slope ** 2).sum(axis=2)).sum()))}


class Poisson:
    numbers = {"l2_error": ("", "Error in the L2 norm."), "h1_error": ("", "Error in the H1 norm.")}

    def solve(self, mesh):
        """Returns the errors on a mesh with cells of one type."""
        return errors(mesh.points, np.asarray(mesh.cells), np.asarray(mesh.free))


def main(source, target):
    """Reads a mesh of the unit square or cube, with cells of one type, and u given on the whole boundary."""
    words = open(source, encoding="utf-8").read().split()
    at = words.index("POINTS")
    n_nodes = int(words[at + 1])
    x = np.array(words[at + 3:at + 3 + 3 * n_nodes], dtype=float).reshape(-1, 3)
    at = words.index("CELLS")
    n_cells = int(words[at + 1])
    if words[at + 3] == "OFFSETS":  # of version 5
        at = words.index("CONNECTIVITY")
        cells = np.array(words[at + 2:words.index("CELL_TYPES")], dtype=int).reshape(n_cells - 1, -1)
    else:
        cells = np.array(words[at + 3:words.index("CELL_TYPES")], dtype=int).reshape(n_cells, -1)[:, 1:]
    if np.all(x[:, 2] == 0):
        x = x[:, :2]
    inside = np.all((x > 1e-12) & (x < 1 - 1e-12), axis=1)
    with open(target, "w", encoding="utf-8") as file:
        json.dump(errors(x, cells, np.flatnonzero(inside)), file)


if __name__ == "__main__":
    main(*sys.argv[1:])
