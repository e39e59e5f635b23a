// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "smoothing/getme/min_tree.h"
#include "smoothing/mesh/topology.h"
#include "smoothing/parts/whole_mesh.h"

namespace smoothfem {

/// Returns the n cells of the whole mesh with the lowest keys, ascending, without infinite keys.
/// keys: of the cells here; those of other processes are infinite. Collective.
std::vector<KeyedCell> lowest_cells(const WholeMesh& whole, const MinTree& keys, std::size_t n);

/// A node that would move with the candidate at a place.
struct CandidateNode {
  std::uint32_t place;
  GlobalIndex node;
  double second_key;  ///< of the candidate: decides between equal keys
};

/// Chooses candidates that can move their nodes at the same time: no cell has moving nodes of two
/// of them. The choice does not depend on the parts of a mesh.
class IndependentCells {
 public:
  /// Prepares a run; call it first.
  void prepare(const Topology& topology);

  /// Returns the places of the chosen candidates, in the order of their keys. The first one is
  /// always chosen. nodes: all that would move, on all processes; those of a candidate follow each
  /// other. Collective.
  std::vector<std::uint32_t> choose(std::span<const KeyedCell> candidates,
                                    std::span<const CandidateNode> nodes);

 private:
  const Topology* topology_ = nullptr;
  std::vector<std::uint32_t> last_visits_;  ///< of each cell; zero between two calls
};

}  // namespace smoothfem
