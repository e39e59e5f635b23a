# SPDX-License-Identifier: GPL-3.0-or-later
"""smoothfem: smooths meshes, and solves a Poisson problem with a known solution on them.

    import smoothfem
    mesh = smoothfem.generate("gear", elements="triangles", edge_scale=3)
    smoothfem.distort(mesh, 0.45)
    result = smoothfem.smooth(mesh, "getme")
    print(result.quality, smoothfem.solve(mesh, "gear")["e_l2"])

`mesh.points` is the memory of the mesh itself. An input that cannot be used raises InputError, a ValueError. Its
text names the problem, its place and a remedy. The numbers are bitwise identical to those of the program smoothfem.
"""

import operator as _operator
import os as _os

# The command smoothfem has the same setting: waiting threads sleep, and leave the cores to other programs.
_os.environ.setdefault("OMP_WAIT_POLICY", "passive")

from . import _core  # noqa: E402
from ._core import InputError, Iteration, Mesh, Quality, Result, Stage  # noqa: E402
from ._bridges import from_meshio, from_pyvista, to_meshio, to_pyvista  # noqa: E402
from ._study import Results, Study  # noqa: E402

__all__ = ["InputError", "Iteration", "Mesh", "Quality", "Result", "Results", "Stage", "Study", "distort", "domains",
           "from_meshio", "from_pyvista", "generate", "methods", "metrics", "parameters", "problems", "quality", "read", "smooth", "solve",
           "summary", "to_meshio", "to_pyvista", "write"]


def read(path):
    """Reads a mesh from a file: .msh, .vtk, .vtu, .mesh or .inp.

    Its cells may be invalid. Cells whose only fault is the direction of their nodes are turned over, with a UserWarning. Raises InputError with the text "path:line: problem" for a file without a mesh.
    """
    return _core.read(_os.fsencode(path))


def write(mesh, path, *, cell=None, point=None):
    """Writes a mesh atomically, in the format of the path's suffix.

    cell, point: {name: n_cells (n_nodes) numbers}, written with the mesh in formats that support it. Raises
    InputError for an unknown suffix, a cell that the format does not support, and a file that cannot be written.
    """
    _core.write(mesh, _os.fsencode(path), cell or {}, point or {})


def domains():
    """Returns {name: elements} of the domains for generate(); the first of the elements is the default."""
    return _core.domains()


def generate(domain, *, elements="", edge_scale=1.0, seed=1):
    """Generates a valid mesh of a domain, with fixed boundary nodes.

    elements: one of domains()[domain], such as "triangles". edge_scale: factor of the edge lengths, at
    least 1. seed: seed of the random numbers. Raises InputError for unknown names and invalid numbers.
    """
    return _core.generate(domain, elements, edge_scale, seed)


def distort(mesh, q_mean=None, *, radius=None, kind="worst-candidate", seed=1, candidates=None, sweeps=1, least_quality=0.0):
    """Moves the free nodes of a valid mesh at random; returns the resulting mean quality.

    q_mean: the mean quality to reach, in (0, 1); or radius: distance that nodes move, in mean lengths of their
    edges. kind: "worst-candidate" (each node moves to the worst of `candidates` random points) or "random-steps".
    sweeps: how many times all nodes are moved. least_quality: mean ratio that every cell keeps, in [0, 1). Raises
    InputError, with the mesh unchanged, for an invalid mesh and for a quality that no radius reaches.
    """
    return _core.distort(mesh, q_mean, radius, kind, seed, candidates, sweeps, least_quality)


def quality(mesh, metric="mean_ratio"):
    """Returns a metric for each cell, as n_cells numbers.

    "mean_ratio" is in [0, 1]: 1 for regular cells and 0 for invalid cells. "size" is the signed area or volume (planar
    and volume meshes). metrics() has the other names; such a metric is NaN for types of cells that it does not support.
    Raises InputError for other names.
    """
    return _core.quality(mesh, metric)


def metrics():
    """Returns {name: {"meaning", "larger_is_better", "ideal"}} of the metrics for quality(), most of them of Verdict (VTK).

    ideal: the value for a regular cell, or None if types of cells differ in it."""
    keys = ("meaning", "larger_is_better", "ideal")
    return {name: dict(zip(keys, entry)) for name, entry in _core.metrics().items()}


def summary(mesh):
    """Returns the quality of a whole mesh: q_min, q_star_min, q_mean, n_invalid."""
    return _core.summary(mesh)


