# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of the short answer: what smoothing does to the solution, from the studies field, gear, volume and energy-field."""

import numpy as np

from ..results.rows import read_rows
from .blocks import table

METHOD = "getme-simultaneous"  # the method that the answer is about
LEVELS = {"": "as generated", "0.6": "distorted to q_mean 0.6", "0.45": "distorted to q_mean 0.45"}
PERCENT = 100


def geometric_mean(values):
    """The geometric mean of positive numbers."""
    return float(np.exp(np.mean(np.log(values))))


class Field:
    """Results of the study field: initial meshes and the methods' results, aligned by problem (member and degree)."""

    def __init__(self, reference):
        rows = read_rows(reference / "field" / "summary.csv", ("member", "degree", "method", "h1_error"))
        self.rows = {method: rows.select(method=method) for method in dict.fromkeys(rows.text("method"))}
        self.initial = self.rows["initial"]
        keys = list(zip(self.initial.text("member"), self.initial.text("degree")))
        for method, those in self.rows.items():
            assert list(zip(those.text("member"), those.text("degree"))) == keys, method
        members = read_rows(reference / "field" / "members.csv")
        self.n_meshes = len(set(self.initial.text("mesh")))
        self.n_members = len(members)
        nodes = members.number("n_nodes")
        self.nodes = int(nodes.min()), int(nodes.max())
        self.n_domains = len(set(members.text("domain")))

    def ratio(self, column, level=None, degree=None, method=METHOD):
        """After over before smoothing, of the problems of a level of distortion and a degree."""
        chosen = np.ones(len(self.initial), dtype=bool)
        if level is not None:
            chosen &= self.initial.text("distortion") == level
        if degree is not None:
            chosen &= self.initial.text("degree") == degree
        return (self.rows[method].number(column) / self.initial.number(column))[chosen]

    def n_of_level(self, level):
        """Number of meshes with a level of distortion."""
        return len(set(self.initial.where(self.initial.text("distortion") == level).text("mesh")))

    def invalid(self, method):
        """Mask of the problems where a method leaves invalid cells."""
        return self.rows[method].number("n_invalid") > 0

    def spread(self):
        """Largest over smallest H1 error of the methods that never leave invalid cells, less 1, and how many these are."""
        valid = [method for method in self.rows if method != "initial" and not self.invalid(method).any()]
        errors = np.array([self.rows[method].number("h1_error") for method in valid])
        return errors.max(axis=0) / errors.min(axis=0) - 1, len(valid)


def in_short(field):
    """The paragraph of README.md."""
    bad, good = ([geometric_mean(field.ratio("h1_error", level, degree)) for degree in "12"] for level in ("0.45", ""))
    spread, n_valid = field.spread()
    return (f"""Smoothing repairs bad meshes and does little for good ones. We solved Poisson problems on {field.n_meshes} meshes of
{field.nodes[0]} to {field.nodes[1]:,} nodes, with GETMe simultaneous:

- On {field.n_of_level("0.45")} randomly distorted meshes (mean quality 0.45) the H1 error fell to {bad[0]:.2f} of its initial value with linear
  elements, and to {bad[1]:.2f} with quadratic elements (geometric means).
- On {field.n_of_level("")} meshes as the generators made them it fell to {good[0]:.2f} and {good[1]:.2f}.
- The choice of the method matters little: the {n_valid} methods that keep meshes valid end within {PERCENT * np.median(spread):.1f} % of each other
  (median).
""")


def blocks(field, reference):
    """The blocks of the answer page."""
    return {"levels": levels(field), "good": good_meshes(field), "bad": bad_meshes(reference),
            "methods": methods(field, reference), "minimum": minimum(reference), "cost": cost(reference),
            "moving": moving(reference)}


def levels(field):
    """Errors and iterations after over before, by level of distortion."""
    rows = []
    for level, name in LEVELS.items():
        errors = [field.ratio("h1_error", level, degree) for degree in "12"]
        iterations = [field.ratio("cg_iterations", level, degree) for degree in "12"]
        assert not any(np.isnan(one).any() for one in (*errors, *iterations))
        rows.append((name, len(errors[0]), *(f"{geometric_mean(one):.2f}" for one in (*errors, *iterations))))
    return (f"{field.n_members} problems per degree on {field.n_meshes} meshes of {field.nodes[0]} to {field.nodes[1]:,} nodes "
            f"(`results/reference/field/summary.csv`). The numbers are after over before smoothing by GETMe simultaneous, as "
            "geometric means.\n\n"
            + table(("initial mesh", "problems per degree", "H1 error, degree 1", "degree 2", "CG iterations, degree 1", "degree 2"),
                    rows, "lrrrrr"))


def good_meshes(field):
    """Reports how often smoothing of a generated mesh gains next to nothing."""
    one, two = (field.ratio("h1_error", "", degree) for degree in "12")
    return (f"On {PERCENT * np.mean(one > 0.98):.0f} % of the meshes as generated, the H1 error falls by less than 2 % (degree 1). On "
            f"{PERCENT * np.mean(one > 1.001):.0f} % of them it rises by more than 0.1 % (degree 2: {PERCENT * np.mean(two > 1.001):.0f} %).")


def of_study(reference, study):
    """(mesh, degree, method) -> record of a summary."""
    return {(row["mesh"], row["degree"], row["method"]): row
            for row in read_rows(reference / study / "summary.csv").records()}


