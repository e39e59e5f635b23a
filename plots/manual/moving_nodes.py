# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of the manual on solution-adaptive methods, from the studies energy-* in results/reference."""

import csv
import io
import re
from functools import lru_cache

import numpy as np

from ..collections.comparison import AS_IS, INITIAL_MESH, payoffs
from ..collections.problems import problems_of
from ..results.collection import read_collection_results
from ..results.data_folder import data_folder
from ..results.rows import ResultsError, read_rows
from ..results.smoothing import read_results
from ..tables.energy import factor_table, make_energy_tables, orders_table
from ..tables.formats import as_csv
from ..tables.number_format import MISSING
from .blocks import table

FIXED = ("Weights", "Descent", "Moving mesh and descent")
SLIDING = ("Weights, sliding", "Moving mesh and descent, sliding")
ELEMENTS = ("triangles", "quadrilaterals", "tetrahedra", "hexahedra")
STUDIES = ("energy", "energy-front", "energy-layer", "energy-l-shape", "energy-flange", "energy-fichera", "energy-front-volume",
           "energy-layer-volume")
# Rows of the table of variants -> method and suffix of the mesh, in energy-front and energy-layer ...
ROWS = {"`indicator-weighted`": ("Weights", ""), "`indicator-mmpde-descent` (5 solves, then descent)": ("Moving mesh and descent", ""),
        "the same, sliding": ("Moving mesh and descent, sliding", ""),
        "the same, sliding, on meshes with half the edge length": ("Moving mesh and descent, sliding", ", refined")}
# ... and method in energy-front-variants and energy-layer-variants.
VARIANTS = {"`indicator-weighted`, indicator averaged 4 times": "Weights, averaged 4 times",
            "`indicator-weighted`, no quality floor": "Weights, no quality floor", "`indicator-weighted`, 60 sweeps": "Weights, 60 sweeps",
            "`indicator-weighted`, residual": "Weights by the residual",
            "`indicator-weighted`, residual of degree 2": "Weights by the residual of degree 2",
            "`indicator-weighted`, sliding": "Weights, sliding", "`indicator-aligned`, sliding": "Aligned, sliding",
            "`indicator-getme`": "GETMe with sizes"}
AFTER = "H1 after solves 20"


@lru_cache(maxsize=None)
def payoffs_of(folder):
    """(Payoffs of a collection's methods but GETMe on each kind of meshes, titles of methods)."""
    results = read_collection_results(folder)
    return [found for found in payoffs(problems_of(results), [name for name in results.methods if name != "getme"])
            if found.method != INITIAL_MESH and found.change == AS_IS], results.titles


@lru_cache(maxsize=None)
def energy_tables(folder):
    """The energy tables of a study's results, by name."""
    return {table.name: table for table in make_energy_tables(read_results(folder))}


def by_key(rows):
    """(mesh, degree, method) -> record of a table, as printed."""
    return {(row["Mesh"], row["d"], row["Method"]): row for row in rows}


class Tables:
    """Tables of the reference."""

    def __init__(self, reference):
        self.reference = reference

    def of(self, study, name):
        """Returns a table of a study, made from its rows."""
        return by_key(csv.DictReader(io.StringIO(as_csv(energy_tables(self.reference / study)[name]))))

    def of_reason(self, name, make):
        """A table that is made from the results of an ablation, which has no table in the reference."""
        return by_key(csv.DictReader(io.StringIO(as_csv(make(read_results(self.reference / "reasons" / name))))))

    def gains(self, study):
        """(solution, elements, degree, method) -> record of a collection's table of gains, as printed."""
        rows = read_rows(self.reference / study / "tables" / "table_energy_gains.csv").records()
        return {tuple(row[name] for name in ("Solution", "Elements", "d", "Method")): row for row in rows}

    def payoffs(self, study):
        """What the methods of a collection cost and gain, GETMe's left out."""
        return payoffs_of(self.reference / study)


