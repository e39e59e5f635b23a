# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes in the form that the page draws: triangles with the cells they belong to, and numbers of cells as bytes.

Volume meshes have two parts: the surface, and a cut, the surface of the cells whose centres are in the half
x < middle of the initial mesh.
"""

import base64
from dataclasses import dataclass
from typing import Callable

import numpy as np

from ..figures.curved_faces import all_faces, distinct_edges, outer_faces
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
CURVED_PIECES = (8, 4, 2)  # along each edge of a curved face, as many as there is room for


def base64_of(values, kind):
    """The numbers, little-endian, as text."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode()


@dataclass(frozen=True)
class Faces:
    """Faces to draw: triangles (n, 3) of points, the cell of each, and the edges (m, 2) of the cells."""

    triangles: np.ndarray
    cells: np.ndarray
    edges: np.ndarray


@dataclass(frozen=True)
class Parts:
    """Name -> faces of an initial mesh. `places` takes a mesh of the same cells and returns all points of the faces: its nodes,
    or those of pieces of curved faces."""

    faces: dict
    places: Callable = lambda grid: grid.points

    @property
    def n_triangles(self):
        return sum(len(part.triangles) for part in self.faces.values())


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
    all of the grid's types of cells: not for curved cells, of which it would see the corners only. NaN counts as 0."""
    found = {}
    if MEAN_RATIO in grid.cell_data:
        found[MEAN_RATIO] = grid.cell_data[MEAN_RATIO]
    if not grid.curved and set(np.unique(grid.types)) <= set(VERDICT_CELLS):
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


def masks_of(grid):
    """Name of a part -> mask of its cells, None for all."""
    if not grid.is_volume:
        return {"mesh": None}
    centres = cell_centres(grid)[:, 0]
    middle = (centres.min() + centres.max()) / 2.0
    return {"surface": None, "cut": centres < middle}


def parts_of(grid):
    """What can be drawn of an initial mesh; curved faces in as many pieces as a page has room for."""
    if not grid.curved:
        return Parts({name: seen_of(grid, mask) for name, mask in masks_of(grid).items()})
    outer = {name: outer_faces(grid, mask) if grid.is_volume else all_faces(grid) for name, mask in masks_of(grid).items()}
    for n in CURVED_PIECES:
        parts = curved_parts(outer, n)
        if parts.n_triangles <= MOST_TRIANGLES:
            break
    return parts


def curved_parts(outer, n):
    """Parts of curved faces, a list of them by name, with n pieces along each edge."""
    found, first = {}, 0
    for name, faces in outer.items():
        triangles, cells, edges = ([np.empty(shape, dtype=np.int64)] for shape in ((0, 3), 0, (0, 2)))
        for part, chosen in zip(faces, distinct_edges(faces)):
            pieces = part.triangles(n, first)
            lines = part.lines(n, first)[chosen]
            triangles.append(pieces.reshape(-1, 3))
            cells.append(np.repeat(part.cells, pieces.shape[1]))
            edges.append(np.stack([lines[:, :-1], lines[:, 1:]], axis=2).reshape(-1, 2))
            first += part.n_points(n)
        found[name] = Faces(*map(np.concatenate, (triangles, cells, edges)))

    def places(grid):
        return np.concatenate([part.interpolated(grid.points, n).reshape(-1, 3) for faces in outer.values() for part in faces])
    return Parts(found, places)


def mesh_view(results, mesh):
    """Data that the page needs to draw a mesh before and after each method; None without files of the initial mesh,
    without VTK, or if there is too much to draw."""
    try:
        initial = read_vtu(results.mesh_file(mesh, INITIAL))
    except (ResultsError, NoVtk):
        return None
    drawn = parts_of(initial)
    if drawn.n_triangles > MOST_TRIANGLES:
        return None
    parts = drawn.faces
    nodes = np.unique(np.concatenate([part.triangles.ravel() for part in parts.values()]))
    cells = np.unique(np.concatenate([part.cells for part in parts.values()]))
    places = drawn.places(initial)[nodes]
    lower = places.min(axis=0)
    extent = max(float(np.ptp(places, axis=0).max()), np.finfo(float).tiny)
    states = {}
    for method in (INITIAL, *results.methods):
        try:
            grid = initial if method == INITIAL else read_vtu(results.mesh_file(mesh, method))
        except ResultsError:
            continue  # the method failed
        if len(grid.points) == len(initial.points) and len(grid.types) == len(initial.types):
            states[method] = state_of(grid, drawn.places(grid)[nodes], cells, lower, extent)
    return {"planar": initial.is_planar, "lower": lower.tolist(), "extent": extent,
            "parts": {name: {"triangles": base64_of(np.searchsorted(nodes, part.triangles), "<u4"),
                             "cells": base64_of(np.searchsorted(cells, part.cells), "<u4"),
                             "edges": base64_of(np.searchsorted(nodes, part.edges), "<u4")}
                      for name, part in parts.items()},
            "states": states}


def state_of(grid, points, cells, lower, extent):
    """A mesh's points that are drawn, the drawn cells' numbers, and its worst cells."""
    metrics = metrics_of(grid)
    places = np.clip((points - lower) / extent, 0.0, 1.0)
    centres = cell_centres(grid)
    worst = {name: [{"cell": int(c), "value": float(values[c]), "at": centres[c].tolist()}
                    for c in np.argsort(values, kind="stable")[:N_WORST]] for name, values in metrics.items()}
    return {"points": base64_of(np.round(places * 65535), "<u2"),
            "values": {name: base64_of(np.round(values[cells] * STEPS), "u1") for name, values in metrics.items()},
            "worst": worst}
