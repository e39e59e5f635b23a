// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimization/shape_objective.h"

#include <limits>

#include "smoothing/mesh/parallel_rows.h"
#include "smoothing/optimization/added_block.h"
#include "smoothing/optimization/target_derivatives.h"

namespace smoothfem {

namespace {

/// Marks the block of a pair with a fixed node.
constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

/// Cells in the form that the sums below take: several of a fixed type, or one polygon.
template <std::size_t n>
const NodeIndex* nodes_of(const CellBatch<n>& batch, std::size_t l) {
  return batch.nodes[l];
}
struct SinglePolygon {
  std::span<const NodeIndex> nodes;

  template <class Visit>
  void for_each_lane(const Visit& visit) const {
    visit(std::size_t{0});
  }
};
const NodeIndex* nodes_of(const SinglePolygon& polygon, std::size_t) {
  return polygon.nodes.data();
}

/// Adds the gradients of cells and the diagonal blocks of their Hessians. The order of the cells,
/// and so of these sums, is always the same.
template <int dim>
struct DiagonalSums {
  static constexpr HessianBlocks blocks = HessianBlocks::diagonal;
  const std::vector<std::uint32_t>& unknown;
  BlockVector<dim>& gradient;
  std::vector<typename BlockMatrix<dim>::Block>& diagonal;

  template <class Cells, class Real, std::size_t extent>
  void add(const Cells& cells, const CellDerivatives<dim, Real, extent>& cell) {
    const std::size_t n = cell.gradient.size();
    for (std::size_t p = 0; p < n; ++p) {
      const auto blocks_of_cells = added_blocks<double>(cell.hessian[node_pair(n, p, p)]);
      cells.for_each_lane([&](std::size_t l) {
        const std::uint32_t row = unknown[nodes_of(cells, l)[p]];
        if (row >= gradient.size()) return;
        gradient[row] += lane(cell.gradient[p], l);
        blocks_of_cells[l].add_to(diagonal[row].data());
      });
    }
  }
};

/// Adds the other blocks, scaled, in the same order.
template <int dim>
struct OtherBlockSums {
  static constexpr HessianBlocks blocks = HessianBlocks::all;
  const std::vector<std::uint32_t>& unknown;
  const std::array<std::uint32_t, 2>* positions;  ///< in the matrix, of the next cell's pairs
  BlockMatrix<dim>& hessian;

  template <class Cells, class Real, std::size_t extent>
  void add(const Cells& cells, const CellDerivatives<dim, Real, extent>& cell) {
    const std::size_t n = cell.gradient.size(), n_pairs = n_node_pairs(n) - n;
    CellArray<Block<dim, Real>, extent> factors(n);
    for (std::size_t p = 0; p < n; ++p)
      cells.for_each_lane([&](std::size_t l) {
        const double* const factor = hessian.inverse_factor(unknown[nodes_of(cells, l)[p]]).data();
        for (std::size_t i = 0; i < dim * dim; ++i) set_lane(factors[p].entries[i], l, factor[i]);
      });
    const auto* pair = positions;
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t q = p + 1; q < n; ++q, ++pair) {
        const auto blocks_of_cells = added_blocks<typename BlockMatrix<dim>::Number>(
            scaled<dim>(factors[p], cell.hessian[node_pair(n, p, q)], factors[q]));
        cells.for_each_lane([&](std::size_t l) {
          const auto [right, left] = pair[l * n_pairs];
          if (right == nowhere) return;
          blocks_of_cells[l].add_to(hessian.scaled_block(right));
          blocks_of_cells[l].transpose().add_to(hessian.scaled_block(left));
        });
      }
    cells.for_each_lane([&](std::size_t) { positions += n_pairs; });
  }
};

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
            sums.add(SinglePolygon{topology.cell_nodes(c)}, derivatives);
          });
      });
}

/// Returns for each unknown the unknowns it shares a cell with.
CompressedRows<std::uint32_t> coupled_unknowns(const Topology& topology,
                                               const std::vector<std::uint32_t>& unknown) {
  const auto& free_nodes = topology.free_nodes();
  return make_rows<std::uint32_t>(free_nodes.size(),
                                  [&](std::size_t i, std::vector<std::uint32_t>& row) {
                                    for (const CellIndex c : topology.node_cells(free_nodes[i]))
                                      for (const NodeIndex j : topology.cell_nodes(c))
                                        if (unknown[j] < free_nodes.size())
                                          row.push_back(unknown[j]);
                                    std::sort(row.begin(), row.end());
                                    row.erase(std::unique(row.begin(), row.end()), row.end());
                                  });
}

}  // namespace

template <int dim>
ShapeObjective<dim>::ShapeObjective(std::shared_ptr<const Topology> topology,
                                    std::shared_ptr<const CellTargets<dim>> targets,
                                    double size_weight)
    : topology_(std::move(topology)),
      targets_(std::move(targets)),
      size_weight_(size_weight),
      unknown_(topology_->n_nodes(), static_cast<std::uint32_t>(n_unknown_nodes())) {
  std::uint32_t next = 0;
  for (const NodeIndex i : topology_->free_nodes()) unknown_[i] = next++;
  const auto& blocks = topology_->blocks();
  const auto nodes = [&](std::size_t b) {
    return IndexRange{blocks[b].first_node, blocks[b].last_node};
  };
  groups_ = disjoint_groups(blocks.size(), nodes, nodes);
}

template <int dim>
BlockMatrix<dim> ShapeObjective<dim>::make_hessian() {
  BlockMatrix<dim> matrix(coupled_unknowns(*topology_, unknown_));
  const auto fixed = static_cast<std::uint32_t>(n_unknown_nodes());
  positions_.resize(topology_->blocks().size());
  parallel_for(positions_.size(), [&](std::size_t b) {
    const CellBlock& block = topology_->blocks()[b];
    positions_[b].clear();
    for (CellIndex c = block.first; c < block.last; ++c) {
      const auto nodes = topology_->cell_nodes(c);
      for (std::size_t p = 0; p < nodes.size(); ++p)
        for (std::size_t q = p + 1; q < nodes.size(); ++q) {
          const std::uint32_t i = unknown_[nodes[p]], j = unknown_[nodes[q]];
          if (i == fixed || j == fixed)
            positions_[b].push_back({nowhere, nowhere});
          else
            positions_[b].push_back({matrix.position(i, j), matrix.position(j, i)});
        }
    }
  });
  return matrix;
}

template <int dim>
double ShapeObjective<dim>::value(std::span<const Point<dim>> coordinates) const {
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
  std::fill(gradient.begin(), gradient.end(), Point<dim>::Zero());
  auto diagonal = hessian.start_diagonal();
  for_disjoint_blocks([&](std::size_t b) {
    add_block_derivatives<dim>(*topology_, sizes, coordinates.data(), topology_->blocks()[b], model,
                               DiagonalSums<dim>{unknown_, gradient, diagonal});
  });
  hessian.factor_diagonal(std::move(diagonal));
  for_disjoint_blocks([&](std::size_t b) {
    add_block_derivatives<dim>(*topology_, sizes, coordinates.data(), topology_->blocks()[b], model,
                               OtherBlockSums<dim>{unknown_, positions_[b].data(), hessian});
  });
}

template class ShapeObjective<2>;
template class ShapeObjective<3>;

}  // namespace smoothfem
