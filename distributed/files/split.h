// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Writes a mesh in pieces of about equal numbers of cells (pieces.h). Zoltan bisects it by
/// coordinates. Pieces keep tags, labelled elements, names, fields, fixed nodes and the numbers of
/// nodes and cells in the whole mesh, as fields with the role GlobalIds. Model entities, the file's
/// own numbers and periodic partners are left out. Throws InputError for meshes of second order,
/// polygons that .vtu files cannot hold, and files that cannot be written.
template <int dim>
void write_in_pieces(const Mesh<dim>& mesh, std::size_t n_pieces, const std::filesystem::path& out);

}  // namespace smoothfem
