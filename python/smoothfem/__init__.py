# SPDX-License-Identifier: GPL-3.0-or-later
"""smoothfem: smooths meshes, and solves a Poisson problem with a known solution on them.

    import smoothfem
    mesh = smoothfem.generate("gear", elements="triangles", edge_scale=3)
    smoothfem.distort(mesh, 0.45)
    result = smoothfem.smooth(mesh, "getme")
    print(result.quality, smoothfem.solve(mesh, "gear")["e_l2"])

`mesh.points` is the memory of the mesh itself. What cannot be used raises InputError, a ValueError whose
text says what, where and what to do. The numbers are those of the program smoothfem, bit for bit.
"""

import operator as _operator
import os as _os

# As the command smoothfem has it: waiting threads sleep, and leave the cores to other programs.
_os.environ.setdefault("OMP_WAIT_POLICY", "passive")

from . import _core  # noqa: E402
from ._core import InputError, Iteration, Mesh, Quality, Result, Stage  # noqa: E402
from ._study import Results, Study  # noqa: E402

__all__ = ["InputError", "Iteration", "Mesh", "Quality", "Result", "Results", "Stage", "Study", "distort", "domains", "generate",
           "methods", "metrics", "parameters", "problems", "quality", "read", "smooth", "solve", "summary", "write"]


def read(path):
    """The mesh in a file: .msh, .vtk, .vtu, .mesh or .inp.

    Raises InputError, "path:line: what is wrong", for a file that holds none. Its cells may be invalid.
    """
    return _core.read(_os.fspath(path))


def write(mesh, path, *, cell=None, point=None):
    """Writes a mesh in the format of the path's ending; the file appears in one piece or not at all.

    cell, point: {name: n_cells (n_nodes) numbers} to go with it, in formats that hold them. Raises
    InputError for another ending, a cell that the format cannot hold, and a file that cannot be written.
    """
    _core.write(mesh, _os.fspath(path), cell or {}, point or {})


def domains():
    """{name: elements} of what generate() can mesh; the first of the elements is the default."""
    return _core.domains()


def generate(domain, *, elements="", edge_scale=1.0, seed=1):
    """A valid mesh of a domain, with its boundary nodes fixed.

    elements: one of domains()[domain], such as "triangles". edge_scale: edges longer by this factor, at
    least 1. seed: of what is random in it. Raises InputError for a name or a number that is none of these.
    """
    return _core.generate(domain, elements, edge_scale, seed)


def distort(mesh, q_mean=None, *, radius=None, kind="worst-candidate", seed=1, candidates=None, sweeps=1, least_quality=0.0):
    """Moves the free nodes of a valid mesh at random; returns the mean quality that it has then.

    q_mean: the mean quality to reach, in (0, 1); or radius: how far nodes go, in mean lengths of their
    edges. kind: "worst-candidate" (each node to the worst of `candidates` random points) or "random-steps".
    sweeps: times all nodes are moved. least_quality: mean ratio that every cell keeps, in [0, 1). Raises
    InputError, with the mesh unchanged, for an invalid mesh and for a quality that no radius reaches.
    """
    return _core.distort(mesh, q_mean, radius, kind, seed, candidates, sweeps, least_quality)


def quality(mesh, metric="mean_ratio"):
    """n_cells numbers: "mean_ratio", in [0, 1], 1 for regular cells and 0 for invalid ones; "size", the area or
    volume with its sign (planar and volume meshes); or another of metrics(), NaN for cells that it knows nothing of.

    Raises InputError for other names.
    """
    return _core.quality(mesh, metric)


def metrics():
    """{name: {"meaning", "larger_is_better", "ideal"}} of what quality() takes, most of them Verdict's (VTK); ideal: of a
    regular cell, None where types of cells differ in it."""
    keys = ("meaning", "larger_is_better", "ideal")
    return {name: dict(zip(keys, entry)) for name, entry in _core.metrics().items()}


def summary(mesh):
    """Quality of a whole mesh: q_min, q_star_min, q_mean, n_invalid."""
    return _core.summary(mesh)


