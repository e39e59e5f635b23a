# SPDX-License-Identifier: GPL-3.0-or-later
"""Selection of meshes that are drawn in one figure, so that it fits a page."""

from . import style
from .meshes import rows_of_panels

# Rows of panels of meshes, and columns of panels of diagrams, one for each mesh.
ROWS_OF_A_PAGE = 4
MESHES_OF_A_PAGE = 3

# How the name of a mesh ends that is a distorted one of the name before.
DISTORTED_SUFFIX = "-distorted"


def pages(meshes, fits):
    """Suffix -> meshes of one figure: all of them if `fits` says that they fit a page, else each mesh
    together with its distorted one, else one for each mesh."""
    families = {}
    for mesh in meshes:
        base = mesh.removesuffix(DISTORTED_SUFFIX)
        families.setdefault(base if base in meshes else mesh, []).append(mesh)
    for groups in ({"": list(meshes)}, {f"_{name}": family for name, family in families.items()}):
        if all(fits(group) for group in groups.values()):
            return groups
    return {f"_{mesh}": [mesh] for mesh in meshes}


def fits_as_columns(meshes):
    """True if a column of diagrams for each mesh is readable on one page."""
    return len(meshes) <= style.columns_that_fit(MESHES_OF_A_PAGE)


def pages_of_blocks(blocks, columns):
    """Suffix -> blocks of each figure; `blocks` maps meshes to (title, panels), which take so many
    columns."""
    def fits(meshes):
        return sum(rows_of_panels(blocks[mesh][1], columns) for mesh in meshes) <= ROWS_OF_A_PAGE
    return {part: [blocks[mesh] for mesh in meshes] for part, meshes in pages(list(blocks), fits).items()}
