// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fem/ranks/ranks.h"

namespace smoothfem {

/// What the refinement of a mesh in pieces has done; the same on all ranks.
struct RefinedPieces {
  std::size_t n_pieces = 0, n_cells = 0;
  std::vector<std::string> losses{};  ///< what the pieces say that the refined ones do not
  std::vector<std::string> notes{};   ///< of Pieces, and what was not looked for, on the root
};

/// Splits the cells of a mesh in pieces (pieces.h) as with_split_cells() does, and writes as many
/// pieces (piece_file()). No rank holds the whole mesh; each handles its pieces one after the
/// other. The files do not depend on the number of ranks.
///
/// Existing nodes keep their numbers. New ones follow in the order of the sorted numbers of the
/// nodes that they are means of. Cells are numbered in the order of the cells that they are parts
/// of, and labelled facets follow. Existing nodes that stay do so in the refined mesh, too. A new
/// node stays if it lies on the boundary of the mesh between nodes that stay.
///
/// Collective. Throws InputError on all ranks if `in` is no mesh in pieces, for surfaces, cells of
/// second order, hanging nodes, invalid cells, polygons with more than four nodes, and files that
/// cannot be read or written. Cells are checked before anything is written.
RefinedPieces refine_pieces(const Ranks& ranks, const std::filesystem::path& in,
                            const std::filesystem::path& out);

}  // namespace smoothfem
