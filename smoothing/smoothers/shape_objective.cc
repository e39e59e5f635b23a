#include "smoothing/smoothers/shape_objective.h"

#include "smoothing/mesh/cell_blocks.h"
#include "smoothing/smoothers/volume_cell_derivatives.h"

namespace smoothfem {

namespace {

/// Where a block goes: twice its position in the matrix, and one more if it has to be transposed.
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

/// The derivatives of some cells, added up where they belong. Each cell is added to the matrix in
/// the order of the cells, so sums have one order.
template <int dim>
struct Derivatives {
  const Topology& topology;
  const std::vector<std::uint32_t>& unknown;
  const std::uint32_t* places;  ///< of the next cell's blocks
  BlockVector<dim>& gradient;
  BlockMatrix<dim>& hessian;

  /// first: the first of as many cells as Real has lanes.
  template <class Real, std::size_t extent>
  SMOOTHFEM_INLINE void add(CellIndex first, const CellDerivatives<dim, Real, extent>& cell) {
    constexpr std::size_t lanes = sizeof(Real) / sizeof(double);
    const std::size_t n = cell.gradient.size(), n_pairs = n_node_pairs(n);
    const NodeIndex* const nodes = topology.cell_nodes(first).data();
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t l = 0; l < lanes; ++l) {
        const std::uint32_t row = unknown[nodes[l * n + p]];
        if (row < gradient.size()) gradient[row] += lane_of(cell.gradient[p], l);
      }
    for (std::size_t k = 0; k < n_pairs; ++k) {
      const auto of_cell = blocks_by_cell(cell.hessian[k]);
      for (std::size_t l = 0; l < lanes; ++l) {
        const std::uint32_t place = places[l * n_pairs + k];
        if (place != nowhere)
          add_block(of_cell[l], place % 2 != 0, hessian.block(place / 2).data());
      }
    }
    places += lanes * n_pairs;
  }

 private:
  /// The entries of one block, n_lanes at a time, and the last of an odd number.
  struct Entries {
    Lanes first, second;
    double last;
  };

  static SMOOTHFEM_INLINE auto blocks_by_cell(const Block<dim, Lanes>& block) {
    const auto& m = block.entries;
    const auto first = transposed(m[0], m[1], m[2], m[3]);
    std::array<Entries, n_lanes> result{};
    for (std::size_t l = 0; l < n_lanes; ++l) result[l].first = first[l];
    if constexpr (dim == 3) {
      const auto second = transposed(m[4], m[5], m[6], m[7]);
      for (std::size_t l = 0; l < n_lanes; ++l) {
        result[l].second = second[l];
        result[l].last = m[8][l];
      }
    }
    return result;
  }
  static SMOOTHFEM_INLINE std::array<Entries, 1> blocks_by_cell(const Block<dim, double>& block) {
    const auto& m = block.entries;
    Entries result{load_lanes(m.data()), {}, 0.0};
    if constexpr (dim == 3) {
      result.second = load_lanes(m.data() + n_lanes);
      result.last = m[8];
    }
    return {result};
  }