def methods():
    """Returns {name: {"title", "description", "source", "meshes"}} of the smoothing methods.

    meshes: the supported kinds, of "planar", "volume", "surface" and "volume with sliding boundary"."""
    keys = ("title", "description", "source", "meshes")
    return {name: dict(zip(keys, entry)) for name, entry in _core.methods().items()}


def parameters(method, kind="planar"):
    """Returns {name: {"default", "description", "range"}} of the parameters of a method.

    kind: the kind of mesh: "planar", "volume" or "surface". In methods of several stages the names are "stage.name"."""
    keys = ("default", "description", "range")
    return {name: dict(zip(keys, entry)) for name, entry in _core.parameters(_method(method), kind).items()}


def smooth(mesh, method, callback=None, *, preset="", history=False, threads=0, interfaces="fixed", boundary="fixed", periodic="fixed",
           target="regular", **parameters):
    """Smooths a mesh in place, and returns a Result: stages, iterations, times, quality, history.

    method: a name of methods(), "python:FILE:CLASS", or a class with step(self, mesh). callback(iteration,
    mesh) is called for the initial mesh and after each iteration, with the current mesh.points. Its changes of
    mesh.points are lost, and its time does not count. An exception in it ends the run and is passed on.
    preset: parameters of an experiment in the literature, for example "thesis-6.3". history: if True, the result
    has a record of each iteration; a record costs a pass over all cells. threads: number of threads (default: all
    cores); the result does not depend on it. parameters: parameters of the method, for example rho=0.5, with _
    for -. Parameters of a stage are a dict: sequential={"patience": 5}.

    interfaces: "fixed", "slide" or "free": nodes between cells of different tags. boundary: "fixed" or "slide". periodic: "fixed", or
    "smooth" as inner nodes. target: "regular" cells, or cells with the shape and size ("initial") or the size ("initial-size") that they
    have now; Result.quality is then relative to the target.

    After an exception, and after Ctrl-C (between two iterations), the mesh is partially smoothed. Other threads
    of Python run during smoothing; they see new points after callbacks and at the end. Raises InputError for
    invalid cells if the method needs a valid mesh, for unknown parameters and invalid values, and for smoothers
    that violate the rules.
    """
    method = _method(method)
    settings = _settings(parameters, _core.parameters(method, mesh.kind)) if parameters else []
    words = {"interfaces": interfaces, "boundary": boundary, "periodic": periodic, "target": target}
    return _core.smooth(mesh, method, callback, preset, settings, history, threads, words)


def problems(dim=2):
    """Returns {name: formula of the solution} of the problems for solve() on meshes of this dimension, 2 or 3."""
    return _core.problems(dim)


def solve(mesh, problem, degree=1, *, condition_number="verified", multigrid=False, cg_tolerance=1e-8):
    """Solves -laplace(u) = f with a known u by finite elements.

    Returns a dict with names of columns of iterations.csv: condition_number, cg_iterations, e_max, e_mean, e_l2, e_h1,
    l2_error, h1_error and more.

    mesh: a mesh of triangles and quadrilaterals, of tetrahedra or of hexahedra. problem: a name of problems(), or
    (u, gradient, f) as expressions: ("x^2", "2*x ; 0", "-2"). degree: 1 or 2. condition_number: "none",
    "lanczos" or "verified". multigrid: if True, also runs CG with algebraic multigrid. cg_tolerance: largest
    relative residual, above 0. Raises InputError for invalid or unsupported cells, and for an unknown problem.
    """
    return _core.solve(mesh, problem, degree, condition_number, multigrid, cg_tolerance)


def _method(method):
    """Returns the method for the compiled part: a name, or the definition of a class."""
    if isinstance(method, str):
        return method
    from ._smoothers import Definition
    if not isinstance(method, type):
        raise InputError(f"method is {method!r}, but has to be a name or a class with step(self, mesh)")
    return Definition(method)


def _settings(given, known):
    """Returns pairs of the names of the method's parameters and texts."""
    flat = {}
    for name, value in given.items():
        flat.update({f"{name}.{inner}": of_inner for inner, of_inner in value.items()} if isinstance(value, dict)
                    else {name: value})
    names = {name.replace("-", "_"): name for name in known}
    return [(names.get(name.replace("-", "_"), name), _text(value)) for name, value in flat.items()]


def _text(value):
    """Returns a value as a text for the program; numbers keep all digits."""
    if isinstance(value, str):
        return value
    if hasattr(value, "__iter__"):
        return ", ".join(map(_text, value))
    try:
        return str(_operator.index(value))
    except TypeError:
        return repr(float(value))
