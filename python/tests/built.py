# SPDX-License-Identifier: GPL-3.0-or-later
"""Provides the built package smoothfem, the program, and small meshes."""

import functools
import itertools
import sys

import numpy as np

from launcher.tests.build_folder import BUILD, SOURCE, run

PACKAGES = BUILD / "lib" / "python3" / "dist-packages"
sys.path.insert(0, str(PACKAGES))

import smoothfem  # noqa: E402

PROGRAM = BUILD / "libexec" / "smoothfem" / "smoothfem"
EXAMPLES = SOURCE / "python" / "examples"
SQUARE = np.array([[x, y] for y in range(3) for x in range(3)], dtype=float)
QUADRILATERALS = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]])
# Domain, elements, edge scale, mean quality to distort to.
MESHES = {"triangles": ("gear", 4.0, 0.45), "quadrilaterals": ("gear", 3.0, 0.5),
          "tetrahedra": ("flange", 4.0, 0.67), "hexahedra": ("sweep", 3.0, 0.65)}


def distorted(elements):
    """Returns a valid, distorted mesh."""
    return _distorted(elements).copy()


@functools.lru_cache
def _distorted(elements):
    domain, edge_scale, q_mean = MESHES[elements]
    mesh = smoothfem.generate(domain, elements=elements, edge_scale=edge_scale)
    smoothfem.distort(mesh, q_mean)
    return mesh


def grid(elements, n=6):
    """Returns a square or a cube of these cells with randomly moved inner nodes. Laplacian smoothing makes no cell of it
    invalid."""
    dim = 2 if elements in ("triangles", "quadrilaterals") else 3
    numbers = np.arange((n + 1) ** dim).reshape((n + 1,) * dim)
    points = np.stack(np.meshgrid(*[np.arange(n + 1.0)] * dim, indexing="ij"), axis=-1)
    inner = (slice(1, -1),) * dim
    points[inner] += np.random.default_rng(1).uniform(-0.15, 0.15, points[inner].shape)

    def corners(*steps):
        return numbers[tuple(slice(step, n + step) for step in steps)].ravel()

    if dim == 2:
        a, b, c, d = (corners(*steps) for steps in ((0, 0), (1, 0), (1, 1), (0, 1)))
        cells = [(a, b, c, d)] if elements == "quadrilaterals" else [(a, b, c), (a, c, d)]
    elif elements == "hexahedra":
        lower = ((0, 0), (1, 0), (1, 1), (0, 1))
        cells = [tuple(corners(*steps, z) for z in (0, 1) for steps in lower)]
    else:  # six around a diagonal, along the edges in every order
        cells = []
        for order in itertools.permutations(range(3)):
            path = [np.zeros(3, dtype=int)]
            for axis in order:
                path.append(path[-1] + np.eye(3, dtype=int)[axis])
            tetrahedron = [corners(*steps) for steps in path]
            cells.append(tetrahedron if np.linalg.det(np.eye(3)[list(order)]) > 0 else tetrahedron[:2] + tetrahedron[:1:-1])
    return smoothfem.Mesh(points.reshape(-1, dim), np.concatenate([np.stack(cell, axis=1) for cell in cells]))


def address(mesh):
    """Returns the address of the coordinates in NumPy."""
    return mesh.points.__array_interface__["data"][0]


__all__ = ["EXAMPLES", "MESHES", "PACKAGES", "PROGRAM", "QUADRILATERALS", "SOURCE", "SQUARE", "address", "distorted", "grid", "run",
           "smoothfem"]
