# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds smoothers written in Python in files, reads their parameters, runs them for the smoothing loop, and checks them. A
mistake of a smoother raises an InputError of one sentence."""

import inspect
import math
import os
import re
import sys
import traceback
import types

import numpy as np

from ._arguments import shown
from ._core import InputError

STOPPING = {"tolerance": 1e-4, "patience": 0, "max_iterations": 10000}  # defaults of QualityGainStopping
RANGES = {"tolerance": (-1.0, 1.0), "patience": (0, 10**9), "max_iterations": (1, 10**9)}  # of QualityGainStopping, too
MOST = 2**31 - 1  # the largest whole number of a parameter
_known = {}


def definition_in(path, name, once):
    """Returns the Definition of the class `name` in the file `path`. Raises InputError.

    once: if True, a file that has been run is not read again. Otherwise it is run again if its text has changed."""
    if once:
        _keep_process()
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


def _keep_process():
    """Makes os._exit an error: it would end the program without its results. In processes that a smoother forks it stays."""
    if getattr(os._exit, "of_smoothfem", False):
        return
    leave, own = os._exit, os.getpid()

    def leave_if_forked(code):
        if os.getpid() != own:
            leave(code)
        raise SystemExit(code)

    leave_if_forked.of_smoothfem = True
    os._exit = leave_if_forked


def _read(path):
    with open(path, "rb") as file:
        return file.read()


def _run_file(path, source):
    """Runs the file as a module and returns it. It can import the modules in its folder, unless their names are those of
    installed ones. No byte code is written next to the file."""
    module = types.ModuleType(f"smoothfem method {path}")
    module.__file__ = path
    sys.modules[module.__name__] = module  # dataclasses look for it
    folder = os.path.dirname(os.path.abspath(path))
    if folder not in sys.path:
        sys.path.append(folder)
    sys.dont_write_bytecode, before = True, sys.dont_write_bytecode
    try:
        exec(compile(source, path, "exec"), module.__dict__)  # the file is the program of a user
    finally:
        sys.dont_write_bytecode = before
    return module


class Definition:
    """The attributes of a smoother. Raises InputError if it is none.

    given: a class or an object with step(self, mesh), or a function of the mesh. Classes are created for each run."""

    def __init__(self, given, method_name=None, path=None):
        self.given = given
        self.is_function = not hasattr(given, "step") and callable(given) and not inspect.isclass(given)
        cls = given if inspect.isclass(given) else type(given)
        self.path = path or (_file_of(given) if self.is_function else getattr(sys.modules.get(cls.__module__), "__file__", None))
        self.name = _unicode(getattr(given, "__name__", cls.__name__)).strip("<>")
        self.method_name = method_name or f"python:{self.name}"
        if not self.is_function and not callable(getattr(given, "step", None)):
            raise InputError(f"the class {self.name} is not a smoother: it has no step(self, mesh)" if inspect.isclass(given) else
                             f"the method is {shown(given)}, but has to be a name, a class or object with step(self, mesh), or a function of the mesh")
        cls = given  # parameters and rules may be attributes of the object or of the function
        self.title = _unicode(getattr(cls, "title", self.name))
        documentation = ((cls.__doc__ or "").strip() or "a smoother written in Python").splitlines()[0]
        self.description = _unicode(getattr(cls, "description", documentation.rstrip(".")))
        self.source = _unicode(getattr(cls, "source", "a class in Python"))
        self.parameters = [self._parameter(*entry) for entry in getattr(cls, "parameters", {}).items()]
        for key, default in STOPPING.items():
            setattr(self, key, self._number(key, getattr(cls, key, default), type(default)))

    @property
    def files(self):
        """The smoother's file and those of the modules that it imports from the same folder: its code."""
        if not self.path:
            return []
        folder = os.path.dirname(os.path.abspath(self.path))
        modules = (getattr(module, "__file__", None) for module in list(sys.modules.values()))
        others = {file for file in modules if file and os.path.dirname(os.path.abspath(file)) == folder and os.path.isfile(file)}
        return [self.path, *sorted(others - {self.path})]

    def _parameter(self, name, declared):
        """Returns (name, default, reason)."""
        try:
            value, reason = declared
        except (TypeError, ValueError):
            raise InputError(f"{self.name}: parameter {name} has to be declared as (default, 'reason')") from None
        of_class = self.given if inspect.isclass(self.given) else type(self.given)
        if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", str(name)) or name in STOPPING or hasattr(of_class, name):
            raise InputError(f"{self.name}: a parameter cannot be called '{name}'; choose another name, of letters, "
                             "digits and _, that is not an attribute of the class")
        if not inspect.isclass(self.given):
            value = getattr(self.given, name, value)
        if isinstance(value, bool) or not isinstance(value, (int, float, str)):
            raise InputError(f"{self.name}: parameter {name} has the default {value!r}; it has to be a number or a string")
        if isinstance(value, float) and not math.isfinite(value) or isinstance(value, int) and abs(value) > MOST:
            raise InputError(f"{self.name}: parameter {name} has the default {value!r}; numbers have to be finite, and "
                             f"whole numbers at most {MOST}")
        return name, _unicode(value) if isinstance(value, str) else value, _unicode(reason)

    def _number(self, key, value, kind):
        if isinstance(value, bool) or not isinstance(value, (int, float)) or kind(value) != value:
            raise InputError(f"{self.name}: {key} is {value!r}, but has to be a "
                             f"{'whole number' if kind is int else 'number'}")
        lowest, highest = RANGES[key]
        if not lowest <= value <= highest:
            raise InputError(f"{self.name}: {key} is {value!r}, but has to be from {lowest} to {highest}")
        return kind(value)


