# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws meshes by matplotlib, which is imported when something is drawn."""

import io

import numpy as np

from . import _core, _curves
from ._arguments import shown, wrong
from ._core import InputError

COLOURS = "RdYlBu"  # low quality red, high quality blue; distinct for the colour-blind
MAX_INLINE_CELLS = 20000
# The faces of each type of volume cells.
FACES = {"tetra": [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)],
         "pyramid": [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
         "wedge": [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
         "hexahedron": [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]}


def plot(mesh, quality="mean ratio", ax=None, *, values=None, label=None, cut=None, cmap=None, vmin=None, vmax=None, colorbar=True, edges=True):
    """Draws the mesh by matplotlib, with colours for the quality of its cells, and returns the Axes.

    quality: a name of metrics(), or None for no colours. values: a number for each cell or for each node to show instead; label: their name.
    ax: Axes to draw in (default: new ones); volume meshes and surfaces need projection="3d". cut: "x", "y" or "z" cuts a volume mesh open in its
    middle; (axis, position) cuts elsewhere. cmap, vmin, vmax: as in matplotlib. colorbar, edges: if False, they are left out.
    """
    values, label, cmap, vmin, vmax = _shown_values(mesh, quality, values, label, cmap, vmin, vmax)
    axes = _axes(ax, mesh.spacedim)
    if mesh.spacedim == 2:
        drawn = _draw_planar(mesh, axes, values, edges)
    else:
        drawn = _draw_in_space(mesh, axes, values, edges, cut)
    if values is None:
        if mesh.spacedim == 2 or mesh.order == 1:
            drawn.set_facecolor("0.92")
        return axes
    drawn.set_cmap(cmap)
    if mesh.spacedim == 3 and mesh.order == 2:  # the edges among the pieces of curved faces
        drawn.set_cmap(drawn.get_cmap().with_extremes(bad="0.2"))
    drawn.set_clim(vmin, vmax)
    if colorbar:
        axes.figure.colorbar(drawn, ax=axes, label=label, shrink=0.8)
    return axes


def png(mesh):
    """Returns the picture of a mesh for notebooks; None for large meshes and without matplotlib."""
    if mesh.n_cells > MAX_INLINE_CELLS:
        return None
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        return None
    figure = Figure(figsize=(4, 3))
    FigureCanvasAgg(figure)
    plot(mesh, ax=figure.add_subplot(projection=None if mesh.spacedim == 2 else "3d"))
    picture = io.BytesIO()
    figure.savefig(picture, format="png", dpi=90, bbox_inches="tight")
    return picture.getvalue()


def _shown_values(mesh, quality, values, label, cmap, vmin, vmax):
    if values is None and quality is None:
        return None, label, cmap, vmin, vmax
    if values is None:
        if not isinstance(quality, str):
            raise wrong("quality", quality, "a name of metrics(), or None")
        metric = quality.replace(" ", "_")
        values = _core.quality(mesh, metric)
        if metric == "mean_ratio":
            return values, label or "mean ratio", cmap or COLOURS, 0.0 if vmin is None else vmin, 1.0 if vmax is None else vmax
        if np.isnan(values).all():
            raise InputError(f"the metric {metric} has no values for cells of the types {', '.join(mesh.cells_dict)}")
        larger_is_better = {"size": True, **{name: facts[1] for name, facts in _core.metrics().items()}}[metric]
        return values, label or metric.replace("_", " "), cmap or (COLOURS if larger_is_better else COLOURS + "_r"), vmin, vmax
    try:
        values = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise wrong("values", values, "numbers") from None
    if values.shape not in ((mesh.n_cells,), (mesh.n_nodes,)):
        raise InputError(f"values has the shape {values.shape}, but has to have one number for each of {mesh.n_cells} cells or {mesh.n_nodes} nodes")
    return values, label or "", cmap or "viridis", vmin, vmax


def _axes(ax, spacedim):
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise ImportError("pictures need matplotlib; on Debian: apt install python3-matplotlib") from error
    if ax is None:
        ax = pyplot.figure().add_subplot(projection=None if spacedim == 2 else "3d")
    elif not hasattr(ax, "add_collection"):
        raise wrong("ax", ax, "Axes of matplotlib")
    elif spacedim == 3 and not hasattr(ax, "get_zlim"):
        raise InputError('meshes in space need Axes in space: figure.add_subplot(projection="3d")')
    return ax


def _draw_planar(mesh, axes, values, edges):
    from matplotlib.collections import PathCollection, PolyCollection
    curved = mesh.order == 2
    kind = PathCollection if curved else PolyCollection
    cells = _curves.paths(mesh) if curved else [mesh.points[row] for rows in mesh.cells_dict.values() for row in rows]
    colour, width = ("0.2", 0.4) if edges else ("none", 0.0)
    if values is not None and len(values) == mesh.n_nodes != mesh.n_cells:
        points, rows, values = _curves.triangles(mesh, values) if curved else (mesh.points, _triangles(mesh), values)
        drawn = axes.tripcolor(*points.T, rows, values, shading="gouraud")
        if edges:
            axes.add_collection(kind(cells, facecolor="none", edgecolor=colour, linewidth=width))
    else:
        drawn = kind(cells, edgecolor=colour, linewidth=width)
        if values is not None:
            drawn.set_array(np.concatenate([values[cells] for cells in _numbers(mesh).values()]))
        axes.add_collection(drawn)
    axes.autoscale()
    axes.set_aspect("equal")
    axes.axis("off")
    return drawn


def _draw_in_space(mesh, axes, values, edges, cut):
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    if mesh.dim == 2:
        if cut is not None:
            raise InputError("cut is for volume meshes; leave it out for a surface")
        faces = [row for rows in mesh.cells_dict.values() for row in rows]
        cells = np.concatenate(list(_numbers(mesh).values()))
    else:
        faces, cells = _visible_faces(mesh, _kept(mesh, cut))
    of_faces = None
    if values is not None:
        of_nodes = len(values) == mesh.n_nodes != mesh.n_cells
        of_faces = np.array([values[face].mean() for face in faces]) if of_nodes else values[cells]
    if mesh.order == 2:
        drawn = _curved_faces(mesh, axes, faces, of_faces, edges)
    else:
        drawn = Poly3DCollection([mesh.points[face] for face in faces], edgecolor="0.2" if edges else "none", linewidth=0.3 if edges else 0.0)
        drawn.set_array(of_faces)
        axes.add_collection3d(drawn)
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    for set_limits, a, b in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), low, high):
        set_limits(a, b)
    axes.set_box_aspect(np.maximum(high - low, 1e-3 * (high - low).max()))
    axes.set_axis_off()
    return drawn


