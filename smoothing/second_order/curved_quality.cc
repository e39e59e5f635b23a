// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/second_order/curved_quality.h"

#include <algorithm>
#include <limits>

#include "smoothing/base/parallel.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/quality/target_corners.h"
#include "smoothing/second_order/shape_functions.h"

namespace smoothfem {

namespace {

/// The corners of a cell, and the midside node of each edge.
template <int dim, std::size_t n, std::size_t n_edges>
struct CornersAndEdges {
  std::array<Vector<dim, double>, n> corners;
  std::array<Vector<dim, double>, n_edges> middles;

  explicit CornersAndEdges(std::span<const Point<dim>> points) {
    for (std::size_t k = 0; k < n; ++k) corners[k] = vector_of(points[k]);
    for (std::size_t e = 0; e < n_edges; ++e) middles[e] = vector_of(points[n + e]);
  }

  /// Tangent of an edge at its end `from`, as long as a straight edge with the same derivative:
  /// the straight edge, and four times the distance of the midside node from its middle.
  Vector<dim, double> tangent(std::size_t from, std::size_t to, std::size_t edge) const {
    const auto to_middle = middles[edge] - corners[from];
    const auto straight = corners[to] - corners[from];
    return straight + 4.0 * (to_middle - 0.5 * straight);
  }
};

/// Mean over the corners of a planar cell that is valid.
template <std::size_t n>
double mean_over_corners(std::span<const Point<2>> points) {
  const CornersAndEdges<2, n, n> cell(points);
  const RegularAngle regular = regular_interior_angle(n);
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t before = k == 0 ? n - 1 : k - 1;
    const auto next = cell.tangent(k, k + 1 == n ? 0 : k + 1, k);
    const auto previous = cell.tangent(k, before, before);
    sum += corner_mean_ratio(next, previous, cross(next, previous), regular);
  }
  return sum / static_cast<double>(n);
}

/// Corner k of the volume element with n nodes, and its neighbours, oriented as in `corners` of
/// VolumeElement. That has one corner of the tetrahedron only.
template <std::size_t n>
inline constexpr auto all_corners = VolumeElement<n>::corners;
template <>
inline constexpr std::array<LocalSimplex, 4> all_corners<4>{
    {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}}};

/// Mean over the corners of a volume cell that is valid.
template <std::size_t n>
double mean_over_corners(std::span<const Point<3>> points) {
  const CornersAndEdges<3, n, VolumeElement<n>::edges.size()> cell(points);
  constexpr std::size_t n_corners = all_corners<n>.size();
  double sum = 0.0;
  unrolled<n_corners>([&](auto k) {
    constexpr LocalSimplex corner = all_corners<n>[k];
    constexpr std::size_t a = edge_between<n>(corner[0], corner[1]).index,
                          b = edge_between<n>(corner[0], corner[2]).index,
                          c = edge_between<n>(corner[0], corner[3]).index;
    // The corner of a straight cell; its other nodes do not matter.
    constexpr std::size_t straight_corner = n == 4 ? 0 : k;
    constexpr LocalSimplex straight = VolumeElement<n>::corners[straight_corner];
    std::array<Vector3<double>, n> nodes{};
    nodes[straight[1]] = cell.tangent(corner[0], corner[1], a);
    nodes[straight[2]] = cell.tangent(corner[0], corner[2], b);
    nodes[straight[3]] = cell.tangent(corner[0], corner[3], c);
    const auto [determinant, squared_norm] = corner_shape<straight_corner>(
        CellEdges<double, n>(std::span<const Vector3<double>, n>(nodes)));
    sum += determinant * inverse_root<3>(determinant) / squared_norm;
  });
  return sum * (3.0 / static_cast<double>(n_corners));
}

/// The nodes of one cell.
template <int dim>
class CellPoints {
 public:
  CellPoints(const Mesh<dim>& mesh, CellIndex cell) {
    for (const auto nodes : {mesh.topology().cell_nodes(cell), mesh.topology().midside_nodes(cell)})
      for (const NodeIndex node : nodes) points_[n_++] = mesh.coordinates()[node];
  }

  /// Adds midside nodes in the middle of all edges of a linear cell.
  void raise_order() {
    const std::size_t n_corners = n_;
    for_each_edge(dim, n_corners, [&](std::size_t a, std::size_t b) {
      points_[n_++] = 0.5 * points_[a] + 0.5 * points_[b];
    });
  }

  /// Maps the points to where the cell's target is regular.
  void map_to_regular(const CellTargets<dim>& targets, CellIndex cell) {
    const auto map = linear_map<TargetMap::to_regular>(targets, cell);
    for (std::size_t k = 0; k < n_; ++k) points_[k] = point_of(map(vector_of(points_[k])));
  }

  /// True for triangles and tetrahedra whose midside nodes are in the middle of straight edges, up
  /// to the rounding of decimal numbers.
  bool is_straight_simplex() const {
    constexpr std::size_t n_corners = dim + 1, n_edges = dim * (dim + 1) / 2;
    constexpr double rounding = 1e-24;  // of squares
    if (n_ != n_corners + n_edges) return false;
    std::size_t k = n_corners;
    bool is_straight = true;
    for_each_edge(dim, n_corners, [&](std::size_t a, std::size_t b) {
      const Point<dim> offset = points_[k++] - 0.5 * (points_[a] + points_[b]);
      is_straight =
          is_straight && offset.squaredNorm() <= rounding * (points_[b] - points_[a]).squaredNorm();
    });
    return is_straight;
  }

