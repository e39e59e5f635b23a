# SPDX-License-Identifier: GPL-3.0-or-later
"""The arguments and the result of solve()."""

import re

import numpy as np

from ._arguments import shown, wrong
from ._core import InputError


class Solution(dict):
    """The result of solve(): numbers as attributes and, as in a dict, by their names; fields on the mesh as arrays.

    u_h: nodal solution, one number for each node. u: the known solution there. nodal_error: distance of u_h from u. cell_l2_error, cell_h1_error: norms of
    u - u_h on each cell. dof_points, dof_values: positions of all degrees of freedom, and u_h there. Nodes that no cell uses have NaN.
    """

    def __init__(self, record, fields):
        super().__init__(record)
        self.u_h, self.u = fields["u_h"], fields["u"]
        self.dof_points, self.dof_values = fields["dof_points"], fields["dof_values"]
        self.cell_l2_error, self.cell_h1_error = fields["cell_l2_errors"], fields["cell_h1_errors"]

    @property
    def nodal_error(self):
        """Returns the distance of u_h from u at each node."""
        return np.abs(self.u - self.u_h)

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"a Solution has no attribute '{name}'; its numbers are {', '.join(self)}") from None

    def __dir__(self):
        return [*super().__dir__(), *self]

    def __repr__(self):
        return (f"<smoothfem.Solution: degree {self['degree']}, {self['n_free']} unknowns, L2 error {self['l2_error']:.4g}, "
                f"H1 error {self['h1_error']:.4g}, {self['status']}>")


def formula(name, value):
    """Returns a formula as a text: a text as it is, a number by all its digits."""
    if isinstance(value, str):
        if value.strip():
            return value
    elif callable(value):
        raise InputError(f"{name} is a function, but f and the boundary values need derivatives of a formula: write it as a text, such as 'sin(x)*y'")
    elif isinstance(value, (int, float, np.number)) and not isinstance(value, bool):
        return repr(float(value))
    raise wrong(name, value, "a formula, such as 'sin(x)*y'")


def tensor(name, value):
    """Returns a diffusivity as a text: a formula, a number, or rows of these."""
    if isinstance(value, str) or callable(value) or not hasattr(value, "__iter__"):
        return formula(name, value)
    rows = []
    for row in value:
        if isinstance(row, str) or not hasattr(row, "__iter__"):
            raise wrong(name, value, "a formula, a number, or a tensor as rows, such as [[2, 0], [0, '1+x^2']]")
        rows.append(", ".join(formula(name, entry) for entry in row))
    return " ; ".join(rows)


def diffusivities(value):
    """Returns (A, [(group, A of the group)]) as texts. A dict has groups as keys; None: the cells of no other group."""
    if value is None:
        return "", []
    if not hasattr(value, "items"):
        return tensor("diffusivity", value), []
    rest = tensor("diffusivity[None]", value[None]) if None in value else ""
    return rest, [(_group("diffusivity", group), tensor(f"diffusivity[{group!r}]", of_group)) for group, of_group in value.items()
                  if group is not None]


def natural_groups(value):
    """Returns names or tags of groups as texts."""
    if isinstance(value, (str, int, np.integer)):
        value = [value]
    if not hasattr(value, "__iter__"):
        raise wrong("natural", value, "a list of groups, by names or tags")
    return [_group("natural", group) for group in value]


def named_problem(value, known):
    """Returns a name, or (u, gradient, f) as texts."""
    if isinstance(value, str):
        if value not in known and re.search(r"[\s()*/+^0-9]|^[xyz]$", value):
            raise InputError(f"there is no problem '{value}'; for a formula of your own, call solve(mesh, u={value!r})")
        return value
    if isinstance(value, (tuple, list)) and len(value) == 3 and all(isinstance(part, str) for part in value):
        return tuple(value)
    if callable(value):
        return formula("problem", value)
    raise InputError(f"problem is {shown(value)}, but has to be a name of problems() or (u, gradient, f) as texts; for a formula, call solve(mesh, u=...)")


def _group(name, group):
    if isinstance(group, bool) or not isinstance(group, (str, int, np.integer)) or not str(group).strip():
        raise wrong(f"a group of {name}", group, "a name or a tag")
    return str(group)
