// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimization/untangle.h"

#include <chrono>
#include <cmath>

#include "smoothing/optimization/vertex_descent.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {

namespace {

/// Flags the nodes of these cells and of n_layers layers of cells around them.
std::vector<std::uint8_t> nodes_round(const Topology& topology, const std::vector<CellIndex>& cells,
                                      int n_layers) {
  std::vector<std::uint8_t> flags(topology.n_nodes(), 0);
  std::vector<NodeIndex> front;
  const auto add = [&](CellIndex c) {
    for (const NodeIndex i : topology.cell_nodes(c))
      if (!flags[i]) {
        flags[i] = 1;
        front.push_back(i);
      }
  };
  for (const CellIndex c : cells) add(c);
  for (int layer = 0; layer < n_layers; ++layer) {
    const auto last = std::move(front);
    front = {};
    for (const NodeIndex i : last)
      for (const CellIndex c : topology.node_cells(i)) add(c);
  }
  return flags;
}

template <int dim>
class Untangling {
 public:
  Untangling(const Mesh<dim>& mesh, const UntangleParameters& parameters)
      : parameters_(parameters), mesh_(mesh), descent_(mesh.topology(), mesh.constraints()) {}

  /// Returns the invalid cells of the best mesh found.
  std::vector<CellIndex> run(std::vector<CellIndex> invalid) {
    auto best = invalid;
    auto best_positions = mesh_.copied_coordinates();
    for (int round = 0; round < parameters_.max_rounds && !invalid.empty(); ++round) {
      invalid = run_round(round, invalid);
      if (invalid.size() < best.size()) {
        best = invalid;
        std::copy(mesh_.coordinates().begin(), mesh_.coordinates().end(), best_positions.begin());
      }
    }
    mesh_.swap_coordinates(best_positions);
    return best;
  }
  const Mesh<dim>& mesh() const { return mesh_; }
  int n_sweeps() const { return n_sweeps_; }

 private:
  std::vector<CellIndex> run_round(int round, std::vector<CellIndex> invalid) {
    constexpr int final_sweeps = 3;
    const int n_sweeps = parameters_.sweeps << round, n_layers = 2 << round;
    const auto active = nodes_round(mesh_.topology(), invalid, n_layers);
    const double fall = std::pow(parameters_.last_softness / parameters_.first_softness,
                                 1.0 / std::max(1, n_sweeps - 1));
    double softness = parameters_.first_softness;
    for (int i = 0; i < n_sweeps; ++i, softness *= fall) {
      descent_.soft_sweep(mesh_.coordinates(), softness, active);
      ++n_sweeps_;
      invalid = invalid_cells(cell_mean_ratios(mesh_));
      // With a softness above the determinants themselves the objective does not measure shape.
      if (invalid.empty() && softness < 1.0) break;
    }
    if (invalid.empty())
      for (int i = 0; i < final_sweeps; ++i, ++n_sweeps_)
        descent_.sweep(mesh_.coordinates(), active);
    return invalid;
  }

  const UntangleParameters& parameters_;
  Mesh<dim> mesh_;
  VertexDescent<dim> descent_;
  int n_sweeps_ = 0;
};

}  // namespace

template <int dim>
UntangleResult untangle(Mesh<dim>& mesh, const UntangleParameters& parameters) {
  const auto start = std::chrono::steady_clock::now();
  UntangleResult result;
  result.invalid_cells = invalid_cells(cell_mean_ratios(mesh));
  result.n_invalid_before = result.invalid_cells.size();
  if (result.n_invalid_before > 0) require_linear(mesh.topology(), "untangling");
  for (const CellIndex c : result.invalid_cells)
    if (!mesh.topology().has_free_node(c)) result.fully_fixed_cells.push_back(c);
  if (!result.invalid_cells.empty() && result.fully_fixed_cells.empty()) {
    Untangling<dim> untangling(mesh, parameters);
    result.invalid_cells = untangling.run(std::move(result.invalid_cells));
    result.n_sweeps = untangling.n_sweeps();
    if (result.invalid_cells.empty()) mesh.set_coordinates(untangling.mesh().coordinates());
  }
  result.n_invalid_after = result.invalid_cells.size();
  result.valid = result.invalid_cells.empty();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

template UntangleResult untangle(Mesh<2>&, const UntangleParameters&);
template UntangleResult untangle(Mesh<3>&, const UntangleParameters&);

}  // namespace smoothfem
