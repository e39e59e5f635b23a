// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

#include "fem/ranks/ranks.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A rectangle or box of equal squares or cubes, whose longest side is 1.
struct BoxParameters {
  std::array<std::size_t, 3> n{1, 1, 1};  ///< cells along x, y and z; z counts in space only
  bool splits = false;  ///< each square into 2 triangles, each cube into 6 tetrahedra (Kuhn)
  /// Largest displacement of inner nodes along each axis, in edges of the cubes. The random numbers
  /// depend on the seed and the node only. Below 1/6, so that all simplices stay valid.
  double displacement = 0.0;
  std::uint64_t seed = 1;
};

/// Returns the cells in layers first .. last - 1 along the last axis. Nodes have their numbers in
/// the whole box as the field GlobalIds. The box' boundary nodes are fixed.
template <int dim>
Mesh<dim> box_layers(const BoxParameters& parameters, std::size_t first, std::size_t last);

/// Writes the box in pieces of about equal numbers of layers; each rank writes some of them. The
/// files do not depend on the number of ranks. Returns the number of cells. Collective. Throws
/// InputError.
template <int dim>
std::size_t write_box(const Ranks& ranks, const BoxParameters& parameters, std::size_t n_pieces,
                      const std::filesystem::path& out);

}  // namespace smoothfem
