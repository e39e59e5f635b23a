# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of the page on curved elements: the studies `curved`, `curved-angles` and `curved-straight`."""

from collections import Counter

import numpy as np

from ..collections.problems import AS_GENERATED
from ..results.data_folder import data_folder
from ..results.rows import entries, read_rows
from ..results.smoothing import read_provenance
from .blocks import table
from .reference import geometric_mean, spread, tables_of

CURVED, ANGLES, STRAIGHT = "curved", "curved-angles", "curved-straight"
ERRORS = {"h1_error": "H1", "l2_error": "L2"}
WHOLE = {"curved-optimization": "`curved-optimization`", "angles-alone": "By angles alone, it"}  # move midside nodes, too
LEAST_CHANGE = 0.01  # of a ratio from 1, by the criteria of the page


def blocks(reference):
    """The blocks of the page."""
    found = {study: errors_of(reference / study) for study in (CURVED, STRAIGHT)}
    for mesh, errors in errors_of(reference / ANGLES).items():
        found[CURVED].setdefault(mesh, {}).update(errors)
    titles = {method["name"]: method["title"] for study in (CURVED, ANGLES)
              for method in entries(read_provenance(reference / study / "provenance.json"), "methods")}
    return {"answer": answer(found), "counts": counts(found[CURVED], titles), "methods": methods(found[CURVED], titles), "edges": edges(found),
            "orders": orders(reference), "straightened": straightened()}


def answer(found):
    """The findings in short."""
    lines = [f"- {sentence}" for level, meshes in ((AS_GENERATED, "as generated"), ("0.6", "distorted to 0.6"))
             for sentence in of_level(found[CURVED], level, meshes)]
    pairs = [(found[STRAIGHT][mesh], of_curved) for mesh, of_curved in found[CURVED].items() if mesh in found[STRAIGHT]]
    for method, when in (("initial", "before smoothing"), ("getme", "after GETMe")):
        factors = {error: [straight[method, error] / curved[method, error] for straight, curved in pairs
                           if (method, error) in straight and (method, error) in curved] for error in ERRORS}
        lines.append(f"- Straight edges, {when}: the error in H1 is {spread(factors['h1_error'], '.1f')} times, that in L2 "
                     f"{spread(factors['l2_error'], '.0f')} times the one with curved edges ({len(factors['h1_error'])} meshes).")
    return "\n".join(lines)


def of_level(found, level, meshes):
    """Sentences on what the methods that move corners leave of the errors on the meshes of a level; then on the one that moves all nodes."""
    for error, title in ERRORS.items():
        of_methods = {}
        for mesh, of_mesh in found.items():
            for method in {method for method, _ in of_mesh} - {"initial"} if mesh[2] == level else ():
                of_methods.setdefault(method, []).append(ratios(of_mesh, method, error))
        means = {method: geometric_mean(values) for method, values in of_methods.items()}
        harms = {method: sum(kind(value) == "harms" for value in values) for method, values in of_methods.items()}
        corners = [method for method in of_methods if method not in WHOLE]
        yield (f"Meshes {meshes}, error in {title}: methods that move corners leave {spread([means[m] for m in corners])} of it in the geometric mean. "
               f"They raise it by more than 1 % on {spread([harms[m] for m in corners], 'd')} of {max(map(len, of_methods.values()))} meshes. "
               + " ".join(f"{subject} leaves {means[method]:.2f}, and raises it on {harms[method]}." for method, subject in WHOLE.items()))


def straightened():
    """Errors of curved-optimization's meshes with the inner edges straightened (docs/explanation/curved-straightened.csv)."""
    rows = [(row["domain"], row["elements"], *(f"{float(row[name]) / float(row['initial']):.3f}" for name in ("global", "curved", "straightened")))
            for row in read_rows(data_folder() / "docs" / "explanation" / "curved-straightened.csv").records()]
    return table(("domain", "elements", "Global Optimization", "Curved Optimization, angles alone", "the same, inner edges straight"), rows, "llrrr")