  static SMOOTHFEM_INLINE void add_block(const Entries& e, bool transpose, double* sum) {
    Lanes first = e.first, second = e.second;
    if constexpr (dim == 2) {
      if (transpose) first = __builtin_shufflevector(first, first, 0, 2, 1, 3);
    } else {
      if (transpose) {
        first = __builtin_shufflevector(e.first, e.second, 0, 3, 6, 1);
        second = __builtin_shufflevector(e.first, e.second, 4, 7, 2, 5);
      }
      store_lanes(load_lanes(sum + n_lanes) + second, sum + n_lanes);
      sum[2 * n_lanes] += e.last;
    }
    store_lanes(load_lanes(sum) + first, sum);
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

template <int dim>
SMOOTHFEM_INLINE void add_block_derivatives(const std::vector<Point<dim>>& x,
                                            const CellBlock& block, HessianModel model,
                                            Derivatives<dim> sums) {
  for_each_block<dim>(
      sums.topology, x, block.first, block.last,
      [&]<std::size_t n>(CellIndex c, const std::array<Vector<dim, Lanes>, n>& corners)
          SMOOTHFEM_INLINE_LAMBDA {
            const std::span<const Vector<dim, Lanes>, n> nodes(corners);
            sums.add(c, CellDerivatives<dim, Lanes, n>(nodes, model));
          },
      [&]<std::size_t n>(CellIndex c, std::span<const Vector<dim, double>, n> nodes)
          SMOOTHFEM_INLINE_LAMBDA { sums.add(c, CellDerivatives<dim, double, n>(nodes, model)); });
}

// Templates cannot be compiled for several kinds of registers; these can.
SMOOTHFEM_VECTOR_CLONES
double value_of(const Topology& topology, const std::vector<Point<2>>& x, const CellBlock& block) {
  return sum_of_block<2>(topology, x, block);
}
SMOOTHFEM_VECTOR_CLONES
double value_of(const Topology& topology, const std::vector<Point<3>>& x, const CellBlock& block) {
  return sum_of_block<3>(topology, x, block);
}
SMOOTHFEM_VECTOR_CLONES
void add_derivatives(const std::vector<Point<2>>& x, const CellBlock& block, HessianModel model,
                     const Derivatives<2>& sums) {
  add_block_derivatives<2>(x, block, model, sums);
}
SMOOTHFEM_VECTOR_CLONES
void add_derivatives(const std::vector<Point<3>>& x, const CellBlock& block, HessianModel model,
                     const Derivatives<3>& sums) {
  add_block_derivatives<3>(x, block, model, sums);
}

/// For each unknown those it shares a cell with.
CompressedRows<std::uint32_t> coupled_unknowns(const Topology& topology,
                                               const std::vector<std::uint32_t>& unknown) {
  const auto& free_nodes = topology.free_nodes();
  std::vector<std::vector<std::uint32_t>> parts((free_nodes.size() + row_grain - 1) / row_grain);
  std::vector<std::size_t> offsets(free_nodes.size() + 1, 0);
  for_row_ranges(free_nodes.size(), [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> row;
    auto& part = parts[first / row_grain];
    for (std::size_t i = first; i < last; ++i) {
      row.clear();
      for (const CellIndex c : topology.node_cells(free_nodes[i]))
        for (const NodeIndex j : topology.cell_nodes(c))
          if (unknown[j] < free_nodes.size()) row.push_back(unknown[j]);
      std::sort(row.begin(), row.end());
      const auto end = std::unique(row.begin(), row.end());
      part.insert(part.end(), row.begin(), end);
      offsets[i + 1] = static_cast<std::size_t>(end - row.begin());
    }
  });
  std::vector<std::uint32_t> columns;
  for (const auto& part : parts) columns.insert(columns.end(), part.begin(), part.end());
  for (std::size_t i = 0; i < free_nodes.size(); ++i) offsets[i + 1] += offsets[i];
  return {std::move(offsets), std::move(columns)};
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
        for (std::size_t q = p; q < nodes.size(); ++q) {
          const std::uint32_t i = unknown_[nodes[p]], j = unknown_[nodes[q]];
          places_[b].push_back(i == fixed || j == fixed
                                   ? nowhere
                                   : 2 * matrix.position(std::min(i, j), std::max(i, j)) + (i > j));
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
  hessian.set_zero();
  for (const auto& group : groups_)
    parallel_for(group.size(), [&](std::size_t i) {
      const std::size_t b = group[i];
      add_derivatives(coordinates, topology_->blocks()[b], model,
                      {*topology_, unknown_, places_[b].data(), gradient, hessian});
    });
}

template class ShapeObjective<2>;
template class ShapeObjective<3>;

}  // namespace smoothfem
