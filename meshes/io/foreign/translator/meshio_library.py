# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of meshio."""

import numpy as np

from .mesh import Failure


def meshio():
    try:
        import meshio
    except ImportError:
        raise Failure("this format needs meshio; on Debian: apt install python3-meshio python3-h5py") from None
    return meshio


def write_by_meshio(mesh, path, file_format, **options):
    library = meshio()
    names = {3: "line", 5: "triangle", 9: "quad", 10: "tetra", 12: "hexahedron", 13: "wedge", 14: "pyramid"}
    starts = np.concatenate([[0], np.flatnonzero(np.diff(mesh.types)) + 1, [len(mesh.types)]])
    blocks = [(names[mesh.types[a]], mesh.nodes[mesh.offsets[a]:mesh.offsets[b]].reshape(b - a, -1))
              for a, b in zip(starts[:-1], starts[1:])]
    cell_data = {name: np.split(values, starts[1:-1]) for name, values in mesh.cell_data.items()}
    library.write(path, library.Mesh(mesh.points, blocks, mesh.point_data, cell_data), file_format=file_format, **options)
