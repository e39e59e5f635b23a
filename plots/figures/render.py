# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of volume meshes as arrays of pixels, drawn by VTK off screen.

VTK ends the process if something is wrong with the display. So it draws in a process of its own.
"""

import ctypes
import signal
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, replace
from multiprocessing import get_context
from typing import Optional

import numpy as np

from ..results.vtu import NoVtk, vtk_grid, vtk_module
from .curved_faces import outer_faces, pieces_along_edges
from .virtual_display import NoDisplay, virtual_display
from .volume_geometry import View
from .vtk_surface import curved_edges, curved_surface, face_keys, surface_of, with_faces

# Each pixel is the mean of this squared: smooth edges, the same on every machine, unlike the
# multisampling of OpenGL drivers.
SUPERSAMPLING = 2
LIGHT = (-0.4, 0.7, 1.0)  # from the upper left: relative to the viewer, x to the right, y upwards
PR_SET_PDEATHSIG = 1  # linux/prctl.h
CELL_EDGE_WIDTH, FEATURE_EDGE_WIDTH = 1.0, 2.5  # pixels
MERGED = 1e-9  # distance of points that are the same, relative to the size of the mesh
FEATURE_ANGLE = 30.0  # degrees between two faces from which on their common edge is drawn


@dataclass(frozen=True)
class Scene:
    """One picture: the faces that are seen of some cells of a grid, in plain or given colours.

    With `cell_colours` only faces that are no faces of the whole grid's surface are coloured: those
    that taking cells away has opened; with `outside_coloured` all of them.
    """

    grid: object  # UnstructuredGrid with volume cells, or the cells of a surface
    view: View
    pixels: tuple  # width, height
    cells: Optional[np.ndarray] = None  # which are there, (n_cells,) bool; None: all
    cell_colours: Optional[np.ndarray] = None  # (n_cells, 3) uint8
    outside_coloured: bool = False
    point_values: Optional[np.ndarray] = None  # (n_points,), from 0 to 1
    value_colours: Optional[np.ndarray] = None  # (n, 3) uint8, those of values from 0 to 1
    plain_colour: tuple = (0.80, 0.86, 0.90)
    cell_edges: bool = False  # of the coloured faces
    feature_edges: bool = False
    ambient: float = 0.45  # fraction of a colour that does not depend on the light


def render(scenes):
    """Renders scenes as arrays (height, width, 3) of uint8 on a white background. Raises NoDisplay with one sentence if
    VTK or Xvfb is missing or VTK ends early."""
    try:
        vtk_module("vtkRenderingOpenGL2")
    except NoVtk as error:
        raise NoDisplay(str(error)) from None
    with virtual_display(), ProcessPoolExecutor(1, get_context("fork"), end_with_parent) as drawer:
        try:
            return [drawer.submit(draw_scene, scene).result() for scene in scenes]
        except BrokenProcessPool:
            raise NoDisplay("VTK gave up drawing off screen") from None


def end_with_parent():
    """Called in the process that draws: it gets SIGTERM when the first one dies, even if that is killed,
    instead of waiting for another scene forever."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def draw_scene(scene):
    """One picture; needs a display."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkRenderingCore import (vtkLight, vtkRenderer, vtkRenderWindow,
                                             vtkWindowToImageFilter)

    vtk_module("vtkRenderingOpenGL2")  # what draws registers itself when it is imported
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    width, height = (SUPERSAMPLING * n for n in scene.pixels)
    for actor in actors_of(scene):
        renderer.AddActor(actor)
    set_camera(renderer, scene.view)
    light = vtkLight()
    light.SetLightTypeToCameraLight()
    light.SetPosition(*LIGHT)
    renderer.AddLight(light)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(width, height)
    window.AddRenderer(renderer)
    window.Render()
    shot = vtkWindowToImageFilter()
    shot.SetInput(window)
    shot.ReadFrontBufferOff()
    shot.Update()
    colours = vtk_to_numpy(shot.GetOutput().GetPointData().GetScalars()).reshape(height, width, 3)
    window.Finalize()
    blocks = colours[::-1].reshape(scene.pixels[1], SUPERSAMPLING, scene.pixels[0], SUPERSAMPLING, 3)
    return blocks.mean(axis=(1, 3)).round().astype(np.uint8)


def actors_of(scene):
    """The plain surface or that with values, the faces that were opened, and feature edges."""
    if scene.grid.curved:
        return curved_actors(scene)
    surface = surface_of(coloured_grid(scene))
    if scene.cell_colours is None:
        found = [actor_of(surface, scene, scene.point_values is not None)]
    else:
        whole = surface_of(coloured_grid(replace(scene, cells=None)))
        n_points = len(scene.grid.points)
        opened = ~np.isin(face_keys(surface, n_points), face_keys(whole, n_points))
        opened |= scene.outside_coloured
        found = [actor_of(with_faces(surface, chosen), scene, coloured)
                 for chosen, coloured in ((~opened, False), (opened, True)) if chosen.any()]
    if scene.feature_edges:
        found.append(feature_edges(surface))
    return found


def curved_actors(scene):
    """Like actors_of, of a grid with cells of second order."""
    from vtkmodules.vtkFiltersCore import vtkCleanPolyData

    grid, faces = scene.grid, outer_faces(scene.grid, scene.cells)
    n = pieces_along_edges(sum(len(part.nodes) for part in faces))
    groups = [(faces, scene.point_values is not None)]
    if scene.cell_colours is not None:
        whole = np.concatenate([part.keys(len(grid.points)) for part in outer_faces(grid)])
        opened = [~np.isin(part.keys(len(grid.points)), whole) | scene.outside_coloured for part in faces]
        groups = [([part.chosen(mask == coloured) for part, mask in zip(faces, opened)], coloured) for coloured in (False, True)]
    found = []
    for parts, coloured in groups:
        parts = [part for part in parts if len(part.nodes)]
        if parts:
            found.append(actor_of(curved_surface(parts, grid.points, n, scene.cell_colours, scene.point_values), scene, coloured))
            if scene.cell_edges and coloured:
                found.append(line_actor(curved_edges(parts, grid.points, n), CELL_EDGE_WIDTH))
    if scene.feature_edges:
        merged = vtkCleanPolyData()  # an edge has two faces where these share their points
        merged.SetInputData(curved_surface(faces, grid.points, n))
        merged.SetTolerance(MERGED)
        merged.Update()
        found.append(feature_edges(merged.GetOutput()))
    return found


def feature_edges(surface):
    """Lines where two faces meet at an angle."""
    from vtkmodules.vtkFiltersCore import vtkFeatureEdges

    edges = vtkFeatureEdges()
    edges.SetInputData(surface)
    edges.SetFeatureAngle(FEATURE_ANGLE)
    edges.ColoringOff()
    edges.ManifoldEdgesOff()
    edges.NonManifoldEdgesOff()
    edges.Update()
    return line_actor(edges.GetOutput(), FEATURE_EDGE_WIDTH)


def coloured_grid(scene):
    """The chosen cells as VTK's own grid, with colours or values as scalars."""
    from vtkmodules.util.numpy_support import numpy_to_vtk

    result = vtk_grid(scene.grid, scene.cells)
    chosen = slice(None) if scene.cells is None else scene.cells
    if scene.cell_colours is not None:
        result.GetCellData().SetScalars(numpy_to_vtk(
            np.ascontiguousarray(scene.cell_colours[chosen]), deep=True))
    if scene.point_values is not None:
        result.GetPointData().SetScalars(numpy_to_vtk(
            np.ascontiguousarray(scene.point_values, dtype=float), deep=True))
    return result


