# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of a results folder, read by VTK, as arrays."""

import importlib
import os
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Optional

import numpy as np

from .cell_types import CELL_DIMENSIONS, PLANAR_CELL_TYPES, SECOND_ORDER, VOLUME_CELL_TYPES
from .rows import ResultsError


class NoVtk(Exception):
    """VTK's Python modules cannot be imported; the message is half a sentence, for after a colon."""


@dataclass(frozen=True)
class CurvedCells:
    """All nodes of the cells of a grid, corners first, in VTK's order, in the CSR form of UnstructuredGrid."""

    connectivity: np.ndarray
    offsets: np.ndarray
    types: np.ndarray  # VTK's numbers, also of second order


@dataclass(frozen=True)
class UnstructuredGrid:
    """Points (n, 3); cells in CSR form: cell c has nodes connectivity[offsets[c]:offsets[c + 1]]. Those of second order
    have their corners and the type of these; the points have all nodes. Prisms of second order begin with the other
    triangle than VTK's linear ones."""

    points: np.ndarray
    connectivity: np.ndarray
    offsets: np.ndarray  # n_cells + 1 entries, the first is 0
    types: np.ndarray  # (n_cells,), VTK's numbers
    point_data: dict  # name -> array (n,) or (n, components)
    cell_data: dict  # name -> array (n_cells,) or (n_cells, components)
    curved: Optional[CurvedCells] = None  # if there are cells of second order

    @property
    def is_planar(self):
        """True if every cell is a triangle, quadrilateral or polygon, of one plane."""
        return self.has_polygons and bool((self.points[:, 2] == self.points[0, 2]).all())

    @property
    def is_surface(self):
        """True if every cell is a triangle, quadrilateral or polygon, not all of one plane."""
        return self.has_polygons and not self.is_planar

    @property
    def has_polygons(self):
        """True if every cell is a triangle, quadrilateral or polygon."""
        return bool(np.isin(self.types, list(PLANAR_CELL_TYPES)).all())

    @property
    def is_volume(self):
        """True if every cell is a tetrahedron, hexahedron, prism or pyramid."""
        return bool(np.isin(self.types, list(VOLUME_CELL_TYPES)).all())

    def cells(self):
        """The cells as a list of arrays of node numbers."""
        return np.split(self.connectivity, self.offsets[1:-1])


def vtk_module(name):
    """A module of VTK's Python package, imported when it is needed, since that takes a moment. Raises NoVtk."""
    try:
        return importlib.import_module(f"vtkmodules.{name}")
    except ImportError as error:
        raise NoVtk(f"VTK's Python modules are missing ({error}); install the Debian package "
                    "python3-vtk9") from None


def read_vtu(path):
    """Reads an unstructured grid of at least one cell; raises ResultsError if the file is missing,
    truncated or of another kind, NoVtk if there is nothing to read it with."""
    path = Path(path)
    if not path.is_file():
        raise ResultsError(f"{path}: the file is missing.")
    reader = vtk_module("vtkIOXML").vtkXMLUnstructuredGridReader()
    reader.SetFileName(os.fsencode(path))
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(True))
    with silent_vtk():
        reader.Update()
    grid = None if errors else adapted(reader.GetOutput())
    if grid is None:
        raise ResultsError(f"{path}: not a complete VTU file of an unstructured grid.")
    return grid


@contextmanager
def silent_vtk():
    """VTK writes nothing to the standard error stream: its reader's errors are observed, and the parser
    within the reader, which nobody can observe, says the same with addresses in memory."""
    logger = vtk_module("vtkCommonCore").vtkLogger
    before = logger.GetCurrentVerbosityCutoff()
    logger.SetStderrVerbosity(logger.VERBOSITY_OFF)
    try:
        yield
    finally:
        logger.SetStderrVerbosity(before)


