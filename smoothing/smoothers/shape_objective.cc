#include "smoothing/smoothers/shape_objective.h"

#include "smoothing/mesh/cell_blocks.h"
#include "smoothing/quality/inverse_mean_ratio.h"

namespace smoothfem {

namespace {

constexpr std::uint32_t absent = BlockMatrix<2>::absent;

/// A triangle's corners all have the same mean ratio: one stands for the three.
std::size_t n_distinct_corners(std::size_t n_nodes) {
  return n_nodes == 3 ? 1 : n_nodes;
}

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
    const Real q = corner_mean_ratio(next, previous, regular);
    sum += q > 0.0 ? 1.0 / q : infinite;
  }
  return sum / static_cast<double>(n_corners);
}

/// Gradient and Hessian of one cell's squared mean, dense over its nodes: entries 2k, 2k + 1 of
/// node k.
template <int size>
struct CellDerivatives {
  Eigen::Matrix<double, size, 1> gradient;
  Eigen::Matrix<double, size, size> hessian;

  void compute(const std::vector<Point<2>>& x, std::span<const NodeIndex> nodes) {
    const std::size_t n = nodes.size(), n_corners = n_distinct_corners(n);
    const CornerCoefficients coefficients = corner_coefficients(n);
    gradient.setZero(2 * static_cast<Eigen::Index>(n));
    hessian.setZero(gradient.size(), gradient.size());
    double mean = 0.0;
    for (std::size_t k = 0; k < n_corners; ++k)
      mean +=
          add_corner({k, k + 1 == n ? 0 : k + 1, k == 0 ? n - 1 : k - 1}, x, nodes, coefficients);
    const double share = 1.0 / static_cast<double>(n_corners);
    mean *= share;
    gradient *= share;
    hessian *= 2.0 * mean * share;
    hessian.noalias() += 2.0 * gradient * gradient.transpose();
    gradient *= 2.0 * mean;
  }

 private:
  double add_corner(const std::array<std::size_t, 3>& places, const std::vector<Point<2>>& x,
                    std::span<const NodeIndex> nodes, const CornerCoefficients& coefficients) {
    Eigen::Vector4d s = Eigen::Vector4d::Zero();
    for (int a = 0; a < 3; ++a) {
      s.head<2>() += coefficients.first[a] * x[nodes[places[a]]];
      s.tail<2>() += coefficients.second[a] * x[nodes[places[a]]];
    }
    const InverseMeanRatio corner = inverse_mean_ratio(s);
    Eigen::Matrix<double, 2, 4> rows;  // of the Hessian of a node's place against s
    for (int a = 0; a < 3; ++a) {
      const double a1 = coefficients.first[a], a2 = coefficients.second[a];
      const auto row = 2 * static_cast<Eigen::Index>(places[a]);
      gradient.template segment<2>(row) +=
          a1 * corner.gradient.head<2>() + a2 * corner.gradient.tail<2>();
      rows = a1 * corner.hessian.topRows<2>() + a2 * corner.hessian.bottomRows<2>();
      for (int b = 0; b < 3; ++b)
        hessian.template block<2, 2>(row, 2 * static_cast<Eigen::Index>(places[b])) +=
            coefficients.first[b] * rows.leftCols<2>() +
            coefficients.second[b] * rows.rightCols<2>();
    }
    return corner.value;
  }
};

}  // namespace

ShapeObjective::ShapeObjective(std::shared_ptr<const Topology> topology)
    : topology_(std::move(topology)), unknown_(topology_->n_nodes(), absent) {
  std::uint32_t next = 0;
  for (const NodeIndex i : topology_->free_nodes()) unknown_[i] = next++;
  build_pattern();
}

void ShapeObjective::build_pattern() {
  std::vector<std::uint32_t> row;
  for (const NodeIndex i : topology_->free_nodes()) {
    row.clear();
    for (const CellIndex c : topology_->node_cells(i))
      for (const NodeIndex j : topology_->cell_nodes(c))
        if (unknown_[j] != absent) row.push_back(unknown_[j]);
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    pattern_.append(row);
  }
  const BlockMatrix<2> matrix = make_hessian();
  for (CellIndex c = 0; c < topology_->n_cells(); ++c) {
    row.clear();
    for (const NodeIndex i : topology_->cell_nodes(c))
      for (const NodeIndex j : topology_->cell_nodes(c))
        row.push_back(unknown_[i] == absent || unknown_[j] == absent
                          ? absent
                          : matrix.position(unknown_[i], unknown_[j]));
    block_positions_.append(row);
  }
}

BlockMatrix<2> ShapeObjective::make_hessian() const {
  BlockMatrix<2> matrix;
  matrix.set_pattern(pattern_);
  return matrix;
}

SMOOTHFEM_VECTOR_CLONES
double ShapeObjective::value(const std::vector<Point<2>>& coordinates) const {
  double sum = 0.0;
  for_each_block(
      *topology_, coordinates,
      [&]<std::size_t n>(CellIndex, const std::array<Vector2<Lanes>, n>& corners)
          SMOOTHFEM_INLINE_LAMBDA {
            const Lanes mean = mean_inverse_mean_ratio(std::span(corners));
            for (std::size_t l = 0; l < n_lanes; ++l) sum += mean[l] * mean[l];
          },
      [&](CellIndex, auto corners) SMOOTHFEM_INLINE_LAMBDA {
        const double mean = mean_inverse_mean_ratio(corners);
        sum += mean * mean;
      });
  return sum;
}

void ShapeObjective::derivatives(const std::vector<Point<2>>& coordinates, Vector& gradient,
                                 BlockMatrix<2>& hessian) const {
  std::fill(gradient.begin(), gradient.end(), Point<2>::Zero());
  hessian.set_zero();
  const auto add_cell = [&](CellIndex c, auto& cell) {
    const auto nodes = topology_->cell_nodes(c);
    cell.compute(coordinates, nodes);
    const auto positions = block_positions_[c];
    for (std::size_t a = 0, p = 0; a < nodes.size(); ++a) {
      const auto row = 2 * static_cast<Eigen::Index>(a);
      if (unknown_[nodes[a]] != absent)
        gradient[unknown_[nodes[a]]] += cell.gradient.template segment<2>(row);
      for (std::size_t b = 0; b < nodes.size(); ++b, ++p)
        if (positions[p] != absent)
          hessian.block(positions[p]) +=
              cell.hessian.template block<2, 2>(row, 2 * static_cast<Eigen::Index>(b));
    }
  };
  CellDerivatives<6> triangle;
  CellDerivatives<8> quadrilateral;
  CellDerivatives<Eigen::Dynamic> polygon;
  for (CellIndex c = 0; c < topology_->n_cells(); ++c) {
    if (!topology_->has_free_node(c)) continue;
    switch (topology_->cell_type(c)) {
      case ElementType::triangle:
        add_cell(c, triangle);
        break;
      case ElementType::quadrilateral:
        add_cell(c, quadrilateral);
        break;
      case ElementType::polygon:
        add_cell(c, polygon);
        break;
    }
  }
}

}  // namespace smoothfem
