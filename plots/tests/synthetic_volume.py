# SPDX-License-Identifier: GPL-3.0-or-later
"""Tiny volume meshes for a results folder: a box of bricks as hexahedra or tetrahedra."""

import itertools
import json
from pathlib import Path

import numpy as np

from plots.tests.synthetic_results import data_array, write_results

METHODS = ("weighted-laplace", "smart-laplace", "global-optimization", "getme")
VTK_TYPES = {"tet": 10, "hex": 12}


def box(kind, size=(4, 2, 3)):
    """Points (n, 3) in the unit cells of a box and cells (m, 4) or (m, 8) in VTK's order of nodes."""
    corners = [c + 1 for c in size]
    numbers = np.arange(np.prod(corners)).reshape(corners)
    points = np.argwhere(numbers >= 0).astype(float)

    def corner(i, j, k):
        return numbers[i:size[0] + i, j:size[1] + j, k:size[2] + k].ravel()
    if kind == "hex":
        floor = ((0, 0), (1, 0), (1, 1), (0, 1))
        return points, np.stack([corner(i, j, k) for k in (0, 1) for i, j in floor], axis=1)
    cells = []
    for order in itertools.permutations(range(3)):  # six tetrahedra along the diagonal of each brick
        at = np.zeros(3, dtype=int)
        path = [corner(*at)]
        for axis in order:
            at[axis] = 1
            path.append(corner(*at))
        odd = np.linalg.det(np.eye(3)[list(order)]) < 0
        cells.append(np.stack([path[i] for i in ((0, 2, 1, 3) if odd else (0, 1, 2, 3))], axis=1))
    return points, np.concatenate(cells)


def write_volume_vtu(path, kind, quality=0.8):
    """A box of one kind of cells, one of them invalid."""
    points, cells = box(kind)
    ratios = np.full(len(cells), quality)
    ratios[0] = -0.1
    parts = {
        "PointData": [data_array("exact_solution", points.sum(axis=1), "binary")],
        "CellData": [data_array("mean_ratio", ratios, "binary")],
        "Points": [data_array("Points", points, "binary", 3)],
        "Cells": [data_array("connectivity", cells.ravel(), "binary"),
                  data_array("offsets", cells.shape[1] * np.arange(1, len(cells) + 1), "binary"),
                  data_array("types", np.full(len(cells), VTK_TYPES[kind], dtype=np.uint8), "binary")]}
    body = "".join(f"<{name}>{''.join(arrays)}</{name}>" for name, arrays in parts.items())
    Path(path).write_text(
        '<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="1.0" '
        'byte_order="LittleEndian" header_type="UInt64"><UnstructuredGrid>'
        f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">{body}</Piece>'
        '</UnstructuredGrid></VTKFile>')


def write_volume_results(folder, study="volume", meshes=("tet", "hex"), methods=METHODS):
    """A complete folder of a volume study; mesh names begin with their kind of cells."""
    folder = write_results(folder, study, meshes, methods)
    for mesh in meshes:
        for number, method in enumerate(("initial", *methods)):
            write_volume_vtu(folder / "meshes" / f"{mesh}_{method}.vtu", mesh[:3], 0.4 + 0.1 * number)
    (folder / "provenance.json").write_text(json.dumps({
        "study": study, "study_title": "Volume", "scale": "quick",
        "meshes": [{"name": mesh, "title": mesh.title(), "dimension": 3, "published": False}
                   for mesh in meshes]}))
    return folder
