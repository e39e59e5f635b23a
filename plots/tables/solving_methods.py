# SPDX-License-Identifier: GPL-3.0-or-later
"""Common parts of the tables of solution-adaptive methods: their selection, the first columns, words."""

from ..results.rows import groups_of, solves_itself
from ..results.smoothing import INITIAL
from .table import text_cell

REFINED = "-fine"  # a mesh's name with this is that of the same domain with shorter edges
PAYS, DOES_NOT_PAY = "pays", "does not pay"
ERRORS = (("H1", "h1_error"), ("L2", "l2_error"))


def solving_groups(results):
    """((mesh, degree, method), rows) of methods that solve, in the order of the study."""
    groups = [(key, rows) for key, rows in groups_of(results.iterations, "mesh", "degree", "method")
              if key[2] in results.methods and solves_itself(rows)]
    return sorted(groups, key=lambda group: (results.meshes.index(group[0][0]),
                                             results.degrees.index(group[0][1]),
                                             results.methods.index(group[0][2])))


def key_cells(keys, results):
    """Cells of mesh, degree and method, empty where they repeat; and where a mesh begins."""
    cells, rules, before = [], [], (None, None, None)
    for number, key in enumerate(keys):
        mesh, degree, method = key
        if mesh != before[0] and number:
            rules.append(number)
        cells.append((text_cell("" if mesh == before[0] else results.title(mesh)),
                      text_cell("" if (mesh, degree) == before[:2] else degree),
                      text_cell(results.title(method))))
        before = key
    return tuple(cells), tuple(rules)


def reference_method(results):
    """The first method that does not solve; None if all do."""
    return next((method for method in results.methods
                 if not solves_itself(results.iterations.select(method=method))), None)


def smoothing_seconds(rows):
    """Seconds at the first row, including the time before the main loops; 0 for the initial mesh."""
    if rows.text("method")[0] == INITIAL:
        return 0.0
    return rows.number("smoothing_seconds")[0] + rows.number("preparation_seconds")[0]
