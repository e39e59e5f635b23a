# SPDX-License-Identifier: GPL-3.0-or-later
"""What smoothing does to published meshes: blocks of the short answer."""

import numpy as np

from ..collections.problems import WORSE
from .blocks import table
from .reference import REFERENCE_METHOD, SOLVER, geometric_mean, pairs_of, spread, tables_of, with_interval

SETS = {"collection-mesquite": "Mesquite", "collection-sfepy": "SfePy", "collection-hexalab": "HexaLab"}
FEWEST_FAMILIES = 3  # of an interval that says something
LOWEST = 3  # published hexahedral meshes in a table
BAD = 0.6  # mean quality of the less distorted meshes of the studies


def practice(reference):
    """What smoothing does to published meshes."""
    lines = []
    for study, name in SETS.items():
        if not (reference / study).is_dir():
            continue
        gains = {(row["Elements"], row["d"]): row for row in tables_of(reference, study, "table_smoothing")
                 if row["Method"] == REFERENCE_METHOD and row["Level"] == "as generated"}
        initial, _ = pairs_of(reference, study)
        for elements in dict.fromkeys(key[0] for key in gains):
            both = [gains.get((elements, degree)) for degree in "12"]
            chosen = initial.select(elements=elements)
            lines.append((name, elements, both[0]["Families"], *(spread(chosen.number(column)) for column in ("q_mean", "q_min")), *(of_families(row) if row else "" for row in both),
                          *(f"{row['Worse (%)']} %" if row else "" for row in both)))
    return ("H1 error after over before smoothing by GETMe simultaneous, on published meshes as they are, and on tangled ones after "
            "untangling (`table_smoothing` of each set; [the sets](../how-to/many-meshes.md#published-meshes)). A family is a model or a domain; "
            "intervals are given for three families or more. Worse: share of problems whose error rises by more than 1 %.\n\n"
            + table(("set", "elements", "families", "q_mean before", "q_min before", "degree 1", "degree 2", "worse, degree 1", "degree 2"),
                    lines, "llrrrrrrr") + "\n\n" + bad_published(reference))


def of_families(row):
    """The mean ratio, with its interval if there are three families or more."""
    return with_interval(row, "Error / initial") if int(row["Families"]) >= FEWEST_FAMILIES else f"{float(row['Error / initial']):.2f}"


def published(reference):
    """The published meshes, lowest minimum first: (set, elements, mesh, q_min and q_mean before, q_min after, ratios of error and
    iterations at degrees 1 and 2)."""
    found = []
    for study, name in SETS.items():
        initial, after = pairs_of(reference, study)
        meshes = np.array([member.rsplit(".", 1)[0] for member in initial.text("member")])
        for mesh in dict.fromkeys(meshes):
            here = meshes == mesh
            ratios = [geometric_mean((after.number(column) / initial.number(column))[here & (initial.text("degree") == degree)])
                      for degree in "12" for column in ("h1_error", SOLVER)]
            found.append((name, initial.text("elements")[here][0], mesh, *(initial.number(column)[here][0] for column in ("q_min", "q_mean")),
                          after.number("q_min")[here][0], ratios))
    return sorted(found, key=lambda row: row[3])


def bad_published(reference):
    """What smoothing does to the published meshes of low mean quality, as a sentence."""
    ratios = [ratios[0] for _, _, _, _, mean, _, ratios in published(reference) if mean <= BAD]
    return (f"{len(ratios)} of these meshes have a q_mean of {BAD} or less before smoothing. Their H1 error at degree 1 becomes {spread(ratios)} of that "
            f"before. It falls by more than 1 % on {sum(ratio < 2 - WORSE for ratio in ratios)} of them, and rises by more than 1 % on "
            f"{sum(ratio > WORSE for ratio in ratios)}.")


def published_hexahedra(reference, limit):
    """What smoothing does to the published hexahedral meshes with the lowest minimum."""
    found = [row for row in published(reference) if row[1] == "hexahedra"]
    gains = [row for row in tables_of(reference, "collection-hexalab", "table_smoothing") if row["Method"] == REFERENCE_METHOD]
    below = sum(row[3] < limit for row in found)
    lines = [(name, f"`{mesh}`", *(f"{quality:.2f}" for quality in qualities), *(f"{ratio:.2f}" for ratio in ratios))
             for name, _, mesh, *qualities, ratios in found[:LOWEST]]
    return (f"The table has no hexahedra. Of {len(found)} published hexahedral meshes {below} {'has' if below == 1 else 'have'} a q_min below the "
            "limit. The H1 errors of HexaLab's meshes, after over before smoothing, are "
            f"{' and '.join(with_interval(row, 'Error / initial') for row in gains)} at degrees 1 and 2. The {LOWEST} published hexahedral meshes with "
            "the lowest q_min (geometric means over their problems):\n\n"
            + table(("set", "mesh", "q_min", "q_mean", "q_min after", "H1 error, degree 1", "CG iterations with Jacobi", "degree 2", "iterations"),
                    lines, "llrrrrrrr"))
