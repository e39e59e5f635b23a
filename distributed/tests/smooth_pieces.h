// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/distributed_mesh.h"
#include "distributed/files/pieces.h"
#include "distributed/partition.h"
#include "smoothing/loop/smooth.h"

namespace smoothfem::test {

/// Reads pieces, smooths them and writes them as `out`. Returns the part of this rank.
template <int dim>
Mesh<dim> smooth_pieces(const Ranks& ranks, const Pieces& pieces, const std::filesystem::path& out,
                        const std::string& method_name = "getme-simultaneous") {
  auto parts = distribute(ranks, balanced(ranks, std::get<ScatteredMesh<dim>>(pieces.read())));
  auto method = make_method<dim>(method_name);
  smooth(parts.part, method);
  store_coordinates(parts);
  pieces.write<dim>(out, parts.directory);
  return parts.part;
}

}  // namespace smoothfem::test