  operator std::span<const Point<dim>>() const { return {points_.data(), n_}; }

 private:
  std::array<Point<dim>, max_second_order_nodes> points_;
  std::size_t n_ = 0;
};

template <int dim>
bool is_curved(const Mesh<dim>& mesh, CellIndex cell) {
  return !mesh.topology().midside_nodes(cell).empty();
}

/// Returns of_cell(c) for every cell.
template <class OfCell>
std::vector<double> for_cells(const Topology& topology, const OfCell& of_cell) {
  std::vector<double> numbers(topology.n_cells());
  parallel_for(topology.blocks().size(), [&](std::size_t b) {
    const CellBlock& block = topology.blocks()[b];
    for (CellIndex c = block.first; c < block.last; ++c) numbers[c] = of_cell(c);
  });
  return numbers;
}

/// Interval of a / b for a <= b in absolute value, b >= 0, within [-1, 1].
Interval ratio(Interval a, Interval b) {
  const auto divide = [](double x, double y, double otherwise) {
    return y > 0.0 ? x / y : otherwise;
  };
  return {std::max(-1.0, divide(a.lower, a.lower >= 0.0 ? b.upper : b.lower, -1.0)),
          std::min(1.0, divide(a.upper, a.upper >= 0.0 ? b.lower : b.upper, 1.0))};
}

}  // namespace

template <int dim>
double curved_mean_ratio(std::span<const Point<dim>> points) {
  if (!is_proven_valid(points)) return 0.0;
  double q = 0.0;
  with_cell_size<dim>(second_order_types[second_order_type(dim, points.size())].n_corners,
                      [&](auto n) {
                        if constexpr (n > 0) q = mean_over_corners<n>(points);
                      });
  return zero_unless_finite(q);
}

template <int dim>
Interval scaled_jacobian(std::span<const Point<dim>> points, double tolerance) {
  const auto [minimum, maximum] = jacobian_bounds(JacobianPolynomial<dim>(points), tolerance);
  return ratio(minimum,
               {std::max(maximum.lower, -minimum.upper), std::max(maximum.upper, -minimum.lower)});
}

template <int dim>
double curved_cell_size(std::span<const Point<dim>> points) {
  return JacobianPolynomial<dim>(points).cell_size();
}

template <int dim>
double curved_mean_ratio(const Mesh<dim>& mesh, CellIndex cell) {
  CellPoints<dim> points(mesh, cell);
  if (mesh.targets() == nullptr) {
    if (points.is_straight_simplex())
      if (const double q = cell_mean_ratio(mesh, cell); q > well_above_rounding_errors) return q;
    return curved_mean_ratio<dim>(points);
  }
  points.map_to_regular(*mesh.targets(), cell);
  double q = curved_mean_ratio<dim>(points);
  with_target_corners(mesh, cell, coordinates_at(mesh.coordinates().data()), [&](auto corners) {
    q = within_size_bound<dim>(mesh.targets(), corners, q);
  });
  return q;
}

template <int dim, int spacedim>
std::vector<double> curved_mean_ratios(const Mesh<dim, spacedim>& mesh) {
  return for_cells(mesh.topology(), [&](CellIndex c) {
    if constexpr (dim == spacedim)
      if (is_curved(mesh, c)) return curved_mean_ratio(mesh, c);
    return cell_mean_ratio(mesh, c);
  });
}

template <int dim>
std::vector<double> scaled_jacobians(const Mesh<dim>& mesh, double tolerance) {
  return for_cells(mesh.topology(), [&](CellIndex c) {
    if (mesh.topology().cell_type(c) == ElementType::polygon)
      return std::numeric_limits<double>::quiet_NaN();
    CellPoints<dim> points(mesh, c);
    if (!is_curved(mesh, c)) points.raise_order();
    return scaled_jacobian<dim>(points, tolerance).lower;
  });
}

template <int dim>
std::vector<double> curved_cell_sizes(const Mesh<dim>& mesh) {
  return for_cells(mesh.topology(), [&](CellIndex c) {
    return is_curved(mesh, c) ? curved_cell_size<dim>(CellPoints<dim>(mesh, c))
                              : signed_cell_size(mesh, c);
  });
}

#define SMOOTHFEM_INSTANTIATE(DIM)                                         \
  template double curved_mean_ratio(std::span<const Point<DIM>>);          \
  template double curved_mean_ratio(const Mesh<DIM>&, CellIndex);          \
  template Interval scaled_jacobian(std::span<const Point<DIM>>, double);  \
  template double curved_cell_size(std::span<const Point<DIM>>);           \
  template std::vector<double> curved_mean_ratios(const Mesh<DIM>&);       \
  template std::vector<double> scaled_jacobians(const Mesh<DIM>&, double); \
  template std::vector<double> curved_cell_sizes(const Mesh<DIM>&);
SMOOTHFEM_INSTANTIATE(2)
SMOOTHFEM_INSTANTIATE(3)
#undef SMOOTHFEM_INSTANTIATE
template std::vector<double> curved_mean_ratios(const SurfaceMesh&);

}  // namespace smoothfem