def blocks(reference):
    """The blocks of the appendix."""
    tables = Tables(reference)
    return {"pays": pays(tables), "variants": variants(tables), "robust": robust(tables), "domains": domains(tables),
            "orders": orders(tables), "graded": graded(), "corners": corners(tables), "space": space(tables), "many": many(tables),
            "gradient": gradient(reference)}


def pays(tables):
    """Counts the cases in which a method has an error that no alternative has in the same time."""
    rows = []
    for study in STUDIES:
        cells = []
        for degree in "12":
            chosen = [row for (_, d, _), row in tables.of(study, "table_energy_alternatives").items() if d == degree]
            gains = [float(row["Gain"]) for row in chosen if row["Gain"] not in ("", MISSING)]
            cells += [f"{sum(row['Verdict'] == 'pays' for row in chosen)} of {len(chosen)}" if chosen else MISSING,
                      f"{max(gains):.2f}" if gains else MISSING]
        rows.append((f"`{study}`", *cells))
    return table(("study", "degree 1", "largest gain", "degree 2", "largest gain"), rows, "lrrrr")


def variants(tables):
    """Factors on the unit square after 20 solves, degree 1; and that the recovery beats the residual at degree 2."""
    studies = ("front", "layer")
    main = {study: tables.of(f"energy-{study}", "table_energy") for study in studies}
    other = {study: tables.of(f"energy-{study}-variants", "table_energy") for study in studies}
    rows = [(name, *(main[study][f"{mesh}{kind}", "1", method][AFTER] for mesh in ("Tri", "Quad") for study in studies))
            for name, (method, kind) in ROWS.items()]
    rows += [(name, *(other[study][mesh, "1", method][AFTER] for mesh in ("Tri", "Quad") for study in studies))
             for name, method in VARIANTS.items()]
    quadratic = [(name, *(other[study][mesh, "2", method][AFTER] for mesh in ("Tri", "Quad") for study in studies))
                 for name, method in (("`indicator-weighted`", "Weights"),
                                      ("`indicator-weighted`, residual of degree 2", "Weights by the residual of degree 2"))]
    heading = ("method", "tri, front", "tri, layer", "quad, front", "quad, layer")
    return (table(heading, rows, "lrrrr") + "\n\nThe same at degree 2:\n\n" + table(heading, quadratic, "lrrrr"))


def robust(tables):
    """Smallest factors of any of the meshes of energy-robust."""
    rows = tables.gains("energy-robust")
    cases = list(dict.fromkeys((elements, method) for _, elements, _, method in rows))
    cells = [(elements, method, *(rows[solution, elements, d, method]["H1 least"] for solution in ("front", "layer", "peak") for d in "12"))
             for elements, method in cases]
    return (counted(rows) + "\n\n" + table(("elements", "method", "front, 1", "front, 2", "layer, 1", "layer, 2", "peak, 1", "peak, 2"),
                                           cells, "llrrrrrr"))


def counted(rows):
    """A sentence on members and invalid cells of a table of gains."""
    members = sorted({int(row["Members"]) for row in rows.values()})
    invalid = sum(int(row["With invalid cells"]) for row in rows.values())
    size = str(members[0]) if len(members) == 1 else f"{members[0]} to {members[-1]}"
    return f"Meshes for each row: {size}. Results with invalid cells: {invalid}."


