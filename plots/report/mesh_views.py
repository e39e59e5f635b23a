# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes in the form that the page draws: triangles with the cells they belong to, and numbers of cells as bytes.

Volume meshes have two parts: the surface, and a cut, the surface of the cells whose centres are in the half
x < middle of the initial mesh.
"""

import base64
from dataclasses import dataclass

import numpy as np

from ..figures.volume_geometry import cell_centres
from ..figures.vtk_surface import faces_of, surface_of
from ..results.rows import ResultsError
from ..results.smoothing import INITIAL
from ..results.vtu import NoVtk, read_vtu, vtk_grid, vtk_module

# Metrics of VTK (Verdict), by the names that its filter uses for each type of cell. The mean ratio of smoothfem is first.
MEAN_RATIO = "mean_ratio"
VERDICT = {"scaled_jacobian": "ScaledJacobian", "shape": "Shape"}
VERDICT_CELLS = {5: "Triangle", 9: "Quad", 10: "Tet", 12: "Hex"}
STEPS = 255  # a number of a cell is one of so many between 0 and 1
N_WORST = 10
MOST_TRIANGLES = 150_000  # a page with more would be slow to open


def base64_of(values, kind):
    """The numbers, little-endian, as text."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode()


@dataclass(frozen=True)
class Faces:
    """Faces to draw: triangles (n, 3) of nodes, the cell of each, and the edges (m, 2) of the cells."""

    triangles: np.ndarray
    cells: np.ndarray
    edges: np.ndarray


def seen_of(grid, chosen=None):
    """The outside of a grid's cells, of all of them or of those of a mask."""
    to_numpy = vtk_module("util.numpy_support").vtk_to_numpy
    surface = surface_of(vtk_grid(grid, chosen))
    nodes, offsets = faces_of(surface)
    nodes = to_numpy(surface.GetPointData().GetArray("vtkOriginalPointIds"))[nodes]
    cells = to_numpy(surface.GetCellData().GetArray("vtkOriginalCellIds"))
    if chosen is not None:
        cells = np.flatnonzero(chosen)[cells]
    triangles, owners, edges = [], [], []
    sizes = np.diff(offsets)
    for size in np.unique(sizes):
        faces = np.flatnonzero(sizes == size)
        corners = nodes[offsets[faces][:, None] + np.arange(size)]
        for k in range(1, size - 1):
            triangles.append(corners[:, [0, k, k + 1]])
            owners.append(cells[faces])
        edges += [np.sort(corners[:, [k, (k + 1) % size]], axis=1) for k in range(size)]
    return Faces(np.concatenate(triangles), np.concatenate(owners), np.unique(np.concatenate(edges), axis=0))


def metrics_of(grid):
    """Name -> a number in [0, 1] for each cell: the mean ratio of the file, and what VTK computes where it knows
    all of the grid's types of cells. NaN counts as 0."""
    found = {}
    if MEAN_RATIO in grid.cell_data:
        found[MEAN_RATIO] = grid.cell_data[MEAN_RATIO]
    if set(np.unique(grid.types)) <= set(VERDICT_CELLS):
        vtk = vtk_grid(grid)
        for name, measure in VERDICT.items():
            quality = vtk_module("vtkFiltersVerdict").vtkMeshQuality()
            quality.SetInputData(vtk)
            for cell in VERDICT_CELLS.values():
                getattr(quality, f"Set{cell}QualityMeasureTo{measure}")()
            quality.Update()
            found[name] = vtk_module("util.numpy_support").vtk_to_numpy(
                quality.GetOutput().GetCellData().GetArray("Quality"))
    return {name: np.clip(np.nan_to_num(values, nan=0.0), 0.0, 1.0) for name, values in found.items()}


def parts_of(grid):
    """Name -> faces that can be drawn of an initial mesh."""
    if not grid.is_volume:
        return {"mesh": seen_of(grid)}
    centres = cell_centres(grid)[:, 0]
    middle = (centres.min() + centres.max()) / 2.0
    return {"surface": seen_of(grid), "cut": seen_of(grid, centres < middle)}


def mesh_view(results, mesh):
    """Data that the page needs to draw a mesh before and after each method; None without files of the initial mesh,
    without VTK, or if there is too much to draw."""
    try:
        initial = read_vtu(results.mesh_file(mesh, INITIAL))
    except (ResultsError, NoVtk):
        return None
    parts = parts_of(initial)
    if sum(len(part.triangles) for part in parts.values()) > MOST_TRIANGLES:
        return None
    nodes = np.unique(np.concatenate([part.triangles.ravel() for part in parts.values()]))
    cells = np.unique(np.concatenate([part.cells for part in parts.values()]))
    lower = initial.points.min(axis=0)
    extent = max(float(np.ptp(initial.points, axis=0).max()), np.finfo(float).tiny)
    states = {}
    for method in (INITIAL, *results.methods):
        try:
            grid = initial if method == INITIAL else read_vtu(results.mesh_file(mesh, method))
        except ResultsError:
            continue  # the method failed
        if len(grid.points) == len(initial.points) and len(grid.types) == len(initial.types):
            states[method] = state_of(grid, nodes, cells, lower, extent)
    return {"planar": initial.is_planar, "lower": lower.tolist(), "extent": extent,
            "parts": {name: {"triangles": base64_of(np.searchsorted(nodes, part.triangles), "<u4"),
                             "cells": base64_of(np.searchsorted(cells, part.cells), "<u4"),
                             "edges": base64_of(np.searchsorted(nodes, part.edges), "<u4")}
                      for name, part in parts.items()},
            "states": states}


def state_of(grid, nodes, cells, lower, extent):
    """A mesh's places of the nodes that are drawn, the drawn cells' numbers, and its worst cells."""
    metrics = metrics_of(grid)
    places = np.clip((grid.points[nodes] - lower) / extent, 0.0, 1.0)
    centres = cell_centres(grid)
    worst = {name: [{"cell": int(c), "value": float(values[c]), "at": centres[c].tolist()}
                    for c in np.argsort(values, kind="stable")[:N_WORST]] for name, values in metrics.items()}
    return {"points": base64_of(np.round(places * 65535), "<u2"),
            "values": {name: base64_of(np.round(values[cells] * STEPS), "u1") for name, values in metrics.items()},
            "worst": worst}
