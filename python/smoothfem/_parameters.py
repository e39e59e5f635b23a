# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters that classes in Python declare: {name: (default, reason)}."""

import inspect
import math
import re

from ._core import InputError
from ._files import unicode

MOST = 2**31 - 1  # the largest whole number of a parameter


def parameters_of(given, owner, reserved=()):
    """Returns [(name, default, reason)] of a class or object. Raises InputError.

    owner: its name in messages. reserved: names that a parameter cannot have."""
    return [_parameter(given, owner, reserved, *entry) for entry in getattr(given, "parameters", {}).items()]


def _parameter(given, owner, reserved, name, declared):
    try:
        value, reason = declared
    except (TypeError, ValueError):
        raise InputError(f"{owner}: parameter {name} has to be declared as (default, 'reason')") from None
    of_class = given if inspect.isclass(given) else type(given)
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", str(name)) or name in reserved or hasattr(of_class, name):
        raise InputError(f"{owner}: a parameter cannot be called '{name}'; choose another name, of letters, "
                         "digits and _, that is not an attribute of the class")
    if not inspect.isclass(given):
        value = getattr(given, name, value)
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise InputError(f"{owner}: parameter {name} has the default {value!r}; it has to be a number or a string")
    if isinstance(value, float) and not math.isfinite(value) or isinstance(value, int) and abs(value) > MOST:
        raise InputError(f"{owner}: parameter {name} has the default {value!r}; numbers have to be finite, and "
                         f"whole numbers at most {MOST}")
    return name, unicode(value) if isinstance(value, str) else value, unicode(reason)
