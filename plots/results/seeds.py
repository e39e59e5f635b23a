# SPDX-License-Identifier: GPL-3.0-or-later
"""A study may repeat its meshes with other seeds. In its files each repetition is a mesh of its own; for
tables, figures and claims it is the same mesh once more."""

from dataclasses import replace

import numpy as np

from .rows import entries


def by_seed(results):
    """The results of the first seed, with those of the others as its `repetitions`: in each of them the
    meshes have the names of the first one's. Meshes that no seed changes are in all of them."""
    described = {entry["name"]: entry for entry in entries(results.provenance, "meshes")}
    repeated = {name: described[name]["repeats"] for name in results.meshes
                if described.get(name, {}).get("repeats")}
    seed_of = {name: described[name].get("seed") for name in repeated}
    first = tuple(mesh for mesh in results.meshes if mesh not in repeated)
    repetitions = []
    for seed in dict.fromkeys(seed_of.values()):
        of_seed = {repeated[name]: name for name in repeated if seed_of[name] == seed}
        repetitions.append(renamed(results, {of_seed.get(mesh, mesh): mesh for mesh in first}))
    return replace(renamed(results, {mesh: mesh for mesh in first}), repetitions=tuple(repetitions),
                   seeds=(described[first[0]].get("seed"), *dict.fromkeys(seed_of.values())) if repeated else (),
                   repeated=tuple(dict.fromkeys(repeated.values())))


def renamed(results, names):
    """The results of some meshes only, under other names: names maps old ones to new ones."""
    def rows_of(rows):
        chosen = rows.where(np.array([mesh in names for mesh in rows.text("mesh")], dtype=bool))
        meshes = np.array([names[mesh] for mesh in chosen.text("mesh")], dtype=object)
        return replace(chosen, columns={**chosen.columns, "mesh": meshes})
    return replace(results, meshes=tuple(names.values()), summary=rows_of(results.summary),
                   iterations=rows_of(results.iterations), thresholds=rows_of(results.thresholds))