def errors_of(folder):
    """{(domain, elements, level, size): {(method, error): value}} of the valid results of a study."""
    found = {}
    for row in read_rows(folder / "summary.csv").records():
        if row["status"] == "ok" and row["n_invalid"] == "0":
            mesh = row["domain"], row["elements"], row["distortion"] or AS_GENERATED, float(row["size"])
            for error in ERRORS:
                found.setdefault(mesh, {})[row["method"], error] = float(row[error])
    return found


def ratios(of_mesh, method, error):
    """Error after over before smoothing; NaN without a valid result."""
    return of_mesh.get((method, error), np.nan) / of_mesh.get(("initial", error), np.nan)


def counts(found, titles):
    """How often each method helps and harms on curved cells."""
    rows = []
    for level in (AS_GENERATED, "0.6"):
        meshes = [of_mesh for mesh, of_mesh in found.items() if mesh[2] == level]
        for method, name in titles.items():
            for error, title in ERRORS.items():
                kinds = Counter(kind(ratios(of_mesh, method, error)) for of_mesh in meshes)
                rows.append((level, name, title, len(meshes), kinds["helps"], kinds["same"], kinds["harms"], kinds["none"],
                             "yes" if kinds["helps"] > len(meshes) / 2 and not kinds["harms"] else "no"))
    return table(("level", "method", "error", "meshes", "helps", "about the same", "harms", "no result", "pays"), rows, "lllrrrrrl")


def kind(ratio):
    """What a ratio means by the criteria."""
    if np.isnan(ratio):
        return "none"
    return "helps" if ratio < 1 - LEAST_CHANGE else "harms" if ratio > 1 + LEAST_CHANGE else "same"


def methods(found, titles):
    """The part of the H1 error that each method leaves, as a geometric mean over the sizes."""
    cases = sorted({mesh[:3] for mesh in found}, key=lambda case: (case[2] != AS_GENERATED, *case))
    rows = []
    for case in cases:
        of_sizes = [of_mesh for mesh, of_mesh in found.items() if mesh[:3] == case]
        rows.append((case[2], case[0], case[1], len(of_sizes),
                     *(f"{geometric_mean([ratios(of_mesh, method, 'h1_error') for of_mesh in of_sizes]):.3f}" for method in titles)))
    return table(("level", "domain", "elements", "sizes", *titles.values()), rows, "lllr" + "r" * len(titles))


def edges(found):
    """Errors with straight over those with curved edges at the finest size, before and after GETMe."""
    rows = []
    for mesh in sorted(found[CURVED], key=lambda mesh: (mesh[2] != AS_GENERATED, *mesh)):
        if mesh[3] > min(other[3] for other in found[CURVED] if other[:3] == mesh[:3]) or mesh not in found[STRAIGHT]:
            continue
        curved, straight = (found[study][mesh] for study in (CURVED, STRAIGHT))
        rows.append((mesh[2], mesh[0], mesh[1], *(f"{straight[method, error] / curved[method, error]:.2f}"
                                                if (method, error) in straight and (method, error) in curved else "–"
                                                for method in ("initial", "getme") for error in ERRORS)))
    return table(("level", "domain", "elements", *(f"{title}, {when}" for when in ("initial", "GETMe") for title in ERRORS.values())),
                 rows, "lllrrrr")


def orders(reference):
    """The orders of the errors with curved and straight edges, of the initial meshes and of GETMe's."""
    of_study = {study: {(row["Level"], row["Family"], row["Elements"], row["Method"]): row
                        for row in tables_of(reference, study, "table_orders")} for study in (CURVED, STRAIGHT)}
    rows = []
    for case in sorted(of_study[CURVED], key=lambda case: (case[0] != AS_GENERATED, *case[:3], case[3] != "Initial")):
        if case[3] in ("Initial", "GETMe") and case in of_study[STRAIGHT]:
            rows.append((*case, *(of_study[study][case][f"Order of {title}"] for study in (CURVED, STRAIGHT) for title in ("L2", "H1"))))
    return table(("level", "domain", "elements", "mesh", "curved, L2", "curved, H1", "straight, L2", "straight, H1"), rows, "llllrrrr")
