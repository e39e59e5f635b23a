# SPDX-License-Identifier: GPL-3.0-or-later
"""A tiny invented results folder of a polygon study. No result of any study."""

import json
from pathlib import Path

import numpy as np

from plots.results.polygons import REQUIRED_COLUMNS
from plots.tests.synthetic_results import write_csv


def polygon_rows(n, turns=1, size=1.0, **keys):
    """Rows of a regular polygon."""
    angles = 2 * np.pi * turns * np.arange(n) / n
    return [{**keys, "n": n, "node": m, "x": size * np.cos(a), "y": size * np.sin(a)}
            for m, a in enumerate(angles)]


def domain_rows(n):
    """A grid whose lower right half is D_1, and the line between."""
    centres = (np.arange(6) + 0.5) / 6
    rows = [{"n": n, "line": "", "theta": 1.5 * t, "lambda": lam, "convergence": 0.5,
             "domain": "D_1" if lam < t else "D_0"} for t in centres for lam in centres]
    return rows + [{"n": n, "line": line, "theta": 1.5 * t, "lambda": t, "convergence": 1.0,
                    "domain": "S_0"} for line in (1, 2) for t in centres]


def theorem_row(name, holds="true"):
    """A statement with a character of Markdown and one of LaTeX."""
    return {"theorem": name, "statement": "x_1 | y & z", "quantity": "q", "cases": 3, "measured": 1.25,
            "expected": 1.0, "max_deviation": 0.25, "tolerance": 1e-8, "holds": holds}


def write_polygon_results(folder):
    """A complete folder: one theorem does not hold, one pair of parameters disagrees."""
    folder = Path(folder)
    folder.mkdir(parents=True)
    rows = {
        "theorems": [theorem_row("Theorem 1"), theorem_row("Theorem 1", "false"),
                     theorem_row("Napoleon")],
        "classification": [
            {"n": n, "theta": 0.5, "lambda": 0.5, "predicted": predicted, "iterated": "D_1",
             "agree": str(predicted == "D_1").lower()} for n in (3, 4)
            for predicted in ("D_1", "D_1", "S_0")[:n - 1]],
        "decomposition": [row for n in (5, 6) for k in ["", *range(n)]
                          for row in polygon_rows(n, k or 0, eigenpolygon=k)],
        "domains": domain_rows(5) + domain_rows(6),
        "limits": [row for n in (10, 11) for theta, domain in ((0, ""), (0.1, "D_0"), (0.3, "D_1"),
                                                               (0.4712, "S_1"), (1.5, "D_5"))
                   for row in polygon_rows(n, 1, float(domain != "D_0"), theta=theta, domain=domain,
                                           steps=4000)],
        "sequences": [row for transformation in ("isosceles", "combined") for theta in (0.3, np.pi / 4)
                      for step in (0, 1, 100)
                      for row in polygon_rows(6, transformation=transformation, theta=theta,
                                              domain="D_1", step=step, **{"lambda": 0.5})],
        "side_ratios": [{"transformation": name, "theta": theta, "step": step,
                         "defect": 0.5 * theta ** step, "bound": 0.6 * theta ** step}
                        for name in ("equilateral", "right-isosceles") for theta in (0.0, 0.5)
                        for step in range(31)],
    }
    for name, columns in REQUIRED_COLUMNS.items():
        write_csv(folder / f"{name}.csv", columns, rows[name])
    (folder / "provenance.json").write_text(json.dumps({
        "study": "polygons", "study_title": "Polygons", "parameters": {"kind": "polygons"}}))
    return folder