def adapted(grid):
    """A grid of VTK as arrays; None if it has no cells, or cells with nodes that are not there or too few."""
    to_numpy = vtk_module("util.numpy_support").vtk_to_numpy
    if grid.GetNumberOfCells() == 0 or grid.GetNumberOfPoints() == 0:
        return None
    cells = grid.GetCells()
    connectivity = to_numpy(cells.GetConnectivityArray()).astype(np.int64)
    offsets = to_numpy(cells.GetOffsetsArray()).astype(np.int64)
    if not len(connectivity) or connectivity.min() < 0 or connectivity.max() >= grid.GetNumberOfPoints():
        return None

    def arrays(attributes):
        """Name -> numbers; arrays of texts are of no use here."""
        found = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
        return {array.GetName(): to_numpy(array) for array in found if array is not None}
    types = to_numpy(grid.GetCellTypesArray())
    if any((np.diff(offsets)[types == kind] != n_nodes).any() for kind, (_, _, n_nodes) in SECOND_ORDER.items()):
        return None
    return with_corners(of_highest_dimension(UnstructuredGrid(
        points=to_numpy(grid.GetPoints().GetData()), connectivity=connectivity, offsets=offsets, types=types,
        point_data=arrays(grid.GetPointData()), cell_data=arrays(grid.GetCellData()))))


def with_corners(grid):
    """A grid whose cells have all their nodes, as one of corners that knows all nodes of curved cells."""
    if not np.isin(grid.types, list(SECOND_ORDER)).any():
        return grid
    sizes, types = np.diff(grid.offsets), grid.types.copy()
    n_corners = sizes.copy()
    for kind, (of_corners, n, _) in SECOND_ORDER.items():
        n_corners[grid.types == kind], types[grid.types == kind] = n, of_corners
    places = np.arange(len(grid.connectivity)) - np.repeat(grid.offsets[:-1], sizes)
    return replace(grid, connectivity=grid.connectivity[places < np.repeat(n_corners, sizes)],
                   offsets=np.concatenate(([0], np.cumsum(n_corners))), types=types,
                   curved=CurvedCells(grid.connectivity, grid.offsets, grid.types))


def vtk_grid(grid, chosen=None):
    """The inverse: VTK's own grid of all points, and all cells or those of a mask; without data, and without midside nodes
    of cells."""
    model, to_vtk = vtk_module("vtkCommonDataModel"), vtk_module("util.numpy_support")
    kept = np.ones(len(grid.types), dtype=bool) if chosen is None else chosen
    sizes = np.diff(grid.offsets)
    offsets = np.concatenate(([0], np.cumsum(sizes[kept])))
    nodes = grid.connectivity[np.repeat(kept, sizes)]
    points = vtk_module("vtkCommonCore").vtkPoints()
    points.SetData(to_vtk.numpy_to_vtk(np.ascontiguousarray(grid.points, dtype=float), deep=True))
    cells = model.vtkCellArray()
    cells.SetData(to_vtk.numpy_to_vtkIdTypeArray(offsets.astype(np.int64), deep=True),
                  to_vtk.numpy_to_vtkIdTypeArray(nodes.astype(np.int64), deep=True))
    result = model.vtkUnstructuredGrid()
    result.SetPoints(points)
    result.SetCells(to_vtk.numpy_to_vtk(grid.types[kept].astype(np.uint8), deep=True), cells)
    return result


def of_highest_dimension(grid):
    """The grid without cells that only carry the labels of its points, edges or facets."""
    # A type that is not known is no label: the figures say that they cannot draw it.
    dimensions = np.array([CELL_DIMENSIONS.get(int(kind), 3) for kind in grid.types])
    chosen = dimensions == dimensions.max()
    if chosen.all():
        return grid
    sizes = np.diff(grid.offsets)
    return replace(grid, connectivity=grid.connectivity[np.repeat(chosen, sizes)],
                   offsets=np.concatenate(([0], np.cumsum(sizes[chosen]))), types=grid.types[chosen],
                   cell_data={name: values[chosen] for name, values in grid.cell_data.items()})