def factor(rows, mesh, degree, column, over="getme", under="initial"):
    """The number of one method's mesh over that of another."""
    return float(rows[mesh, degree, under][column]) / float(rows[mesh, degree, over][column])


def bad_meshes(reference):
    """Factors on the published gears and on the flange: true errors, interpolated ones, iterations."""
    gear, volume = of_study(reference, "gear"), of_study(reference, "volume")
    rows = []
    for name, study, mesh in (("gear, triangles", gear, "tri"), ("gear, quadrilaterals", gear, "quad"),
                              ("flange, tetrahedra", volume, "tet"), ("flange, hexahedra", volume, "hex")):
        quality = float(study[mesh, "1", "initial"]["q_mean"])
        for degree in "12":
            rows.append((name, f"{quality:.2f}", degree, *(f"{factor(study, mesh, degree, column):.1f}" for column in (
                "h1_error", "e_h1", "cg_iterations", "jacobi_cg_iterations"))))
    return ("Initial over GETMe (`results/reference/gear`, published meshes; `results/reference/volume`, stand-in meshes):\n\n"
            + table(("mesh", "q_mean before", "degree", "true H1 error", "e_H1 of the thesis", "CG iterations", "with Jacobi"),
                    rows, "lrrrrrr"))


def methods(field, reference):
    """Reports how much the methods differ."""
    spread, n_valid = field.spread()
    gear = of_study(reference, "gear")
    worst = max((1 / factor(gear, mesh, degree, "h1_error", "smart-laplace", "getme"), mesh, degree)
                for mesh in ("tri", "quad") for degree in "12")
    where = {"tri": "triangles", "quad": "quadrilaterals"}[worst[1]]
    laplace, weighted = field.invalid("laplace"), field.invalid("weighted-laplace")
    tetrahedra = field.initial.text("elements") == "tetrahedra"
    assert weighted[tetrahedra].all() and not weighted[~tetrahedra].any()
    counts = [int(gear["tri", "1", method]["cg_iterations"]) for method in ("smart-laplace", "getme")]
    lowest = {(mesh, degree): min((float(row["h1_error"]), method) for (m, d, method), row in gear.items()
                                  if (m, d) == (mesh, degree))[1] for mesh in ("tri", "quad") for degree in "12"}
    assert set(lowest.values()) == {"weighted-laplace"}
    return (f"The {n_valid} methods that keep meshes valid end within {PERCENT * np.median(spread):.1f} % of each other (median; largest "
            f"over smallest true H1 error, `field`). Smart Laplace keeps bad clusters of cells: up to {worst[0]:.1f} times GETMe's error "
            f"(gear, {where}, degree {worst[2]}), and {counts[0]:,} CG iterations in place of {counts[1]:,} (gear, triangles, degree 1). "
            f"Plain Laplace leaves invalid cells in {PERCENT * laplace.mean():.0f} % of the problems, weighted Laplace in "
            f"{PERCENT * weighted.mean():.0f} % (all problems on tetrahedra, and no others). On the published gears weighted Laplace has "
            "the smallest true H1 error of all methods.")


def minimum(reference):
    """The lowest quality and the error: smart Laplace's triangles of the gear."""
    gear = of_study(reference, "gear")
    smart, getme = gear["tri", "1", "smart-laplace"], gear["tri", "1", "getme"]
    higher = sorted(PERCENT * (factor(gear, "tri", degree, "h1_error", "getme", "smart-laplace") - 1) for degree in "12")
    condition = sorted(factor(gear, "tri", degree, "condition_number", "getme", "smart-laplace") for degree in "12")
    return (f"Smart Laplace's triangles of the gear keep q_min {float(smart['q_min']):.0e}. Their true H1 error is {higher[0]:.0f} to "
            f"{higher[1]:.0f} % above that of GETMe's (q_min {float(getme['q_min']):.2f}), and their condition number is "
            f"{condition[0]:,.0f} to {condition[1]:,.0f} times as high.")


def cost(reference):
    """Time in all, by domain."""
    rows = read_rows(reference / "field" / "tables" / "table_payoff.csv").records()

    def times(instead, degree, column="Time / initial"):
        found = sorted(float(row[column]) for row in rows if (row["Instead"], row["d"]) == (instead, degree))
        return f"{found[0]:.2g} to {found[-1]:.2g}"
    smoothed = [times("GETMe simultaneous", degree) for degree in "12"]
    error = "Error / initial"
    split, next_degree = ("unsmoothed, cells split", "1"), ("unsmoothed, degree d + 1", "1")
    return (f"Smoothing and solving take {smoothed[0]} times as long as one solution on the unsmoothed mesh at degree 1, and {smoothed[1]} "
            f"times at degree 2, where the solver gains more than smoothing costs (GETMe simultaneous, by domain). Splitting every cell "
            f"leaves {times(*split, error)} of the error for {times(*split)} times the time. The next degree leaves "
            f"{times(*next_degree, error)} of the error for {times(*next_degree)} times the time "
            "(`results/reference/field/tables/table_payoff.csv`).")


def moving(reference):
    """Gains of solution-adaptive methods at degree 1."""
    rows = read_rows(reference / "energy-field" / "tables" / "table_energy_gains.csv").records()
    medians = sorted(float(row["H1 median"]) for row in rows if row["d"] == "1")
    return (f"Solution-adaptive methods lower the true H1 error further than GETMe: {medians[0]:.1f} to {medians[-1]:.1f} times (medians, "
            "linear elements, solutions with fronts, layers and peaks, `results/reference/energy-field`).")
