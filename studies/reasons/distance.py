#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the numbers of iterations and the distances of the calibration of GETMe adaptive, as README.md defines them.

    distance.py FOLDER    FOLDER has the results of adaptive-bridge, adaptive-piston and adaptive-pump, packed or not."""

import csv
import lzma
import math
import sys
from pathlib import Path

STUDIES = ("bridge", "piston", "pump")
# Printed numbers of iterations, of both stages together (one number) or of each stage.
PRINTED = {("bridge", "tet"): [215], ("bridge", "tet-distorted"): [214], ("bridge", "hex"): [219], ("bridge", "hex-distorted"): [245],
           ("piston", "tet"): [15, 47], ("pump", "hex"): [25, 43]}


def rows(folder):
    """Returns the rows of summary.csv; none if there are no results."""
    for path, opened in ((folder / "summary.csv", open), (folder / "summary.csv.xz", lzma.open)):
        if path.exists():
            with opened(path, "rt", encoding="utf-8", newline="") as file:
                return list(csv.DictReader(file))
    return []


def distance(text, printed):
    """Returns the sum of |log(count / printed)|. The text has the numbers of both stages: 6/217."""
    counts = [int(count) for count in text.split("/")]
    if len(printed) == 1:
        counts = [sum(counts)]
    return sum(abs(math.log(max(count, 1) / number)) for count, number in zip(counts, printed))


def counts(folder):
    """(study, mesh, pair) -> numbers of iterations as text, of all results in the folder."""
    return {(study, row["mesh"], row["method"]): row["iterations"] for study in STUDIES
            for row in rows(Path(folder) / f"adaptive-{study}") if row["iterations"]}


def totals(found, meshes):
    """Pair -> distance over these meshes."""
    return {pair: sum(distance(found[*mesh, pair], PRINTED[mesh]) for mesh in meshes) for pair in {key[2] for key in found}}


def main(folder):
    """Prints a table, best pair first, and the choices without each study. Meshes without results are left out, which the first line
    says."""
    found = counts(folder)
    meshes = [mesh for mesh in PRINTED if any(key[:2] == mesh for key in found)]
    print(f"{len(meshes)} of {len(PRINTED)} meshes have results.\n")
    print("| pair | " + " | ".join(" ".join(mesh) for mesh in meshes) + " | distance |\n" + "|---" * (len(meshes) + 2) + "|")
    total = totals(found, meshes)
    for pair in sorted(total, key=total.get):
        print(f"| {pair} | " + " | ".join(found[*mesh, pair] for mesh in meshes) + f" | {total[pair]:.2f} |")
    for study in STUDIES:
        left = [mesh for mesh in meshes if mesh[0] != study]
        without = totals(found, left)
        if left:
            nearest = min(without, key=without.get)
            print(f"\nWithout {study}: {nearest}, distance {without[nearest]:.2f}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    main(sys.argv[1])