def actor_of(surface, scene, coloured):
    """The faces, with flat light unless they are curved: what looks curved on a coarse mesh of flat faces is not."""
    from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

    mapper = vtkPolyDataMapper()
    mapper.SetInputData(surface)
    if scene.point_values is None:
        mapper.SetColorModeToDirectScalars()
    else:
        # Values are interpolated between points, then coloured: mixed colours are in no colour map.
        mapper.SetLookupTable(lookup_table(scene.value_colours))
        mapper.SetScalarRange(0, 1)
        mapper.SetColorModeToMapScalars()
        mapper.InterpolateScalarsBeforeMappingOn()
    # Without the offset, lines would drown in the faces that they bound.
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetScalarVisibility(coloured)
    if scene.cell_colours is not None:
        mapper.SetScalarModeToUseCellData()
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetColor(*scene.plain_colour)
    has_normals = surface.GetPointData().GetNormals() is not None
    (look.SetInterpolationToPhong if has_normals else look.SetInterpolationToFlat)()
    look.SetAmbient(scene.ambient)
    look.SetDiffuse(1 - scene.ambient)
    look.SetSpecular(0)
    if scene.cell_edges and coloured and not has_normals:
        look.EdgeVisibilityOn()
        look.SetEdgeColor(0.15, 0.15, 0.15)
        look.SetLineWidth(CELL_EDGE_WIDTH * SUPERSAMPLING)
    return actor


def lookup_table(colours):
    """VTK's form of a colour map."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkLookupTable

    opaque = np.column_stack([colours, np.full(len(colours), 255, dtype=np.uint8)])
    table = vtkLookupTable()
    table.SetTable(numpy_to_vtk(np.ascontiguousarray(opaque), deep=True))
    return table


def line_actor(lines, width):
    """Thin dark lines of a width in pixels."""
    from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

    mapper = vtkPolyDataMapper()
    mapper.SetInputData(lines)
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.15, 0.15, 0.15)
    actor.GetProperty().SetLineWidth(width * SUPERSAMPLING)
    actor.GetProperty().LightingOff()
    return actor


def set_camera(renderer, view):
    """Parallel projection of the view's rectangle."""
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*view.centre)
    camera.SetPosition(*(np.asarray(view.centre) + view.distance * np.asarray(view.towards)))
    camera.SetViewUp(*view.up)
    camera.SetParallelScale(0.5 * view.height)
    renderer.ResetCameraClippingRange()