def _curved_faces(mesh, axes, faces, values, edges):
    """Adds curved faces in pieces. Edges are among the pieces, so that those behind other pieces are hidden."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    polygons, numbers, lines = _curves.pieces(mesh, faces)
    lines = lines if edges else []
    # No point of an edge is farther than the farthest of the pieces that it bounds, so it is drawn after these.
    drawn = Poly3DCollection(polygons + [line[[0, 1, 0]] for line in lines], linewidth=0.3, zsort="max")
    if values is not None:  # edges have none, and the colour of numbers that are not there
        drawn.set_array(np.ma.masked_invalid(np.concatenate([values[numbers], np.full(len(lines), np.nan)])))
    else:
        drawn.set_facecolor(["0.92"] * len(polygons) + ["0.2"] * len(lines))
    axes.add_collection3d(drawn)
    drawn.set_edgecolor("face")  # after it is in Axes, which matplotlib asks for the order of the polygons
    return drawn


def _numbers(mesh):
    """Returns {type: numbers of its cells}, in the order of mesh.cells_dict."""
    sizes = np.array([len(row) for row in mesh.cells])
    return {name: np.flatnonzero(sizes == rows.shape[1]) for name, rows in mesh.cells_dict.items()}


def _triangles(mesh):
    """Returns the cells as fans of triangles."""
    return np.concatenate([np.stack([rows[:, 0], rows[:, k], rows[:, k + 1]], axis=1)
                           for rows in mesh.cells_dict.values() for k in range(1, rows.shape[1] - 1)])


def _kept(mesh, cut):
    """Returns a flag for each cell: whether it is on the near side of the cut."""
    if cut is None:
        return np.ones(mesh.n_cells, dtype=bool)
    axis, position = cut if isinstance(cut, (tuple, list)) and len(cut) == 2 else (cut, None)
    if not isinstance(axis, str) or axis not in ("x", "y", "z") or not isinstance(position, (int, float, type(None))):
        raise InputError(f'cut is {shown(cut)}, but has to be "x", "y" or "z", or such a letter with a position')
    coordinates = mesh.points[:, "xyz".index(axis)]
    position = 0.5 * (coordinates.min() + coordinates.max()) if position is None else position
    kept = np.zeros(mesh.n_cells, dtype=bool)
    for name, cells in _numbers(mesh).items():
        centres = coordinates[mesh.cells_dict[name]].mean(axis=1)
        kept[cells] = centres >= position if axis == "y" else centres <= position  # away from matplotlib's viewer
    if not kept.any():
        raise InputError(f"no cell is beyond {axis} = {position:g}; cut elsewhere")
    return kept


def _visible_faces(mesh, kept):
    """Returns the faces that one of the kept cells has alone, and these cells."""
    faces, cells = [], []
    for name, numbers in _numbers(mesh).items():
        chosen = kept[numbers]
        for face in FACES[name]:
            faces.extend(mesh.cells_dict[name][chosen][:, face])
            cells.extend(numbers[chosen])
    seen = {}
    for k, face in enumerate(faces):
        seen.setdefault(tuple(sorted(face.tolist())), []).append(k)
    alone = [several[0] for several in seen.values() if len(several) == 1]
    return [faces[k] for k in alone], np.array(cells)[alone]
