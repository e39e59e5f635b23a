# SPDX-License-Identifier: GPL-3.0-or-later
"""smoothfem: smooths meshes, and solves a Poisson problem with a known solution on them.

    import smoothfem
    mesh = smoothfem.generate("gear", elements="triangles", edge_scale=3)
    smoothfem.distort(mesh, 0.45)
    result = smoothfem.smooth(mesh, "getme")
    solution = smoothfem.solve(mesh, u="sin(x/20)*y")
    print(result.quality, solution.h1_error)
    mesh.plot(values=solution.nodal_error)

`mesh.points` is the memory of the mesh itself. An input that cannot be used raises InputError, a ValueError. Its
text names the problem, its place and a remedy. With the same options, numbers are bitwise identical to those of the program smoothfem.

GETMe is due to D. Vartziotis, J. Wipper: The GETMe Mesh Smoothing Framework. CRC Press, 2018. doi:10.1201/9780429399626
"""

import operator as _operator
import os as _os
import warnings as _warnings

# The command smoothfem has the same setting: waiting threads sleep, and leave the cores to other programs.
_os.environ.setdefault("OMP_WAIT_POLICY", "passive")

from . import _arguments, _core  # noqa: E402
from ._core import InputError, Iteration, Mesh, Quality, Result, Stage, __version__  # noqa: E402
from ._bridges import from_meshio, from_pyvista, to_meshio, to_pyvista  # noqa: E402
from ._cells import create as _create_mesh  # noqa: E402
from ._plot import plot as _plot_mesh, png as _mesh_png  # noqa: E402
from ._solution import Solution, diffusivities, formula, named_problem, natural_groups  # noqa: E402
from ._study import Results, Study  # noqa: E402

__all__ = ["InputError", "Iteration", "Mesh", "Quality", "Result", "Results", "Solution", "Stage", "Study", "__version__", "distort", "domains",
           "from_meshio", "from_pyvista", "generate", "methods", "metrics", "parameters", "problems", "quality", "read", "smooth", "solve",
           "summary", "to_meshio", "to_pyvista", "write"]


Mesh.__init__, Mesh.plot, Mesh._repr_png_ = _create_mesh, _plot_mesh, _mesh_png


def read(path):
    """Reads a mesh from a file: .msh, .vtk, .vtu, .mesh or .inp.

    Its cells may be invalid. Cells whose only fault is the direction of their nodes are turned over, with a UserWarning. Raises InputError with
    the text "path:line: problem" for a file without a mesh.
    """
    return _core.read(_path(path))


def write(mesh, path, *, cell=None, point=None):
    """Writes a mesh atomically, in the format of the path's suffix.

    cell, point: {name: n_cells (n_nodes) numbers}, written with the mesh in formats that support it. Raises
    InputError for an unknown suffix, a cell that the format does not support, and a file that cannot be written.
    """
    mesh = _arguments.mesh(mesh)
    _core.write(mesh, _path(path), _arguments.fields("cell", cell or {}, mesh.n_cells, "cells"),
                _arguments.fields("point", point or {}, mesh.n_nodes, "nodes"))


def domains():
    """Returns {name: elements} of the domains for generate(); the first of the elements is the default."""
    return _core.domains()


@_arguments.refusing_unknown
def generate(domain, *, elements="", edge_scale=1.0, seed=1, algorithm="", eps=None, order=1):
    """Generates a valid mesh of a domain, with fixed boundary nodes.

    elements: one of domains()[domain], such as "triangles". edge_scale: factor of the edge lengths, at
    least 1. seed: seed of the random numbers. algorithm: of the mesh generator, for domains that have
    several (`smoothfem list domains`). eps: of the domains kershaw and kershaw-cube, above 0 and at most 1.
    order: 2 gives cells of second order, with midside nodes on the true boundary, for domains that have it.
    Raises InputError for unknown names and invalid numbers.
    """
    return _core.generate(_arguments.text("domain", domain), _arguments.text("elements", elements), _arguments.number("edge_scale", edge_scale),
                          _arguments.whole("seed", seed, 0, 2**64 - 1), _arguments.text("algorithm", algorithm),
                          None if eps is None else _arguments.number("eps", eps), _arguments.whole("order", order, 1, 2))


