# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields of several components, and their names.

A format that lacks some numbers of components gets one array for each component. Its name ends with the number of the component,
ten characters wide, as VTK does it for Exodus."""

import re

import numpy as np


def with_split_fields(arrays, held):
    split = {}
    for name, values in arrays.items():
        if values.ndim == 1 or values.shape[1] in held:
            split[name] = values
        else:
            split.update({f"{name}{k:10d}": values[:, k] for k in range(values.shape[1])})
    return split


def with_joined_fields(arrays):
    components, result = {}, {}
    for name, values in arrays.items():
        part = re.fullmatch(r"(.+)(?=.{10}$)( +\d+)", name)
        base, k = (part[1], int(part[2])) if part else (name, None)
        components.setdefault((base, k is None), {})[k] = values
    for (base, is_whole), parts in components.items():
        if is_whole:
            result[base] = parts[None]
        elif sorted(parts) == list(range(len(parts))) and base not in arrays:
            result[base] = np.column_stack([parts[k] for k in sorted(parts)])
        else:
            result.update({f"{base}{k:10d}": values for k, values in parts.items()})
    return result


def as_wide_numbers(arrays):
    """meshio writes no integers of 8 or 16 bits."""
    return {name: values.astype(np.int32) if values.dtype.itemsize < 4 else values for name, values in arrays.items()}


def unused_name(name, taken):
    """The name, with "_set" at its end as often as another field has it."""
    while name in taken:
        name += "_set"
    return name
