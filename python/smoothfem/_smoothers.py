# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds smoothers written in Python in files, reads their parameters, runs them for the smoothing loop, and checks them. A
mistake of a smoother raises an InputError of one sentence."""

import inspect
import os
import sys

import numpy as np

from ._arguments import shown
from ._core import InputError
from ._files import class_in, files_of, unicode, with_context
from ._parameters import parameters_of

STOPPING = {"tolerance": 1e-4, "patience": 0, "max_iterations": 10000}  # defaults of QualityGainStopping
RANGES = {"tolerance": (-1.0, 1.0), "patience": (0, 10**9), "max_iterations": (1, 10**9)}  # of QualityGainStopping, too


def definition_in(path, name, once):
    """Returns the Definition of the class `name` in the file `path`; once: see class_in. Raises InputError."""
    return Definition(class_in(path, name, once, "step"), f"python:{path}:{name}", path)


class Definition:
    """The attributes of a smoother. Raises InputError if it is none.

    given: a class or an object with step(self, mesh), or a function of the mesh. Classes are created for each run."""

    def __init__(self, given, method_name=None, path=None):
        self.given = given
        self.is_function = not hasattr(given, "step") and callable(given) and not inspect.isclass(given)
        cls = given if inspect.isclass(given) else type(given)
        self.path = path or (_file_of(given) if self.is_function else getattr(sys.modules.get(cls.__module__), "__file__", None))
        self.name = unicode(getattr(given, "__name__", cls.__name__)).strip("<>")
        self.method_name = method_name or f"python:{self.name}"
        if not self.is_function and not callable(getattr(given, "step", None)):
            raise InputError(f"the class {self.name} is not a smoother: it has no step(self, mesh)" if inspect.isclass(given) else
                             f"the method is {shown(given)}, but has to be a name, a class or object with step(self, mesh), or a function of the mesh")
        cls = given  # parameters and rules may be attributes of the object or of the function
        self.title = unicode(getattr(cls, "title", self.name))
        documentation = ((cls.__doc__ or "").strip() or "a smoother written in Python").splitlines()[0]
        self.description = unicode(getattr(cls, "description", documentation.rstrip(".")))
        self.source = unicode(getattr(cls, "source", "a class in Python"))
        self.parameters = parameters_of(cls, self.name, reserved=STOPPING)
        for key, default in STOPPING.items():
            setattr(self, key, self._number(key, getattr(cls, key, default), type(default)))

    @property
    def files(self):
        """The smoother's file and those of the modules that it imports from the same folder: its code."""
        return files_of(self.path)

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
        return with_context(self.definition.path, f"{self.definition.name}: {what}", call)

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