def domains(tables):
    """Medians and smallest factors of energy-field at degree 1, and what they cost."""
    rows = tables.gains("energy-field")
    cases = list(dict.fromkeys((method, elements) for _, elements, _, method in rows))
    cells = [(method, elements, *(f"{rows[solution, elements, '1', method]['H1 median']} ({rows[solution, elements, '1', method]['H1 least']})"
                                  for solution in ("front", "layer", "peak"))) for method, elements in cases]
    folder = tables.reference / "energy-field"
    summary = read_rows(folder / "summary.csv").records()
    getme = {row["member"]: float(row["h1_error"]) for row in summary if row["method"] == "getme"}
    factors = [(getme[row["member"]] / float(row["h1_error"]), row["elements"], row["domain"], row["solution"], row["method"])
               for row in summary if row["method"] not in ("initial", "getme")]
    equal = sorted({case[1:] for case in factors if case[0] == 1})
    planar = sorted({min(case for case in factors if case[1] == elements)[2] for elements in ("triangles", "quadrilaterals")})
    nodes = sorted(int(row["n_nodes"]) for row in read_rows(folder / "members.csv").records())
    times = sorted(entry.time for entry in tables.payoffs("energy-field")[0])
    return "\n".join((
        f"{len(nodes)} meshes of {nodes[0]} to {nodes[-1]:,} nodes. {counted(rows)}", "",
        table(("method", "elements", "front", "layer", "peak"), cells, "llrrr"), "",
        f"- Results with a larger H1 error than GETMe's: {sum(case[0] < 1 for case in factors)} of {len(factors)}. Cases with the same "
        f"error: {'; '.join(', '.join(case) for case in equal)}.",
        f"- In the plane the smallest factors are those of the domain {' and '.join(planar)}.",
        f"- 20 solves and the work between them take {times[0]:.0f} to {times[-1]:.0f} times as long as one solution on the initial mesh.",
        f"- {at_equal_time(tables, 'energy-field')}"))


def at_equal_time(tables, study):
    """Sentences on the error at equal time of the methods that move nodes by the solution."""
    found, titles = tables.payoffs(study)
    said = []
    for method in dict.fromkeys(entry.method for entry in found):
        entries = [entry for entry in found if entry.method == method]
        highs = [entry.at_equal_time_interval[1] for entry in entries]
        sure = f"{sum(high < 1 for high in highs)} with the whole interval" if np.isfinite(highs).any() else "one domain each, so no intervals"
        said.append(f"{titles[method]} {sum(entry.at_equal_time < 1 for entry in entries)} of {len(entries)} ({sure})")
    return ("Kinds of meshes (type of elements, degree, level of distortion) with a lower error than unsmoothed meshes at equal time, smoothing "
            f"included: {'; '.join(said)}.")


def order_rows(found, cases, methods):
    """Rows of orders in H1: cases is a list of (mesh, degree)."""
    return [(method, *(found[mesh, d, method]["Order of H1"] if (mesh, d, method) in found else MISSING for mesh, d in cases))
            for method in methods]


def orders(tables):
    """Orders in H1 at re-entrant corners."""
    parts = []
    for study, meshes in (("energy-l-shape", ("Tri", "Quad")), ("energy-fichera", ("Tet", "Hex"))):
        found = tables.of(study, "table_energy_orders")
        cases = [(mesh, d) for d in "12" for mesh in meshes]
        methods = [method for method in ("GETMe", *FIXED, *SLIDING) if any((*case, method) in found for case in cases)]
        parts += [f"`{study}`:", "", table(("method", *(f"{mesh}, degree {d}" for mesh, d in cases)),
                                           order_rows(found, cases, methods), "l" + "r" * len(cases)), ""]
    for name, meshes in (("l-shape-solves", ("Tri", "Quad")), ("l-shape-weights", ("Tri", "Quad")), ("fichera-solves", ("Tet",))):
        found = tables.of_reason(name, orders_table)
        cases = [(mesh, d) for d in "12" for mesh in meshes if any(key[:2] == (mesh, d) for key in found)]
        methods = list(dict.fromkeys(method for _, _, method in found))
        parts += [f"`reasons/{name}`:", "", table(("method", *(f"{mesh}, degree {d}" for mesh, d in cases)),
                                                  order_rows(found, cases, methods), "l" + "r" * len(cases)), ""]
    return "\n".join(parts)


def graded():
    """Orders on graded meshes (docs/explanation/graded-corner.csv, which a test of the Python module computes)."""
    rows = read_rows(data_folder() / "docs" / "explanation" / "graded-corner.csv").records()
    return table(("domain", "elements", "degree", "b", "order in H1"),
                 [(row["domain"], row["elements"], row["degree"], row["b"], row["order"]) for row in rows], "llrrr")