class Run:
    """Runs a smoother on one mesh."""

    def __init__(self, definition, values, mesh):
        """values: the values of its parameters, by name. mesh: a lent mesh; its points are a read-only copy."""
        self.definition = definition
        self.fixed = mesh.fixed
        self.smoother = self._with_context("cannot be created", lambda: self._made(definition.given, values))
        self.do_step = self.smoother if definition.is_function else self.smoother.step
        if hasattr(self.smoother, "initialize"):
            self._with_context("initialize failed", lambda: self.smoother.initialize(mesh))

    @staticmethod
    def _made(given, values):
        """Returns a new object of a class; objects and functions are taken as they are."""
        if not inspect.isclass(given):
            for name, value in values.items():
                setattr(given, name, value)
            return given
        smoother = given.__new__(given)
        for name, value in values.items():
            setattr(smoother, name, value)
        smoother.__init__()
        return smoother

    def _with_context(self, what, call):
        return _with_context(self.definition.path, f"{self.definition.name}: {what}", call)

    def step(self, mesh):
        """Does one step. Raises InputError and restores the mesh if the smoother violates a rule."""
        before = mesh.points.copy()
        try:
            returned = self._with_context("step failed", lambda: self.do_step(mesh))
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
            raise InputError(f"{self.definition.name}: step has set a coordinate of node {np.argmin(finite)} to a "
                             "value that is not a finite number")
        moved = (points[self.fixed] != before[self.fixed]).any(axis=1)
        if moved.any():
            raise InputError(f"{self.definition.name}: step has moved the fixed node {self.fixed[np.argmax(moved)]}; only "
                             "the nodes in mesh.free may move")


def _file_of(function):
    """Returns the file of a function; None if it is in none, as in a notebook."""
    path = getattr(getattr(function, "__code__", None), "co_filename", "")
    return path if os.path.isfile(path) else None


def _unicode(text):
    """Returns a text that UTF-8 can hold."""
    return str(text).encode("utf-8", "replace").decode("utf-8")


def _with_context(path, what, call):
    """Returns call(). Exceptions in it become an InputError of one sentence with file, line and their text."""
    try:
        return call()
    except (InputError, KeyboardInterrupt):
        raise
    except BaseException as error:  # an exit must not end the program either
        raise InputError(_unicode(f"{what}: {_sentence(error, path)}")) from error


def _text_of(error):
    """Returns the text of an exception, whose own code may fail."""
    try:
        return str(error)
    except Exception:
        return "without a text"


def _sentence(error, path):
    """Returns, for example, 'mine.py:12: ZeroDivisionError: division by zero'. The line is the last line of the smoother's
    file in the traceback."""
    at = [(frame.filename, frame.lineno) for frame in traceback.extract_tb(error.__traceback__) if frame.filename == path]
    text = _text_of(error)
    if isinstance(error, SyntaxError) and error.lineno:
        at, text = [(error.filename, error.lineno)], error.msg
    place = f"{at[-1][0]}:{at[-1][1]}: " if at else ""
    return place + type(error).__name__ + (f": {' '.join(text.split())}" if text else "")
