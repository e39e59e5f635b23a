#include "smoothing/optimization/shape_objective.h"

#include <limits>

#include "smoothing/mesh/parallel_rows.h"
#include "smoothing/optimization/added_block.h"
#include "smoothing/optimization/volume_cell_derivatives.h"
#include "smoothing/simd/cell_blocks.h"

namespace smoothfem {

namespace {

/// Where the block of a pair with a fixed node goes.
constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

SMOOTHFEM_INLINE Point<2> lane_of(Vector2<Lanes> v, std::size_t l) {
  return {v.x[l], v.y[l]};
}
SMOOTHFEM_INLINE Point<3> lane_of(Vector3<Lanes> v, std::size_t l) {
  return {v.x[l], v.y[l], v.z[l]};
}
SMOOTHFEM_INLINE Point<2> lane_of(Vector2<double> v, std::size_t) {
  return point_of(v);
}
SMOOTHFEM_INLINE Point<3> lane_of(Vector3<double> v, std::size_t) {
  return point_of(v);
}

/// Adds the gradients of cells and the diagonal blocks of their Hessians where they belong. The
/// order of the cells, and so of these sums, is always the same.
template <int dim>
struct DiagonalSums {
  static constexpr HessianBlocks blocks = HessianBlocks::diagonal;
  const Topology& topology;
  const std::vector<std::uint32_t>& unknown;
  BlockVector<dim>& gradient;
  BlockMatrix<dim>& hessian;

  /// first: the first of as many cells as Real has lanes.
  template <class Real, std::size_t extent>
  SMOOTHFEM_INLINE void add(CellIndex first, const CellDerivatives<dim, Real, extent>& cell) {
    constexpr std::size_t lanes = sizeof(Real) / sizeof(double);
    const std::size_t n = cell.gradient.size();
    const NodeIndex* const nodes = topology.cell_nodes(first).data();
    for (std::size_t p = 0; p < n; ++p) {
      const auto blocks_of_cells = added_blocks<double>(cell.hessian[node_pair(n, p, p)]);
      for (std::size_t l = 0; l < lanes; ++l) {
        const std::uint32_t row = unknown[nodes[l * n + p]];
        if (row >= gradient.size()) continue;
        gradient[row] += lane_of(cell.gradient[p], l);
        blocks_of_cells[l].add_to(hessian.diagonal_block(row).data());
      }
    }
  }
};

/// Adds the other blocks, scaled, likewise.
template <int dim>
struct OtherBlockSums {
  static constexpr HessianBlocks blocks = HessianBlocks::all;
  const Topology& topology;
  const std::vector<std::uint32_t>& unknown;
  const std::array<std::uint32_t, 2>* places;  ///< of the next cell's pairs
  BlockMatrix<dim>& hessian;

  template <class Real, std::size_t extent>
  SMOOTHFEM_INLINE void add(CellIndex first, const CellDerivatives<dim, Real, extent>& cell) {
    constexpr std::size_t lanes = sizeof(Real) / sizeof(double);
    const std::size_t n = cell.gradient.size(), n_pairs = n_node_pairs(n) - n;
    const NodeIndex* const nodes = topology.cell_nodes(first).data();
    CellArray<Block<dim, Real>, extent> factors(n);
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t l = 0; l < lanes; ++l) {
        const double* const factor = hessian.inverse_factor(unknown[nodes[l * n + p]]).data();
        for (std::size_t i = 0; i < dim * dim; ++i) set_lane(factors[p].entries[i], l, factor[i]);
      }
    const auto* pair = places;
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t q = p + 1; q < n; ++q, ++pair) {
        const auto blocks_of_cells = added_blocks<typename BlockMatrix<dim>::Number>(
            scaled<dim>(factors[p], cell.hessian[node_pair(n, p, q)], factors[q]));
        for (std::size_t l = 0; l < lanes; ++l) {
          const auto [right, left] = pair[l * n_pairs];
          if (right == nowhere) continue;
          blocks_of_cells[l].add_to(hessian.scaled_block(right));
          blocks_of_cells[l].transpose().add_to(hessian.scaled_block(left));
        }
      }
    places += lanes * n_pairs;
  }
};

