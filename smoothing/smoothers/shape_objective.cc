#include "smoothing/smoothers/shape_objective.h"

#include "smoothing/mesh/cell_blocks.h"
#include "smoothing/smoothers/cell_derivatives.h"

namespace smoothfem {

namespace {

/// Mean inverse mean ratio of the corners; infinite if a corner's determinant is not positive.
template <class Real, std::size_t extent>
SMOOTHFEM_INLINE Real mean_inverse_mean_ratio(std::span<const Vector2<Real>, extent> x) {
  const std::size_t n = x.size(), n_corners = n == 3 ? 1 : n;
  const RegularAngle regular = regular_interior_angle(n);
  const Real infinite = Real{} + std::numeric_limits<double>::infinity();
  Real sum{};
  for (std::size_t k = 0; k < n_corners; ++k) {
    const auto next = x[k + 1 == n ? 0 : k + 1] - x[k];
    const auto previous = x[k == 0 ? n - 1 : k - 1] - x[k];
    const Real determinant = cross(next, previous);
    const Real ratio = (squared_length(next) + squared_length(previous) -
                        2.0 * regular.cosine * dot(next, previous)) /
                       (2.0 * regular.sine * determinant);
    sum += determinant > 0.0 ? ratio : infinite;
  }
  return sum / static_cast<double>(n_corners);
}

/// One block of several cells, entry by entry, as the blocks of the cells.
SMOOTHFEM_INLINE std::array<Lanes, n_lanes> blocks_by_cell(const Block2<Lanes>& m) {
  const Lanes low01 = __builtin_shufflevector(m.m00, m.m10, 0, 4, 2, 6);
  const Lanes high01 = __builtin_shufflevector(m.m00, m.m10, 1, 5, 3, 7);
  const Lanes low23 = __builtin_shufflevector(m.m01, m.m11, 0, 4, 2, 6);
  const Lanes high23 = __builtin_shufflevector(m.m01, m.m11, 1, 5, 3, 7);
  return {__builtin_shufflevector(low01, low23, 0, 1, 4, 5),
          __builtin_shufflevector(high01, high23, 0, 1, 4, 5),
          __builtin_shufflevector(low01, low23, 2, 3, 6, 7),
          __builtin_shufflevector(high01, high23, 2, 3, 6, 7)};
}
SMOOTHFEM_INLINE std::array<Lanes, 1> blocks_by_cell(const Block2<double>& m) {
  return {Lanes{m.m00, m.m10, m.m01, m.m11}};
}

SMOOTHFEM_INLINE double lane(double value, std::size_t) {
  return value;
}
SMOOTHFEM_INLINE double lane(Lanes value, std::size_t l) {
  return value[l];
}

}  // namespace

ShapeObjective::ShapeObjective(std::shared_ptr<const Topology> topology)
    : topology_(std::move(topology)),
      unknown_(topology_->n_nodes(), static_cast<std::uint32_t>(topology_->free_nodes().size())) {
  std::uint32_t next = 0;
  for (const NodeIndex i : topology_->free_nodes()) unknown_[i] = next++;
  build_pattern();
}

void ShapeObjective::build_pattern() {
  std::vector<std::uint32_t> row;
  const auto fixed = static_cast<std::uint32_t>(n_unknown_nodes());
  for (const NodeIndex i : topology_->free_nodes()) {
    row.clear();
    for (const CellIndex c : topology_->node_cells(i))
      for (const NodeIndex j : topology_->cell_nodes(c))
        if (unknown_[j] != fixed) row.push_back(unknown_[j]);
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    pattern_.append(row);
  }
  const BlockMatrix matrix = make_hessian();
  for (CellIndex c = 0; c < topology_->n_cells(); ++c) {
    row.clear();
    for (const NodeIndex i : topology_->cell_nodes(c))
      for (const NodeIndex j : topology_->cell_nodes(c))
        row.push_back(unknown_[i] == fixed || unknown_[j] == fixed
                          ? matrix.unused_position()
                          : matrix.position(unknown_[i], unknown_[j]));
    block_positions_.append(row);
  }
}

BlockMatrix ShapeObjective::make_hessian() const {
  BlockMatrix matrix;
  matrix.set_pattern(pattern_);
  return matrix;
}

SMOOTHFEM_VECTOR_CLONES
double ShapeObjective::value(const std::vector<Point<2>>& coordinates) const {
  Lanes sums{};
  for_each_block<2>(
      *topology_, coordinates,
      [&]<std::size_t n>(CellIndex, const std::array<Vector2<Lanes>, n>& corners)
          SMOOTHFEM_INLINE_LAMBDA {
            const Lanes mean = mean_inverse_mean_ratio(std::span(corners));
            sums += mean * mean;
          },
      [&](CellIndex, auto corners) SMOOTHFEM_INLINE_LAMBDA {
        const double mean = mean_inverse_mean_ratio(corners);
        sums[0] += mean * mean;
      });
  return sum_of(sums);
}

/// Adds the derivatives of as many cells as Real has lanes. Each is added to the matrix in the
/// order of the cells, so sums have one order.
template <class Real, std::size_t extent>
SMOOTHFEM_INLINE void ShapeObjective::scatter(CellIndex first,
                                              const CellDerivatives<Real, extent>& cell,
                                              BlockVector& gradient, BlockMatrix& hessian) const {
  const std::size_t n = cell.gradient.size(), lanes = sizeof(Real) / sizeof(double);
  const std::uint32_t* const positions = block_positions_[first].data();
  const NodeIndex* const nodes = topology_->cell_nodes(first).data();
  BlockMatrix::Block* const blocks = hessian.blocks();
  for (std::size_t p = 0; p < n; ++p) {
    for (std::size_t l = 0; l < lanes; ++l)
      gradient[unknown_[nodes[l * n + p]]] +=
          Point<2>(lane(cell.gradient[p].x, l), lane(cell.gradient[p].y, l));
    for (std::size_t q = p; q < n; ++q) {
      const auto of_cell = blocks_by_cell(cell.hessian[p * n + q]);
      for (std::size_t l = 0; l < lanes; ++l) {
        const Lanes block = of_cell[l];
        const std::uint32_t* const at = positions + l * n * n;
        blocks[at[p * n + q]].add(block);
        if (p != q) blocks[at[q * n + p]].add(__builtin_shufflevector(block, block, 0, 2, 1, 3));
      }
    }
  }
}

SMOOTHFEM_VECTOR_CLONES
void ShapeObjective::derivatives(const std::vector<Point<2>>& coordinates, HessianModel model,
                                 BlockVector& gradient, BlockMatrix& hessian) const {
  std::fill(gradient.begin(), gradient.end(), Point<2>(0.0, 0.0));
  hessian.set_zero();
  const std::array known_weights{corner_weights(3), corner_weights(4)};
  for_each_block<2>(
      *topology_, coordinates,
      [&]<std::size_t n>(CellIndex c,
                         const std::array<Vector2<Lanes>, n>& corners) SMOOTHFEM_INLINE_LAMBDA {
        const std::span<const Vector2<Lanes>, n> x(corners);
        scatter(c, CellDerivatives<Lanes, n>(x, known_weights[n - 3], model), gradient, hessian);
      },
      [&]<std::size_t n>(CellIndex c, std::span<const Vector2<double>, n> x)
          SMOOTHFEM_INLINE_LAMBDA {
            const CornerWeights& weights =
                x.size() <= 4 ? known_weights[x.size() - 3] : corner_weights(x.size());
            scatter(c, CellDerivatives<double, n>(x, weights, model), gradient, hessian);
          });
  gradient[n_unknown_nodes()].setZero();
}

}  // namespace smoothfem