@_arguments.refusing_unknown
def distort(mesh, q_mean=None, *, radius=None, kind="worst-candidate", seed=1, candidates=None, sweeps=1, least_quality=0.0):
    """Moves the free nodes of a valid mesh at random; returns the resulting mean quality.

    q_mean: the mean quality to reach, in (0, 1); or radius: distance that nodes move, in mean lengths of their
    edges. kind: "worst-candidate" (each node moves to the worst of `candidates` random points) or "random-steps".
    sweeps: how many times all nodes are moved. least_quality: mean ratio that every cell keeps, in [0, 1). Raises
    InputError, with the mesh unchanged, for an invalid mesh and for a quality that no radius reaches.
    """
    return _core.distort(
        _arguments.mesh(mesh), _arguments.optional_number("q_mean", q_mean), _arguments.optional_number("radius", radius), _arguments.text("kind", kind),
        _arguments.whole("seed", seed, 0, 2**64 - 1), None if candidates is None else _arguments.whole("candidates", candidates),
        _arguments.whole("sweeps", sweeps), _arguments.number("least_quality", least_quality))


def quality(mesh, metric="mean_ratio"):
    """Returns a metric for each cell, as n_cells numbers.

    "mean_ratio" is in [0, 1]: 1 for regular cells and 0 for invalid cells. "size" is the signed area or volume (planar
    and volume meshes). metrics() has the other names; such a metric is NaN for types of cells that it does not support.
    Raises InputError for other names.
    """
    return _core.quality(_arguments.mesh(mesh), _arguments.text("metric", metric))


def metrics():
    """Returns {name: {"meaning", "larger_is_better", "ideal"}} of the metrics for quality(), most of them of Verdict (VTK).

    ideal: the value for a regular cell, or None if types of cells differ in it."""
    keys = ("meaning", "larger_is_better", "ideal")
    return {name: dict(zip(keys, entry)) for name, entry in _core.metrics().items()}


def summary(mesh):
    """Returns the quality of a whole mesh: q_min, q_star_min, q_mean, n_invalid."""
    return _core.summary(_arguments.mesh(mesh))


def methods():
    """Returns {name: {"title", "description", "source", "meshes"}} of the smoothing methods.

    meshes: the supported kinds, of "planar", "volume", "surface" and "volume with sliding boundary"."""
    keys = ("title", "description", "source", "meshes")
    return {name: dict(zip(keys, entry)) for name, entry in _core.methods().items()}


def parameters(method, kind="planar"):
    """Returns {name: {"default", "description", "range"}} of the parameters of a method.

    kind: the kind of mesh: "planar", "volume" or "surface". In methods of several stages the names are "stage.name"."""
    keys = ("default", "description", "range")
    return {name: dict(zip(keys, entry)) for name, entry in _core.parameters(_method(method), _arguments.text("kind", kind)).items()}


