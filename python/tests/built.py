# SPDX-License-Identifier: GPL-3.0-or-later
"""The package smoothfem as it was built, the program, and small meshes."""

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
    """A valid mesh that has something to smooth."""
    domain, edge_scale, q_mean = MESHES[elements]
    mesh = smoothfem.generate(domain, elements=elements, edge_scale=edge_scale)
    smoothfem.distort(mesh, q_mean)
    return mesh


def address(mesh):
    """Where NumPy sees the coordinates."""
    return mesh.points.__array_interface__["data"][0]


__all__ = ["EXAMPLES", "MESHES", "PACKAGES", "PROGRAM", "QUADRILATERALS", "SOURCE", "SQUARE", "address", "distorted", "run",
           "smoothfem"]