def methods():
    """{name: {"title", "description", "source", "meshes"}} of the smoothing methods; meshes: the kinds that
    each takes, of "planar", "volume", "surface" and "volume with sliding boundary"."""
    keys = ("title", "description", "source", "meshes")
    return {name: dict(zip(keys, entry)) for name, entry in _core.methods().items()}


def parameters(method, kind="planar"):
    """{name: {"default", "description", "range"}} of a method's parameters on meshes of a kind: "planar",
    "volume" or "surface". In methods of several stages the names are "stage.name"."""
    keys = ("default", "description", "range")
    return {name: dict(zip(keys, entry)) for name, entry in _core.parameters(_method(method), kind).items()}


def smooth(mesh, method, callback=None, *, preset="", history=False, threads=0, **parameters):
    """Smooths a mesh in place, and returns a Result: stages, iterations, times, quality, history.

    method: a name of methods(), "python:FILE:CLASS", or a class with step(self, mesh). callback(iteration,
    mesh) is called for the initial mesh and after each iteration, with mesh.points as they are then; what it
    changes in them is lost, its time does not count, and an exception in it ends the run and is passed on.
    preset: parameters of an experiment in the literature, "thesis-6.3". history: whether the result has a
    record of each iteration, each of which takes a look at every cell. threads: all cores unless given; the result
    does not depend on it. parameters: of the method, as rho=0.5, with _ for -; those of a stage in a dict:
    sequential={"patience": 5}.

    After an exception, and after Ctrl-C (between two iterations), the mesh is as far as it came. Other
    threads of Python run meanwhile; they see the points change after callbacks and at the end. Raises
    InputError for a mesh that has invalid cells if the method needs a valid one, for names and values of
    parameters that there are not, and for smoothers that do what they must not.
    """
    method = _method(method)
    settings = _settings(parameters, _core.parameters(method, mesh.kind)) if parameters else []
    return _core.smooth(mesh, method, callback, preset, settings, history, threads)


def problems(dim=2):
    """{name: formula of the solution} of what solve() knows for meshes of this dimension, 2 or 3."""
    return _core.problems(dim)


def solve(mesh, problem, degree=1, *, condition_number="verified", multigrid=False, cg_tolerance=1e-8):
    """Solves -laplace(u) = f with a known u by finite elements; returns a dict: condition_number,
    cg_iterations, e_max, e_mean, e_l2, e_h1, l2_error, h1_error and more, as columns of iterations.csv.

    mesh: of triangles and quadrilaterals, of tetrahedra or of hexahedra. problem: a name of problems(), or
    (u, gradient, f) as expressions: ("x^2", "2*x ; 0", "-2"). degree: 1 or 2. condition_number: "none",
    "lanczos" or "verified". multigrid: also CG with algebraic multigrid. cg_tolerance: largest relative residual, above 0.
    Raises InputError for a mesh with invalid cells or other ones, and for a problem that is none.
    """
    return _core.solve(mesh, problem, degree, condition_number, multigrid, cg_tolerance)


def _method(method):
    """What the compiled part takes: a name, or the definition of a class."""
    if isinstance(method, str):
        return method
    from ._smoothers import Definition
    if not isinstance(method, type):
        raise InputError(f"method is {method!r}, but has to be a name or a class with step(self, mesh)")
    return Definition(method)


def _settings(given, known):
    """Pairs of the method's own names and texts."""
    flat = {}
    for name, value in given.items():
        flat.update({f"{name}.{inner}": of_inner for inner, of_inner in value.items()} if isinstance(value, dict)
                    else {name: value})
    names = {name.replace("-", "_"): name for name in known}
    return [(names.get(name.replace("-", "_"), name), _text(value)) for name, value in flat.items()]


def _text(value):
    """A value as users of the program write it; of numbers every digit."""
    if isinstance(value, str):
        return value
    if hasattr(value, "__iter__"):
        return ", ".join(map(_text, value))
    try:
        return str(_operator.index(value))
    except TypeError:
        return repr(float(value))