def smooth(mesh, method=None, callback=None, *, boundary="fixed", fix=None, interfaces="fixed", periodic="fixed", untangle=False, only_below=None,
           rings=2, target="regular", keep_layers=None, slide_distance=None, feature_angle=None, allow_worse=True, preset="", history=False,
           threads=0, **parameters):
    """Smooths a mesh in place, and returns a Result: stages, iterations, times, quality, history.

    method: a name of methods(), "python:FILE:CLASS", a class or an object with step(self, mesh), or a function of the mesh. step and the
    function change mesh.points in place, or return an array of all points. parameters: parameters of the method, for example rho=0.5, with _
    for -. Parameters of a stage are a dict: sequential={"patience": 5}. A dict `parameters` may hold them all.
    callback(iteration, mesh) is called for the initial mesh and after each iteration, with the current mesh.points. Its changes of
    mesh.points are lost, and its time does not count. An exception in it ends the run and is passed on.

    Which nodes move: boundary: "fixed" or "slide". fix: nodes that stay besides: names of groups, numbers of nodes, or a truth value for
    each node; or the rules "boundary", "file" (as read) or "free" (none). interfaces: "fixed", "slide" or "free": nodes between cells of different
    tags. periodic: "fixed", or "smooth" as inner nodes. only_below: smooths only around cells with a lower mean ratio; rings: rings of cells
    around them whose nodes move, too. keep_layers: True, or the name of a group: keeps layers of thin cells along the boundary.
    slide_distance, feature_angle: see `smoothfem smooth --help`.

    untangle: if True, makes a tangled mesh valid first. target: "regular" cells; cells with the shape and size ("initial") or the size
    ("initial-size") that they have now; or a mesh with the same cells, whose shapes and sizes they get. Result.quality is then relative to the
    target. allow_worse: if False, nodes are reset until no cell is worse than the worst one before, as the command smooth does by default.

    preset: parameters of an experiment in the literature, for example "thesis-6.3". history: if True, the result has a record of each iteration;
    a record costs a pass over all cells. threads: number of threads (default: all cores); the result does not depend on it.

    A UserWarning tells if the resulting mesh has invalid cells. After an exception, and after Ctrl-C (between two iterations), the mesh is
    partially smoothed. Other threads of Python run during smoothing; they see new points after callbacks and at the end. Raises InputError for
    invalid cells if the method needs a valid mesh, for unknown parameters and invalid values, and for smoothers that violate the rules.
    """
    if method is None:
        raise _no_method(parameters)
    mesh, method = _arguments.mesh(mesh), _method(method)
    given = parameters.pop("parameters", None) or {}
    if not hasattr(given, "items"):
        raise _arguments.wrong("parameters", given, "a dict {name: value}")
    parameters = {**given, **parameters}
    settings = _settings(parameters, list(_core.parameters(method, mesh.kind))) if parameters else []
    rule, groups, nodes = _fix(fix)
    words = {"boundary": _arguments.text("boundary", boundary), "interfaces": _arguments.text("interfaces", interfaces),
             "periodic": _arguments.text("periodic", periodic), "target": target if isinstance(target, Mesh) else _arguments.text("target", target),
             "fix": rule, "fix_groups": groups, "fix_nodes": nodes, "untangle": bool(untangle), "allow_worse": bool(allow_worse),
             "only_below": _arguments.optional_number("only_below", only_below, 0, 1), "rings": _arguments.whole("rings", rings, 0, 1000),
             "slide_distance": _arguments.optional_number("slide_distance", slide_distance),
             "feature_angle": _arguments.optional_number("feature_angle", feature_angle),
             "keep_layers": {True: "", False: None, None: None}[keep_layers] if keep_layers in (True, False, None) else
             "group=" + _arguments.text("keep_layers", keep_layers)}
    result = _core.smooth(mesh, method, _arguments.function("callback", callback), _arguments.text("preset", preset), settings, bool(history),
                          _arguments.whole("threads", threads), words)
    for sentence in result.warnings:
        _warnings.warn(sentence, stacklevel=2)
    return result


def problems(dim=2):
    """Returns {name: formula of the solution} of the problems for solve() on meshes of this dimension, 2 or 3."""
    return _core.problems(_arguments.whole("dim", dim))