template <int dim>
SMOOTHFEM_INLINE double sum_of_block(const Topology& topology, const std::vector<Point<dim>>& x,
                                     const CellBlock& block) {
  Lanes sums{};
  for_each_block<dim>(
      topology, x, block.first, block.last,
      [&]<std::size_t n>(CellIndex,
                         const std::array<Vector<dim, Lanes>, n>& corners) SMOOTHFEM_INLINE_LAMBDA {
        const Lanes mean = mean_inverse_mean_ratio(std::span<const Vector<dim, Lanes>, n>(corners));
        sums += mean * mean;
      },
      [&](CellIndex, auto corners) SMOOTHFEM_INLINE_LAMBDA {
        const double mean = mean_inverse_mean_ratio(corners);
        sums[0] += mean * mean;
      });
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

template <int dim, class Sums>
SMOOTHFEM_INLINE void add_block_derivatives(const std::vector<Point<dim>>& x,
                                            const CellBlock& block, HessianModel model, Sums sums) {
  for_each_block<dim>(
      sums.topology, x, block.first, block.last,
      [&]<std::size_t n>(CellIndex c, const std::array<Vector<dim, Lanes>, n>& corners)
          SMOOTHFEM_INLINE_LAMBDA {
            const std::span<const Vector<dim, Lanes>, n> nodes(corners);
            sums.add(c, CellDerivatives<dim, Lanes, n>(nodes, model, Sums::blocks));
          },
      [&]<std::size_t n>(CellIndex c, std::span<const Vector<dim, double>, n> nodes)
          SMOOTHFEM_INLINE_LAMBDA {
            sums.add(c, CellDerivatives<dim, double, n>(nodes, model, Sums::blocks));
          });
}

double value_of(const Topology& topology, const std::vector<Point<2>>& x, const CellBlock& block) {
  return sum_of_block<2>(topology, x, block);
}
double value_of(const Topology& topology, const std::vector<Point<3>>& x, const CellBlock& block) {
  return sum_of_block<3>(topology, x, block);
}
void add_derivatives(const std::vector<Point<2>>& x, const CellBlock& block, HessianModel model,
                     const DiagonalSums<2>& sums) {
  add_block_derivatives<2>(x, block, model, sums);
}
void add_derivatives(const std::vector<Point<3>>& x, const CellBlock& block, HessianModel model,
                     const DiagonalSums<3>& sums) {
  add_block_derivatives<3>(x, block, model, sums);
}
void add_derivatives(const std::vector<Point<2>>& x, const CellBlock& block, HessianModel model,
                     const OtherBlockSums<2>& sums) {
  add_block_derivatives<2>(x, block, model, sums);
}
void add_derivatives(const std::vector<Point<3>>& x, const CellBlock& block, HessianModel model,
                     const OtherBlockSums<3>& sums) {
  add_block_derivatives<3>(x, block, model, sums);
}

/// For each unknown those it shares a cell with.
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
ShapeObjective<dim>::ShapeObjective(std::shared_ptr<const Topology> topology)
    : topology_(std::move(topology)),
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
  places_.resize(topology_->blocks().size());
  parallel_for(places_.size(), [&](std::size_t b) {
    const CellBlock& block = topology_->blocks()[b];
    places_[b].clear();
    for (CellIndex c = block.first; c < block.last; ++c) {
      const auto nodes = topology_->cell_nodes(c);
      for (std::size_t p = 0; p < nodes.size(); ++p)
        for (std::size_t q = p + 1; q < nodes.size(); ++q) {
          const std::uint32_t i = unknown_[nodes[p]], j = unknown_[nodes[q]];
          if (i == fixed || j == fixed)
            places_[b].push_back({nowhere, nowhere});
          else
            places_[b].push_back({matrix.position(i, j), matrix.position(j, i)});
        }
    }
  });
  return matrix;
}

template <int dim>
double ShapeObjective<dim>::value(const std::vector<Point<dim>>& coordinates) const {
  std::vector<double> parts(topology_->blocks().size());
  parallel_for(parts.size(), [&](std::size_t b) {
    parts[b] = value_of(*topology_, coordinates, topology_->blocks()[b]);
  });
  double sum = 0.0;
  for (const double part : parts) sum += part;
  return sum;
}

template <int dim>
void ShapeObjective<dim>::derivatives(const std::vector<Point<dim>>& coordinates,
                                      HessianModel model, BlockVector<dim>& gradient,
                                      BlockMatrix<dim>& hessian) const {
  std::fill(gradient.begin(), gradient.end(), Point<dim>::Zero());
  hessian.start_diagonal();
  for_disjoint_blocks([&](std::size_t b) {
    add_derivatives(coordinates, topology_->blocks()[b], model,
                    DiagonalSums<dim>{*topology_, unknown_, gradient, hessian});
  });
  hessian.factor_diagonal();
  for_disjoint_blocks([&](std::size_t b) {
    add_derivatives(coordinates, topology_->blocks()[b], model,
                    OtherBlockSums<dim>{*topology_, unknown_, places_[b].data(), hessian});
  });
}

template class ShapeObjective<2>;
template class ShapeObjective<3>;

}  // namespace smoothfem