def corners(tables):
    """Smallest factors of sliding weights on many meshes with corners."""
    rows = tables.gains("energy-corners")
    cells = [(d, *(rows["", elements, d, "Weights, sliding"]["H1 least"] for elements in ELEMENTS)) for d in "12"]
    least = min(float(row["H1 least"]) for row in rows.values())
    return (f"{counted(rows)} Smallest factor of any method: {least:.2f}.\n\n" + table(("degree", *ELEMENTS), cells, "rrrrr")
            + f"\n\n{at_equal_time(tables, 'energy-corners')}")


def space(tables):
    """Factors on fronts in space and in the plane, and on layers in space."""
    def found(rows, meshes, d, method):
        return [rows[f"{mesh}{finer}", d, method][AFTER] for mesh in meshes for finer in ("", ", refined")]
    front, layer = (tables.of(f"energy-{study}-volume", "table_energy") for study in ("front", "layer"))
    flat = tables.of_reason("front-in-plane", factor_table)
    cases = [(method, "1") for method in ("Weights", "Weights, sliding", "Descent", "Moving mesh and descent",
                                          "Moving mesh and descent, sliding")] + [(method, "2") for method in SLIDING]
    fronts = [(method, d, *found(front, ("Tet", "Hex"), d, method), *found(flat, ("Tri", "Quad"), d, method)) for method, d in cases]
    layers = [(method, d, *found(layer, ("Tet", "Hex"), d, method)) for method, d in cases]
    largest = max(float(plane) / float(solid) for row in fronts for solid, plane in zip(row[2:6], row[6:]))
    solid = ("tetrahedra", "finer", "hexahedra", "finer")
    return (table(("front", "degree", *solid, "triangles", "finer", "quadrilaterals", "finer"), fronts, "lrrrrrrrrr")
            + f"\n\nA factor in the plane over the factor in space is at most {largest:.2f}.\n\n"
            + table(("layer", "degree", *solid), layers, "lrrrrr"))


def many(tables):
    """One mesh for n solutions."""
    rows = tables.of("energy-many", "table_energy_many")
    error, times, refined = "H1 error over GETMe's here", "Times until it pays", "H1 error over GETMe's refined"
    others = "H1 error over GETMe's of the others"
    columns = [(mesh, d) for mesh in ("Tri", "Quad") for d in "12"]
    heading = ("n", *(f"{mesh.lower()}, degree {d}" for mesh, d in columns))

    def cells(column):
        return [(n, *(rows[mesh, d, f"Moving mesh and descent for {n}"][column] or MISSING for mesh, d in columns)) for n in "1248"]
    paying = sum(row["Verdict"] != "does not pay" for row in rows.values())
    fine = [sorted({f"{float(row[refined]):.2f}" for (_, d, _), row in rows.items() if d == degree}) for degree in "12"]
    return "\n".join((
        "True H1 error over that on GETMe's mesh, geometric mean over the n solutions:", "", table(heading, cells(error), "lrrrr"), "",
        "The same for the solutions that the mesh is not made for:", "", table(heading, cells(others), "lrrrr"), "",
        "How many times all n have to be solved on the mesh until it pays compared with GETMe's refined mesh:", "",
        table(heading, cells(times), "lrrrr"), "",
        f"GETMe's refined mesh has {', '.join(fine[0])} of the error at degree 1 and {', '.join(fine[1])} at degree 2. "
        f"Meshes that pay at once: {paying} of {len(rows)}."))


def gradient(reference):
    """Time of the energy's gradient as a share of its solve."""
    printed = (reference / "speed.md").read_text(encoding="utf-8")
    ratios = re.findall(r"^\| (tetrahedron|hexahedron) \| (\d) \|.* ([0-9.]+) \|$", printed, re.MULTILINE)
    if not ratios:
        raise ResultsError(f"{reference / 'speed.md'}: the table of the energy's gradient is missing.")
    return table(("cells", "degree", "time of the gradient, % of the solve"),
                 [(cell, degree, f"{100 * float(ratio):.1f}") for cell, degree, ratio in ratios], "lrr")
