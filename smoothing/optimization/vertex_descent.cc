// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimization/vertex_descent.h"

#include "smoothing/base/parallel.h"
#include "smoothing/optimization/node_objective.h"
#include "smoothing/optimization/sliding_step.h"

namespace smoothfem {

namespace {

/// Makes one Newton step of one node, halved until the objective of its cells falls enough.
template <int dim>
[[gnu::flatten]] void descend_node(const Topology& topology, NodeIndex node, double softness,
                                   std::span<Point<dim>> x) {
  constexpr double sufficient = 1e-4;
  constexpr int max_halvings = 30;
  if (softness > 0.0) softness *= mean_size<dim>(topology, x, node);
  const Point<dim> start = x[node];
  const auto here = local_objective<true, dim>(topology, x, node, start, softness);
  const Point<dim> step = -here.hessian.ldlt().solve(here.gradient);
  const double slope = step.dot(here.gradient);
  if (!(slope < 0.0) || !step.allFinite()) return;
  double alpha = 1.0;
  for (int k = 0; k < max_halvings; ++k, alpha *= 0.5) {
    const Point<dim> trial = start + alpha * step;
    const double value = local_objective<false, dim>(topology, x, node, trial, softness).value;
    if (value <= here.value + sufficient * alpha * slope) {
      x[node] = trial;
      return;
    }
  }
}

}  // namespace

template <int dim>
VertexDescent<dim>::VertexDescent(const Topology& topology, const NodeConstraints<dim>* constraints)
    : topology_(topology), constraints_(constraints) {
  constexpr std::size_t grain = 1024;
  const auto& nodes = topology.free_nodes();
  std::vector<IndexRange> written, read;
  for (std::size_t first = 0; first < nodes.size(); first += grain) {
    const IndexRange part{first, std::min(first + grain, nodes.size())};
    IndexRange range{nodes[part.first], nodes[part.last - 1] + 1u};
    written.push_back(range);
    for (std::size_t i = part.first; i < part.last; ++i)
      for (const CellIndex c : topology.node_cells(nodes[i]))
        for (const NodeIndex j : topology.cell_nodes(c)) {
          range.first = std::min<std::size_t>(range.first, j);
          range.last = std::max<std::size_t>(range.last, j + 1u);
        }
    read.push_back(range);
    parts_.push_back(part);
  }
  groups_ = disjoint_groups(
      parts_.size(), [&](std::size_t p) { return written[p]; },
      [&](std::size_t p) { return read[p]; });
}

template <int dim>
void VertexDescent<dim>::sweep(std::span<Point<dim>> x, double softness,
                               const std::uint8_t* active) const {
  const auto& nodes = topology_.free_nodes();
  for (const auto& group : groups_)
    parallel_for(group.size(), [&](std::size_t p) {
      const IndexRange part = parts_[group[p]];
      for (std::size_t i = part.first; i < part.last; ++i)
        if (!active || active[nodes[i]]) {
          if (constraints_ && constraints_->classifications()[nodes[i]].n_directions(dim) < dim)
            slide_node<dim>(topology_, *constraints_, nodes[i], softness, x);
          else
            descend_node<dim>(topology_, nodes[i], softness, x);
        }
    });
}

template class VertexDescent<2>;
template class VertexDescent<3>;

}  // namespace smoothfem
