// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimization/shape_objective.h"

#include <limits>

#include "smoothing/optimization/target_derivatives.h"
#include "smoothing/parts/exact_sum.h"

namespace smoothfem {

namespace {

/// The targets of a mesh's cells, if it has any, and the factor of the term for their size.
template <int dim>
struct Sizes {
  const CellTargets<dim>* targets;
  double weight;
};

/// Calls visit(corners) with a polygon's corners, mapped to where its target is regular.
template <class Visit>
void with_target_polygon(const Topology& topology, const Sizes<2>& sizes, const Point<2>* x,
                         CellIndex cell, const Visit& visit) {
  std::vector<Vector2<double>> corners;
  corners.reserve(topology.cell_nodes(cell).size());
  for (const NodeIndex node : topology.cell_nodes(cell)) corners.push_back(vector_of(x[node]));
  if (sizes.targets != nullptr) {
    const auto map = linear_map<TargetMap::to_regular>(*sizes.targets, cell);
    for (auto& corner : corners) corner = map(corner);
  }
  visit(std::span<const Vector2<double>>(corners));
}

/// Returns the part of the objective of one cell or of several.
template <int dim, class Real, std::size_t extent>
Real cell_objective(const Sizes<dim>& sizes, std::span<const Vector<dim, Real>, extent> corners) {
  const Real mean = mean_inverse_mean_ratio(corners);
  if (sizes.targets == nullptr) return mean * mean;
  const Real size = node_simplex_size<dim>(corners);
  const double bound = sizes.targets->size_bound();
  const Real infinite = Real{} + std::numeric_limits<double>::infinity();
  const auto is_within = (size < bound) & (size * bound > 1.0);
  return is_within ? mean * mean + sizes.weight * size_term(size) : infinite;
}

template <int dim>
double sum_of_block(const Topology& topology, const Sizes<dim>& sizes, const Point<dim>* x,
                    const CellBlock& block) {
  Lanes sums{};
  for_each_batch<dim>(
      topology, block.first, block.last,
      [&]<std::size_t n>(const CellBatch<n>& batch) {
        const auto corners = target_corners<dim>(sizes.targets, batch, coordinates_at(x));
        const Lanes value = cell_objective<dim, Lanes, n>(sizes, corners);
        if (batch.count == n_lanes)
          sums += value;
        else
          sums[0] += value[0];
      },
      [&](CellIndex c) {
        if constexpr (dim == 2)
          with_target_polygon(topology, sizes, x, c, [&](auto corners) {
            sums[0] += cell_objective<2, double, std::dynamic_extent>(sizes, corners);
          });
      });
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

/// Returns the sum over the cells that a part of a mesh owns.
template <int dim>
ExactSum sum_of_part(const Topology& topology, const Point<dim>* x) {
  const Sizes<dim> sizes{nullptr, 0.0};
  std::vector<ExactSum> sums(topology.blocks().size());
  parallel_for(sums.size(), [&](std::size_t b) {
    const auto add = [&](CellIndex c, double value) {
      if (topology.part()->owns_cell(c)) sums[b].add(value);
    };
    for_each_batch<dim>(
        topology, topology.blocks()[b].first, topology.blocks()[b].last,
        [&]<std::size_t n>(const CellBatch<n>& batch) {
          const auto corners = target_corners<dim>(nullptr, batch, coordinates_at(x));
          const Lanes value = cell_objective<dim, Lanes, n>(sizes, corners);
          batch.for_each_lane([&](std::size_t l) { add(batch.cells[l], value[l]); });
        },
        [&](CellIndex c) {
          if constexpr (dim == 2)
            with_target_polygon(topology, sizes, x, c, [&](auto corners) {
              add(c, cell_objective<2, double, std::dynamic_extent>(sizes, corners));
            });
        });
  });
  ExactSum sum;
  for (const ExactSum& part : sums) sum.add(part);
  return sum;
}

template <int dim, class Sums>
void add_block_derivatives(const Topology& topology, const Sizes<dim>& sizes, const Point<dim>* x,
                           const CellBlock& block, HessianModel model, Sums sums) {
  for_each_batch<dim>(
      topology, block.first, block.last,
      [&]<std::size_t n>(const CellBatch<n>& batch) {
        const auto corners = target_corners<dim>(sizes.targets, batch, coordinates_at(x));
        const std::span<const Vector<dim, Lanes>, n> nodes(corners);
        CellDerivatives<dim, Lanes, n> derivatives(nodes, model, Sums::blocks);
        if (sizes.targets != nullptr) [[unlikely]]
          add_size_and_map_back<dim, Lanes, n>(
              nodes, sizes.weight, linear_map<TargetMap::to_regular>(*sizes.targets, batch.cells),
              model, Sums::blocks, derivatives);
        sums.add(batch, derivatives);
      },
      [&](CellIndex c) {
        if constexpr (dim == 2)
          with_target_polygon(topology, sizes, x, c, [&](std::span<const Vector2<double>> nodes) {
            CellDerivatives<2, double, std::dynamic_extent> derivatives(nodes, model, Sums::blocks);
            if (sizes.targets != nullptr)
              add_size_and_map_back<2, double, std::dynamic_extent>(
                  nodes, sizes.weight, linear_map<TargetMap::to_regular>(*sizes.targets, c), model,
                  Sums::blocks, derivatives);
            sums.add(SingleCell{topology.cell_nodes(c)}, derivatives);
          });
      });
}

/// Returns the nodes that are not fixed. In a part of a mesh, these include copies, which
/// topology.free_nodes() has not.
std::vector<NodeIndex> moving_nodes(const Topology& topology) {
  if (topology.part() == nullptr) return topology.free_nodes();
  std::vector<NodeIndex> nodes;
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
    if (!topology.is_fixed(i)) nodes.push_back(i);
  return nodes;
}

}  // namespace

template <int dim>
ShapeObjective<dim>::ShapeObjective(std::shared_ptr<const Topology> topology,
                                    std::shared_ptr<const CellTargets<dim>> targets,
                                    double size_weight)
    : topology_(std::move(topology)),
      targets_(std::move(targets)),
      size_weight_(size_weight),
      sums_(*topology_, moving_nodes(*topology_), topology_->cells()) {}

template <int dim>
BlockMatrix<dim> ShapeObjective<dim>::make_hessian() {
  return sums_.make_hessian([&](NodeIndex i) { return topology_->node_cells(i); });
}

template <int dim>
double ShapeObjective<dim>::value(std::span<const Point<dim>> coordinates) const {
  if (topology_->part())
    return sum_of_part<dim>(*topology_, coordinates.data()).total(*topology_->part());
  const Sizes<dim> sizes{targets_.get(), size_weight_};
  std::vector<double> parts(topology_->blocks().size());
  parallel_for(parts.size(), [&](std::size_t b) {
    parts[b] = sum_of_block<dim>(*topology_, sizes, coordinates.data(), topology_->blocks()[b]);
  });
  double sum = 0.0;
  for (const double part : parts) sum += part;
  return sum;
}

template <int dim>
void ShapeObjective<dim>::derivatives(std::span<const Point<dim>> coordinates, HessianModel model,
                                      BlockVector<dim>& gradient, BlockMatrix<dim>& hessian) const {
  const Sizes<dim> sizes{targets_.get(), size_weight_};
  sums_.derivatives(
      [&](const CellBlock& block, const auto& sums) {
        add_block_derivatives<dim>(*topology_, sizes, coordinates.data(), block, model, sums);
      },
      gradient, hessian);
}

template class ShapeObjective<2>;
template class ShapeObjective<3>;

}  // namespace smoothfem
