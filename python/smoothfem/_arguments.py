# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks arguments of functions, so that a mistake is an InputError of one sentence."""

import difflib
import functools
import inspect
import math
import operator

from ._core import InputError, Mesh

LONGEST = 60  # characters of a value in a message


def shown(value):
    """Returns a value for a message: its repr if that is short, otherwise its type."""
    try:
        text = repr(value)
    except Exception:  # its own code may fail
        text = ""
    return text if 0 < len(text) <= LONGEST and "\n" not in text else f"an object of the type {type(value).__name__}"


def wrong(name, value, wanted):
    """Returns the InputError for an argument; wanted: what it has to be."""
    return InputError(f"{name} is {shown(value)}, but has to be {wanted}")


def did_you_mean(name, names):
    """Returns "; did you mean 'method'?" with the nearest of some names; an empty text if none is near."""
    near = difflib.get_close_matches(name, names, n=1, cutoff=0.7)
    return f"; did you mean '{near[0]}'?" if near else ""


def arguments_of(function):
    """Returns the names of a function's arguments, but for *args and **kwargs."""
    return [p.name for p in inspect.signature(function).parameters.values() if p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)]


def refusing_unknown(function):
    """Returns the function, which refuses arguments with unknown names by an InputError that has the nearest name."""
    names = arguments_of(function)

    @functools.wraps(function)
    def checked(*args, **named):
        for name in named:
            if name not in names:
                raise InputError(f"{function.__name__}() has no argument '{name}'" + (did_you_mean(name, names) or f"; it has {', '.join(names)}"))
        return function(*args, **named)
    return checked


def mesh(value):
    """Returns a Mesh as it is. For meshes of other packages the error names the function that converts them."""
    if isinstance(value, Mesh):
        return value
    raise InputError(foreign_mesh(value) or f"the mesh is {shown(value)}, but has to be a smoothfem.Mesh: take read(), generate() or Mesh(points, cells)")


def foreign_mesh(value):
    """Returns what to call for a mesh of meshio or PyVista; None for other objects."""
    for package in ("meshio", "pyvista"):
        if any(base.__module__.partition(".")[0] == package for base in type(value).__mro__):
            return f"this is a mesh of {package}: call smoothfem.from_{package}(mesh) first"
    return None


def number(name, value, low=-math.inf, high=math.inf):
    """Returns a float from low to high."""
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError
        result = float(value)
    except (TypeError, ValueError):
        raise wrong(name, value, "a number") from None
    if not low <= result <= high:
        raise wrong(name, value, f"a number from {low:g} to {high:g}" if math.isfinite(low + high) else f"a number from {low:g} on")
    return result


def optional_number(name, value, low=-math.inf, high=math.inf):
    """Returns a float, or None for None."""
    return None if value is None else number(name, value, low, high)


def whole(name, value, low=-2**31, high=2**31 - 1):
    """Returns an int from low to high."""
    try:
        result = operator.index(value)
    except TypeError:
        raise wrong(name, value, "a whole number") from None
    if not low <= result <= high:
        raise wrong(name, value, f"a whole number from {low} to {high}")
    return result


def text(name, value):
    """Returns a str."""
    if not isinstance(value, str):
        raise wrong(name, value, "a text")
    return value


def function(name, value):
    """Returns a callable, or None for None."""
    if value is not None and not callable(value):
        raise wrong(name, value, "a function")
    return value


def fields(name, value, n, what):
    """Returns {name: list of n numbers}."""
    import numpy as np
    if not hasattr(value, "items"):
        raise wrong(name, value, "a dict {name: numbers}")
    arrays = {}
    for key, numbers in value.items():
        try:
            array = np.asarray(numbers, dtype=float)
        except (TypeError, ValueError):
            raise InputError(f"{name}[{shown(key)}] has no numbers") from None
        if array.shape != (n,):
            raise InputError(f"{name}[{shown(key)}] has the shape {array.shape}, but the mesh has {n} {what}")
        arrays[text(f"a name in {name}", key)] = array.tolist()
    return arrays
