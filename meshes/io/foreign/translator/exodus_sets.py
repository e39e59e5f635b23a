# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets of Exodus files: of sides, which are labelled edges and faces or fields at cells, and of nodes, which are fields."""

import dataclasses

import numpy as np

from .fields import unused_name
from .mesh import DIMENSIONS, Mesh, ends

ELEMENT_IDS, SIDE_ELEMENTS, SIDES = "GlobalElementId", "SourceElementId", "SourceElementSide"  # names of VTK
VTK_ARRAYS = (ELEMENT_IDS, "PedigreeElementId", SIDE_ELEMENTS, SIDES)
LINE = 3


@dataclasses.dataclass
class Group:
    """A block or a set of a file. The groups of a file share all points."""
    mesh: Mesh
    number: int
    name: str  # "" if it has none

    def label(self, kind):
        return self.name or f"{kind}_{self.number}"

    def without_vtk_arrays(self):
        kept = {name: values for name, values in self.mesh.cell_data.items() if name not in VTK_ARRAYS}
        return dataclasses.replace(self, mesh=dataclasses.replace(self.mesh, cell_data=kept))

    def only(self, chosen):
        return dataclasses.replace(self, mesh=self.mesh.only(chosen))


class Elements:
    """The elements of all blocks, one after another."""

    def __init__(self, blocks):
        self.sizes = np.concatenate([np.diff(block.mesh.offsets) for block in blocks])
        self.starts = ends(self.sizes)[:-1]
        self.nodes = np.concatenate([block.mesh.nodes for block in blocks])
        types = np.concatenate([block.mesh.types for block in blocks])
        self.is_surface = np.array([DIMENSIONS.get(t, 2) == 2 for t in range(256)])[types]
        ids = np.concatenate([block.mesh.cell_data[ELEMENT_IDS] for block in blocks])
        self.order = np.argsort(ids, kind="stable")
        self.sorted_ids = ids[self.order]

    def of_sides(self, group):
        """The position of the element that each side belongs to."""
        places = np.searchsorted(self.sorted_ids, group.mesh.cell_data[SIDE_ELEMENTS] + 1)
        return self.order[np.minimum(places, len(self.order) - 1)]


def divided_side_sets(side_sets, blocks):
    """The side sets without faces that are cells of a surface, and a mask of the cells for each set that has such faces.

    Sides 1 and 2 of a shell are its two faces, and its edges follow. VTK knows this of few types of shells only."""
    elements = Elements(blocks)
    places = [elements.of_sides(group) for group in side_sets]
    are_shells = any((elements.is_surface[at] & (group.mesh.cell_data[SIDES] >= elements.sizes[at])).any()
                     for group, at in zip(side_sets, places))
    kept, masks = [], []
    for group, at in zip(side_sets, places):
        is_surface, sides = elements.is_surface[at], group.mesh.cell_data[SIDES]
        is_face = is_surface & (sides < 2 if are_shells else group.mesh.dimensions() == 2)
        if is_face.any():
            mask = np.zeros(len(elements.sizes), np.int32)
            mask[at[is_face]] = 1
            masks.append((group, mask))
        is_edge = is_surface & ~is_face & are_shells
        kept += [group.only(~is_face & ~is_edge), dataclasses.replace(group, mesh=edges(group, elements, at, sides - 2, is_edge))]
    return [group for group in kept if len(group.mesh.types)], masks


def edges(group, elements, at, first, chosen):
    at, first = at[chosen], first[chosen]
    ends_of_edges = [elements.nodes[elements.starts[at] + (first + k) % elements.sizes[at]] for k in (0, 1)]
    return Mesh(group.mesh.points, np.full(len(at), LINE, np.uint8), ends(np.full(len(at), 2)),
                np.column_stack(ends_of_edges).ravel(), {}, {})


def fields_of_cells(masks, n_cells, taken):
    """Side sets that are cells: fields with 1 there, and with 0 at all other cells."""
    fields = {}
    for group, mask in masks:
        name = unused_name(group.label("side_set"), {*taken, *fields})
        fields[name] = np.concatenate([mask, np.zeros(n_cells - len(mask), np.int32)])
    say("side sets that cover cells of the surface become fields at cells", fields)
    return fields


def fields_of_nodes(node_sets, n_points, taken):
    """Node sets: fields with 1 at their nodes, and with 0 at all other nodes."""
    fields = {}
    for group in node_sets:
        values = np.zeros(n_points, np.int32)
        values[group.mesh.nodes] = 1
        fields[unused_name(group.label("node_set"), {*taken, *fields})] = values
    say("node sets become fields at nodes", fields)
    return fields


def say(what, fields, most=5):
    if fields:
        names = [*list(fields)[:most], *["..."] * (len(fields) > most)]
        print(f"note: {what}: {', '.join(names)}")


def with_positive_numbers(groups, kind, taken):
    """Gives groups with the number 0 a free number, as 0 means that there is no tag."""
    if not any(group.number == 0 for group in groups):
        return groups
    number = max(taken) + 1
    name = next((group.name for group in groups if group.number == 0), "")
    print(f"note: the {kind} 0{f' ({name})' if name else ''} gets the number {number}, as 0 means none")
    return [dataclasses.replace(group, number=group.number or number) for group in groups]
