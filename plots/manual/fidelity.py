# SPDX-License-Identifier: GPL-3.0-or-later
"""Agreement with the thesis: claims by kind of mesh and by cause (studies/thesis/causes.csv), and the tables of the
published gears."""

from ..claims.agreement import agreement
from ..claims.check import FAILS, HOLDS
from ..claims.overview import studies
from ..results.data_folder import thesis_folder
from ..results.rows import ResultsError, entries, read_rows
from ..results.smoothing import read_provenance
from .blocks import table

CAUSES = {"optimizer": "another or faster global optimization than Mesquite's, or its path",
          "speed": "relative speed of the project's own methods",
          "criterion": "the criterion: its later version holds, the limit is missed by rounding, it wants an order of two equal results, or the "
                       "result is stronger than the thesis says",
          "chance": "chance of the seed, or one number that several claims share",
          "stand-in": "the stand-in mesh or its distortion: suspected; for C3 shown by a test",
          "reading": "a reading of the thesis, or a choice of this project"}
BUILT = ("nonuniform-grid", "subdivision")  # meshes that the thesis describes completely


def read_causes():
    """{claim that does not hold: cause}; raises ResultsError for an unknown cause."""
    rows = read_rows(thesis_folder() / "causes.csv", ("claim", "cause")).records()
    for row in rows:
        if row["cause"] not in CAUSES:
            raise ResultsError(f"causes.csv: there is no cause '{row['cause']}' (claim {row['claim']}).")
    return {row["claim"]: row["cause"] for row in rows}


def failing(found):
    """Names of the claims that do not hold, without later criteria."""
    return [o.claim["id"] for study in found for o in study.outcomes if o.verdict == FAILS and not o.is_revised_criterion]


def kind_of(study):
    """The kind of meshes that a study has."""
    meshes = entries(study.provenance or {}, "meshes")
    if any(mesh.get("published") for mesh in meshes):
        return "published by the authors"
    return "built as the thesis describes" if study.name in BUILT else "stand-ins of about the same size"


def blocks(reference):
    """The blocks of the page on fidelity."""
    found = studies(reference)
    return {"causes": causes(found), "kinds": kinds(found), "agreement": gear(reference / "gear")}


def causes(found):
    """Claims that do not hold by cause."""
    cause = read_causes()
    fails = failing(found)
    if set(fails) != set(cause):
        raise ResultsError(f"studies/thesis/causes.csv: these claims differ: {', '.join(sorted(set(fails) ^ set(cause)))}.")
    rows = []
    for key, text in CAUSES.items():
        names = [name for name in fails if cause[name] == key]
        rows.append((text, len(names), " ".join(names)))
    rows.append(("**all**", len(fails), ""))
    return table(("cause", "claims", "names"), rows, "lrl")


def kinds(found):
    """Claims that hold by kind of mesh."""
    counts = {}
    for study in found:
        chosen = [o for o in study.outcomes if not o.is_revised_criterion]
        count = counts.setdefault(kind_of(study), [[], 0, 0, 0])
        count[0].append(f"`{study.name}`")
        for k, verdict in ((1, HOLDS), (2, FAILS)):
            count[k] += sum(o.verdict == verdict for o in chosen)
        count[3] += len(chosen)
    return table(("meshes", "studies", "claims", "hold", "do not hold", "cannot be checked"),
                 [(kind, ", ".join(names), n, holds, fails, n - holds - fails)
                  for kind, (names, holds, fails, n) in sorted(counts.items(), key=lambda item: len(item[1][0]))], "llrrrr")


def gear(folder):
    """Tables 6.1 to 6.4 next to the results on the published gears."""
    rows = {row["name"]: row for row in entries(read_provenance(folder / "provenance.json"), "meshes")}
    tri, quad = rows["tri"], rows["quad"]
    return (f"On the published gear meshes (triangles: {tri['n_nodes']:,} nodes, {tri['n_cells']:,} cells; quadrilaterals: "
            f"{quad['n_nodes']:,} nodes, {quad['n_cells']:,} cells):\n\n" + "\n".join(agreement(folder)))
