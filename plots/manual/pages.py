# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages with generated blocks, and their blocks."""

from ..claims.reasons import reference
from ..results.data_folder import data_folder
from . import answer, curved, elasticity, fidelity, finite_elements, moving_nodes, paper, sizes


def blocks():
    """{path of a page: {name of a block: Markdown}}."""
    docs = data_folder() / "docs"
    found = answer.Fields(reference())
    of_thesis = fidelity.blocks(reference())
    return {
        data_folder() / "README.md": {"findings": answer.in_short(found)},
        docs / "explanation" / "answer.md": answer.blocks(found, reference()),
        docs / "explanation" / "curved-study.md": curved.blocks(reference()),
        docs / "explanation" / "elasticity-study.md": elasticity.blocks(reference()),
        docs / "explanation" / "finite-elements.md": finite_elements.blocks(reference()),
        docs / "explanation" / "fidelity.md": of_thesis,
        docs / "explanation" / "reducing-the-error-tables.md": moving_nodes.blocks(reference()),
        data_folder() / "paper" / "paper.md": {"agreement": of_thesis["agreement"], "gear": paper.gear(reference()),
                                               "findings": answer.in_short(found)},
        docs / "explanation" / "parts-of-a-mesh.md": {"huge": sizes.huge(reference())},
        docs / "how-to" / "restart-and-mpi.md": {"largest": sizes.largest(reference())},
    }