@_arguments.refusing_unknown
def solve(mesh, problem=None, degree=1, *, u=None, diffusivity=None, natural=(), condition_number="verified", multigrid=False, cg_tolerance=1e-8):
    """Solves -div(A grad u) = f with a known u by finite elements; returns a Solution.

    A Solution has the nodal solution u_h, errors of nodes and cells, and numbers with the names of columns of iterations.csv:
    condition_number, cg_iterations, e_max, e_mean, e_l2, e_h1, l2_error, h1_error and more. `solution.h1_error` and `solution["h1_error"]` are the same.

    mesh: a planar mesh of triangles and quadrilaterals, or a volume mesh; degree 2 needs tetrahedra only or hexahedra only in space. degree: 1 or 2.
    The words are those of studies. u: a formula in x, y (and z), as "sin(x)*y"; gradient and f are derived from it. diffusivity: A as a formula, a
    number, or a tensor of these, as [[2, 0], [0, "1+x^2"]] (default: 1, so that f = -laplace(u)). A dict {group: A} has A of groups of cells, by names
    or tags, and by None that of all others. natural: names or tags of boundary groups where A grad u . n is given; elsewhere u is.
    problem: in place of u: a name of problems(), or (u, gradient, f) as texts, as ("x^2", "2*x ; 0", "-2"). condition_number: "none", "lanczos" or
    "verified". multigrid: if True, also runs CG with algebraic multigrid. cg_tolerance: largest relative residual, above 0. Raises InputError for
    invalid or unsupported cells, for formulas that cannot be read, and for unknown problems and groups.
    """
    mesh = _arguments.mesh(mesh)
    if (problem is None) == (u is None):
        raise InputError("solve needs a formula u or a problem, and not both: solve(mesh, u='sin(x)*y') or solve(mesh, 'gear')")
    if u is None and diffusivity is not None:
        raise InputError("diffusivity needs a formula u, from which f is derived; a problem has its own")
    text, groups = diffusivities(diffusivity)
    record, fields = _core.solve(
        mesh, None if problem is None else named_problem(problem, _core.problems(mesh.dim)), "" if u is None else formula("u", u), text, groups,
        natural_groups(natural), _arguments.whole("degree", degree), _arguments.text("condition_number", condition_number), bool(multigrid),
        _arguments.number("cg_tolerance", cg_tolerance))
    return Solution(record, fields)


def _path(path):
    """Returns the bytes of a path."""
    try:
        return _os.fsencode(path)
    except TypeError:
        raise _arguments.wrong("path", path, "the name of a file") from None


def _fix(fix):
    """Returns (rule or None, names of groups, numbers or flags of nodes or None)."""
    if fix is None:
        return None, [], None
    if isinstance(fix, str):
        return (fix, [], None) if fix in ("boundary", "file", "free") else (None, [fix], None)
    if not hasattr(fix, "__iter__"):
        raise _arguments.wrong("fix", fix, "a rule, or a list of groups, numbers of nodes or truth values")
    if hasattr(fix, "dtype"):
        return None, [], fix
    fix = list(fix)
    groups, nodes = [entry for entry in fix if isinstance(entry, str)], [entry for entry in fix if not isinstance(entry, str)]
    return None, groups, nodes or None


def _no_method(parameters):
    """Returns the InputError of smooth() without a method; a misspelt 'method' is among the parameters."""
    for name in parameters:
        if hint := _arguments.did_you_mean(name, _arguments.arguments_of(smooth)):
            return InputError(f"smooth() has no argument '{name}'{hint}")
    return InputError("smooth needs a method: a name of methods(), as in smooth(mesh, 'getme'), a class or object with step(self, mesh), or a "
                      "function of the mesh")


def _method(method):
    """Returns the method for the compiled part: a name, or the definition of a smoother."""
    if isinstance(method, str):
        return method
    from ._smoothers import Definition
    return Definition(method)


def _settings(given, known):
    """Returns pairs of the names of the method's parameters and texts. Raises InputError for names that are nearly those of arguments of
    smooth() or of parameters; the compiled part refuses the other unknown names."""
    flat = {}
    for name, value in given.items():
        flat.update({f"{name}.{inner}": of_inner for inner, of_inner in value.items()} if isinstance(value, dict)
                    else {name: value})
    names = {name.replace("-", "_"): name for name in known}
    parts = {name.rpartition(".")[2] for name in names} | set(names)
    for name in flat:
        if name.replace("-", "_") not in parts and (
                hint := _arguments.did_you_mean(name, [*_arguments.arguments_of(smooth), *sorted(parts)])):
            raise InputError(f"smooth() has no argument '{name}', and the method no such parameter{hint}")
    return [(names.get(name.replace("-", "_"), name), _text(name, value)) for name, value in flat.items()]


def _text(name, value):
    """Returns a parameter's value as a text for the program; numbers keep all digits."""
    if isinstance(value, str):
        return value
    if hasattr(value, "__iter__"):
        return ", ".join(_text(name, entry) for entry in value)
    try:
        return str(_operator.index(value))
    except TypeError:
        return repr(_arguments.number(f"the parameter {name}", value))
