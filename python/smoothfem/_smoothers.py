# SPDX-License-Identifier: GPL-3.0-or-later
"""Smoothers written in Python, as the smoothing loop takes them: found in files, asked for their
parameters, run, and watched. What they do wrong is an InputError of one sentence."""

import inspect
import re
import sys
import traceback
import types

import numpy as np

from ._core import InputError

STOPPING = {"tolerance": 1e-4, "patience": 0, "max_iterations": 10000}  # as QualityGainStopping
_known = {}


def definition_in(path, name, once):
    """The Definition of the class `name` in the file `path`. once: a file that has been run is not read
    again; otherwise it is run again when its text has changed. Raises InputError."""
    known = _known.get(path)
    if known is None or not once:
        source = _with_context(path, f"{path} cannot be read", lambda: _read(path))
        if known is None or known[0] != source:
            known = _known[path] = (source, _with_context(path, f"{path} cannot be run", lambda: _run_file(path, source)))
    module = known[1]
    if not inspect.isclass(getattr(module, name, None)):
        classes = sorted(key for key, value in vars(module).items() if inspect.isclass(value) and callable(
            getattr(value, "step", None)))
        raise InputError(f"{path} has no class '{name}'; " + (
            f"choose one of {', '.join(classes)}" if classes else "it has no class with step(self, mesh) at all"))
    return Definition(getattr(module, name), f"python:{path}:{name}", path)


def _read(path):
    with open(path, "rb") as file:
        return file.read()


def _run_file(path, source):
    """The module that the file is. It is not looked for beside other modules, and nothing is written
    beside it."""
    module = types.ModuleType(f"smoothfem method {path}")
    module.__file__ = path
    sys.modules[module.__name__] = module  # dataclasses look for it
    exec(compile(source, path, "exec"), module.__dict__)  # the file is the user's own program
    return module


class Definition:
    """What a class says of itself as a smoother. Raises InputError if it is none."""

    def __init__(self, cls, method_name=None, path=None):
        self.cls, self.path = cls, path or getattr(sys.modules.get(cls.__module__), "__file__", None)
        self.name = cls.__name__
        self.method_name = method_name or f"python:{self.name}"
        if not callable(getattr(cls, "step", None)):
            raise InputError(f"the class {self.name} is no smoother: it has no step(self, mesh)")
        self.title = str(getattr(cls, "title", self.name))
        documentation = (cls.__doc__ or "a smoother written in Python").strip().splitlines()[0]
        self.description = str(getattr(cls, "description", documentation.rstrip(".")))
        self.source = str(getattr(cls, "source", "a class in Python"))
        self.parameters = [self._parameter(*entry) for entry in getattr(cls, "parameters", {}).items()]
        for key, default in STOPPING.items():
            setattr(self, key, self._number(key, getattr(cls, key, default), type(default)))

    def _parameter(self, name, declared):
        """(name, default, reason)."""
        try:
            value, reason = declared
        except (TypeError, ValueError):
            raise InputError(f"{self.name}: parameter {name} is declared by (default, 'reason')") from None
        if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", str(name)) or name in STOPPING or hasattr(self.cls, name):
            raise InputError(f"{self.name}: a parameter cannot be called '{name}'; take another name, of letters, "
                             "digits and _, that the class has not")
        if isinstance(value, bool) or not isinstance(value, (int, float, str)):
            raise InputError(f"{self.name}: parameter {name} has the default {value!r}; it has to be a number or a text")
        return name, value, str(reason)

    def _number(self, key, value, kind):
        if isinstance(value, bool) or not isinstance(value, (int, float)) or kind(value) != value:
            raise InputError(f"{self.name}: {key} is {value!r}, but has to be a "
                             f"{'whole number' if kind is int else 'number'}")
        return kind(value)


class Run:
    """A smoother at work on one mesh."""

    def __init__(self, definition, values, mesh):
        """values: of its parameters, by name. mesh: lent, its points a read-only copy."""
        self.definition = definition
        self.fixed = mesh.fixed
        self.smoother = self._with_context("cannot be made", lambda: self._made(definition.cls, values))
        if hasattr(self.smoother, "initialize"):
            self._with_context("initialize failed", lambda: self.smoother.initialize(mesh))

    @staticmethod
    def _made(cls, values):
        smoother = cls.__new__(cls)
        for name, value in values.items():
            setattr(smoother, name, value)
        smoother.__init__()
        return smoother

    def _with_context(self, what, call):
        return _with_context(self.definition.path, f"{self.definition.name}: {what}", call)

    def step(self, mesh):
        """One step. Raises InputError, with the mesh as it was, for what a smoother must not do."""
        before = mesh.points.copy()
        try:
            returned = self._with_context("step failed", lambda: self.smoother.step(mesh))
            if returned is not None and returned is not mesh.points:
                mesh.points[:] = self._new_points(returned, before.shape)
            self._require_allowed(mesh.points, before)
        except BaseException:
            mesh.points[:] = before
            raise

    def _new_points(self, returned, shape):
        points = self._with_context("step returned no array", lambda: np.asarray(returned, dtype=float))
        if points.shape != shape:
            raise InputError(f"{self.definition.name}: step returned an array of the shape {points.shape}, but the points "
                             f"of the mesh have the shape {shape}; return all points, or change mesh.points in place")
        return points

    def _require_allowed(self, points, before):
        finite = np.isfinite(points).all(axis=1)
        if not finite.all():
            raise InputError(f"{self.definition.name}: step has made a coordinate of node {np.argmin(finite)} something "
                             "that is not a finite number")
        moved = (points[self.fixed] != before[self.fixed]).any(axis=1)
        if moved.any():
            raise InputError(f"{self.definition.name}: step has moved the fixed node {self.fixed[np.argmax(moved)]}; only "
                             "the nodes in mesh.free may move")


def _with_context(path, what, call):
    """call(), whose exceptions become one sentence with file, line and their text."""
    try:
        return call()
    except (InputError, KeyboardInterrupt):
        raise
    except BaseException as error:  # an exit, too, must not end the program
        raise InputError(f"{what}: {_sentence(error, path)}") from error


def _sentence(error, path):
    """'mine.py:12: ZeroDivisionError: division by zero': the last line of the smoother's own file that
    was at work."""
    at = [(frame.filename, frame.lineno) for frame in traceback.extract_tb(error.__traceback__) if frame.filename == path]
    text = str(error)
    if isinstance(error, SyntaxError) and error.lineno:
        at, text = [(error.filename, error.lineno)], error.msg
    place = f"{at[-1][0]}:{at[-1][1]}: " if at else ""
    return place + type(error).__name__ + (f": {' '.join(text.split())}" if text else "")
