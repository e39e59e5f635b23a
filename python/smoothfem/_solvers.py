# SPDX-License-Identifier: GPL-3.0-or-later
"""Solvers written in Python: finds them in files, and runs them on the meshes of a study. A mistake of a solver raises an
InputError of one sentence."""

import math
import re

from ._core import InputError
from ._files import class_in, files_of, unicode, with_context
from ._parameters import parameters_of

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def rows_of(matrix, right_hand_side):
    """Returns (offsets, columns, values, right-hand side) of a square matrix of scipy or numpy; the right-hand side is that of ones if None."""
    import numpy as np
    import scipy.sparse as sp
    rows = sp.csr_matrix(matrix, dtype=float)
    if rows.shape[0] != rows.shape[1]:
        raise ValueError(f"it has {rows.shape[0]} rows and {rows.shape[1]} columns")
    rows.sum_duplicates()
    b = rows @ np.ones(rows.shape[0]) if right_hand_side is None else np.asarray(right_hand_side, dtype=float).ravel()
    if len(b) != rows.shape[0]:
        raise ValueError(f"it has {rows.shape[0]} rows, but the right-hand side {len(b)} entries")
    return rows.indptr, rows.indices, rows.data, b


class SolverDefinition:
    """The attributes of a class with solve(self, mesh). Raises InputError if it is none."""

    def __init__(self, path, name, once):
        self.given, self.path = class_in(path, name, once, "solve"), path
        self.name = unicode(name)
        if not callable(getattr(self.given, "solve", None)):
            raise InputError(f"the class {self.name} is not a solver: it has no solve(self, mesh)")
        self.title = unicode(getattr(self.given, "title", self.name))
        self.parameters = parameters_of(self.given, self.name)
        self.has_energy = self._has_energy()
        self.has_indicators = callable(getattr(self.given, "indicators", None))
        self.gives_matrix = bool(getattr(self.given, "gives_matrix", False))
        self.takes_curved_cells = bool(getattr(self.given, "takes_curved_cells", False))
        self.degrees = self._degrees(getattr(self.given, "degrees", ()))
        self.numbers = [self._number(*entry) for entry in dict(getattr(self.given, "numbers", {})).items()]

    @property
    def files(self):
        """The solver's file and those of the modules that it imports from the same folder: its code."""
        return files_of(self.path)

    def _has_energy(self):
        """True if it has energy(mesh) and energy_gradient(mesh)."""
        has = [name for name in ("energy", "energy_gradient") if callable(getattr(self.given, name, None))]
        if len(has) == 1:
            raise InputError(f"the class {self.name} has {has[0]}, but not the other one of energy and energy_gradient; methods need both")
        return len(has) == 2

    def _degrees(self, given):
        """Returns the degrees of its finite elements; none without."""
        if not isinstance(given, (list, tuple)) or any(isinstance(degree, bool) or not isinstance(degree, int) or degree < 1 for degree in given):
            raise InputError(f"{self.name}: degrees is {given!r}, but has to be a list of whole numbers, such as [1, 2]")
        return list(given)

    def _number(self, name, declared):
        """Returns (name, unit, meaning)."""
        if not NAME.fullmatch(str(name)) or not (isinstance(declared, tuple) and len(declared) == 2):
            raise InputError(f"{self.name}: numbers has the entry {name!r}: {declared!r}; write 'name': ('unit', 'meaning.'), the name of letters, "
                             "digits and _")
        return name, unicode(declared[0]), unicode(declared[1])


class SolverRun:
    """Runs a solver on the meshes of one topology."""

    def __init__(self, definition, values, degree, mesh):
        """values: the values of its parameters, by name. degree: 0 if the solver has none. mesh: a lent mesh."""
        self.definition = definition
        self.solver = self._with_context("cannot be created", lambda: self._made(values, degree))
        if hasattr(self.solver, "initialize"):
            self._with_context("initialize failed", lambda: self.solver.initialize(mesh))

    def _made(self, values, degree):
        solver = self.definition.given.__new__(self.definition.given)
        for name, value in values.items():
            setattr(solver, name, value)
        solver.degree = degree
        solver.__init__()
        return solver

    def _with_context(self, what, call):
        return with_context(self.definition.path, f"{self.definition.name}: {what}", call)

    def solve(self, mesh):
        """Returns ([(name, number)], matrix), the matrix as (offsets, columns, values, right-hand side) or None. Raises InputError
        unless the solver gives finite numbers by their names."""
        found = self._with_context("solve failed", lambda: self.solver.solve(mesh))
        if not isinstance(found, dict) or not found:
            raise InputError(f"{self.definition.name}: solve returned {type(found).__name__}, but has to return a dict such as {{'u_max': 1.5}}")
        found = dict(found)
        matrix, right_hand_side = found.pop("matrix", None), found.pop("right_hand_side", None)
        if (matrix is not None) != self.definition.gives_matrix:
            raise InputError(f"{self.definition.name}: solve gives {'a' if matrix is not None else 'no'} matrix, but the class has gives_matrix = "
                             f"{self.definition.gives_matrix}")
        numbers = [self._number(*entry) for entry in found.items()]
        return numbers, None if matrix is None else self._with_context("its matrix cannot be read", lambda: rows_of(matrix, right_hand_side))

    def energy(self, mesh):
        """Solves on a mesh and returns the energy."""
        self.shape = mesh.points.shape
        value = self._with_context("energy failed", lambda: self.solver.energy(mesh))
        return self._number("energy", value, "energy")[1]

    def energy_gradient(self):
        """Returns the derivative of the last energy in the nodes' positions, in the shape of mesh.points."""
        return self._array("energy_gradient", self.solver.energy_gradient, self.shape)

    def indicators(self, mesh):
        """Returns the error indicator of each cell."""
        return self._array("indicators", lambda: self.solver.indicators(mesh), (mesh.n_cells,))

    def _array(self, name, call, shape):
        import numpy as np
        values = self._with_context(f"{name} failed", lambda: np.ascontiguousarray(call(), dtype=float))
        if values.shape != tuple(shape) or not np.isfinite(values).all():
            raise InputError(f"{self.definition.name}: {name} returns an array of shape {values.shape}, but has to return finite numbers of shape "
                             f"{tuple(shape)}")
        return values

    def _number(self, name, value, function="solve"):
        if not NAME.fullmatch(str(name)):
            raise InputError(f"{self.definition.name}: solve gives a number the name {name!r}; names have letters, digits and _, a letter first")
        try:
            number = float(value)
        except (TypeError, ValueError):
            raise InputError(f"{self.definition.name}: {function} gives {name} a value that is not a number") from None
        if not math.isfinite(number):
            raise InputError(f"{self.definition.name}: {function} gives {name} the value {number}, which is not finite")
        return str(name), number
