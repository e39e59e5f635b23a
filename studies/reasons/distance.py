#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the numbers of iterations and the distances of the calibration of GETMe adaptive, as README.md defines them.

    distance.py FOLDER    FOLDER has the results of adaptive-bridge, adaptive-piston and adaptive-pump, packed or not."""

import csv
import lzma
import math
import sys
from pathlib import Path

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


def main(folder):
    """Prints a table, best pair first. Meshes without results are left out, which the first line says."""
    found = {(study, row["mesh"], row["method"]): row["iterations"] for study in ("bridge", "piston", "pump")
             for row in rows(Path(folder) / f"adaptive-{study}") if row["iterations"]}
    meshes = [mesh for mesh in PRINTED if any(key[:2] == mesh for key in found)]
    print(f"{len(meshes)} of {len(PRINTED)} meshes have results.\n")
    print("| pair | " + " | ".join(" ".join(mesh) for mesh in meshes) + " | distance |\n" + "|---" * (len(meshes) + 2) + "|")
    pairs = {key[2] for key in found}
    total = {pair: sum(distance(found[*mesh, pair], PRINTED[mesh]) for mesh in meshes) for pair in pairs}
    for pair in sorted(pairs, key=total.get):
        print(f"| {pair} | " + " | ".join(found[*mesh, pair] for mesh in meshes) + f" | {total[pair]:.2f} |")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    main(sys.argv[1])
