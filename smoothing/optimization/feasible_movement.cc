// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimization/feasible_movement.h"

#include <limits>

#include "smoothing/base/parallel.h"
#include "smoothing/mesh/volume_elements.h"
#include "smoothing/simd/cells.h"

namespace smoothfem {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Returns the smallest t in (0, 1] where constant + linear t + quadratic t^2 + cubic t^3 is zero
/// (constant > 0), or a lower bound of it. Returns a larger number if there is none. Each step
/// takes the quadratic with the polynomial's value and slope at t and the polynomial's lowest
/// curvature between t and 1. It is nowhere above the polynomial, and its root is the next t. If
/// the polynomial is quadratic, the first step finds the root. Otherwise steps converge to it
/// quadratically from below.
template <int n_steps, class Real>
inline Real smallest_root(Real constant, Real linear, Real quadratic, Real cubic) {
  const Real infinite = Real{} + unlimited;
  Real t{};
  for (int step = 0; step < n_steps; ++step) {
    const Real value = constant + t * (linear + t * (quadratic + t * cubic));
    const Real slope = linear + t * (2.0 * quadratic + 3.0 * t * cubic);
    const Real here = quadratic + 3.0 * t * cubic, there = quadratic + 3.0 * cubic;
    const Real half_curvature = here < there ? here : there;
    const Real discriminant = slope * slope - 4.0 * half_curvature * value;
    const Real root = square_root(discriminant > 0.0 ? discriminant : Real{});
    // This form avoids cancellation where the polynomial falls.
    const Real denominator = root - slope;
    const Real length = 2.0 * value / denominator;
    const Real falls = denominator > 0.0 ? length : infinite;
    const Real ahead = discriminant >= 0.0 ? falls : infinite;
    // Rounding may have moved t to the root already.
    t += value > 0.0 ? ahead : Real{};
  }
  return t;
}

/// Returns the smallest t > 0 where a corner's determinant has fallen to 1 - fraction of its value
/// at 0; more than 1 if there is none up to 1. Takes the edges from the corner and their changes up
/// to t = 1.
template <class Real>
inline Real corner_limit(const std::array<Vector2<Real>, 2>& edges,
                         const std::array<Vector2<Real>, 2>& changes, double fraction) {
  const auto [a, b] = edges;
  const auto [da, db] = changes;
  return smallest_root<1>(fraction * cross(a, b), cross(da, b) + cross(a, db), cross(da, db),
                          Real{});
}
template <class Real>
inline Real corner_limit(const std::array<Vector3<Real>, 3>& edges,
                         const std::array<Vector3<Real>, 3>& changes, double fraction) {
  const auto [a, b, c] = edges;
  const auto [da, db, dc] = changes;
  const auto bc = cross(b, c), dbc = cross(db, c) + cross(b, dc), dbdc = cross(db, dc);
  return smallest_root<4>(fraction * dot(a, bc), dot(da, bc) + dot(a, dbc),
                          dot(da, dbc) + dot(a, dbdc), dot(da, dbdc));
}

template <class Real>
inline Real smaller(Real a, Real b) {
  return b < a ? b : a;
}

/// Returns the smallest limit of a cell's corners; x, y: its nodes at the start and at the end.
template <class Real, std::size_t extent>
inline Real cell_limit(std::span<const Vector2<Real>, extent> x,
                       std::span<const Vector2<Real>, extent> y, double fraction) {
  const std::size_t n = x.size(), n_corners = n == 3 ? 1 : n;
  Real smallest = Real{} + unlimited;
  for (std::size_t k = 0; k < n_corners; ++k) {
    const std::size_t after = k + 1 == n ? 0 : k + 1, before = k == 0 ? n - 1 : k - 1;
    const std::array edges{x[after] - x[k], x[before] - x[k]};
    const std::array changes{(y[after] - y[k]) - edges[0], (y[before] - y[k]) - edges[1]};
    smallest = smaller(smallest, corner_limit(edges, changes, fraction));
  }
  return smallest;
}
template <class Real, std::size_t n>
inline Real cell_limit(std::span<const Vector3<Real>, n> x, std::span<const Vector3<Real>, n> y,
                       double fraction) {
  Real smallest = Real{} + unlimited;
  for (const LocalSimplex& corner : VolumeElement<n>::corners) {
    std::array<Vector3<Real>, 3> edges, changes;
    for (std::size_t i = 0; i < 3; ++i) {
      edges[i] = x[corner[i + 1]] - x[corner[0]];
      changes[i] = (y[corner[i + 1]] - y[corner[0]]) - edges[i];
    }
    smallest = smaller(smallest, corner_limit(edges, changes, fraction));
  }
  return smallest;
}

template <int dim>
double limit_block(const Topology& topology, std::span<const Point<dim>> from,
                   std::span<const Point<dim>> to, double fraction, const CellBlock& block,
                   std::vector<double>& limits) {
  double smallest = 1.0;
  const auto lower = [&](CellIndex c, double limit) {
    limits[c] = std::min(limit, 1.0);
    smallest = std::min(smallest, limit);
  };
  for_each_batch<dim>(
      topology, block.first, block.last,
      [&]<std::size_t n>(const CellBatch<n>& batch) {
        using Nodes = std::span<const Vector<dim, Lanes>, n>;
        const auto x = batch.template corners<dim>(from.data());
        const auto y = batch.template corners<dim>(to.data());
        const Lanes limit = cell_limit(Nodes(x), Nodes(y), fraction);
        batch.for_each_lane([&](std::size_t l) { lower(batch.cells[l], limit[l]); });
      },
      [&](CellIndex c) {
        if constexpr (dim == 2) {
          const auto nodes = topology.cell_nodes(c);
          with_polygon(nodes, from.data(), [&](auto x) {
            with_polygon(nodes, to.data(), [&](auto y) { lower(c, cell_limit(x, y, fraction)); });
          });
        }
      });
  return smallest;
}

}  // namespace

template <int dim>
double feasible_fractions(const Topology& topology, std::span<const Point<dim>> from,
                          std::span<const Point<dim>> to, double fraction,
                          std::vector<double>& limits) {
  constexpr std::size_t grain = 16384;
  std::vector<double> of_cells(topology.n_cells()), parts(topology.blocks().size());
  parallel_for(parts.size(), [&](std::size_t b) {
    parts[b] = limit_block<dim>(topology, from, to, fraction, topology.blocks()[b], of_cells);
  });
  limits.assign(topology.n_nodes(), 1.0);
  const double smallest = *std::min_element(parts.begin(), parts.end());
  if (smallest < 1.0)
    parallel_for_ranges(topology.n_nodes(), grain, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        for (const CellIndex c : topology.node_cells(static_cast<NodeIndex>(i)))
          limits[i] = std::min(limits[i], of_cells[c]);
    });
  return smallest;
}

template double feasible_fractions<2>(const Topology&, std::span<const Point<2>>,
                                      std::span<const Point<2>>, double, std::vector<double>&);
template double feasible_fractions<3>(const Topology&, std::span<const Point<3>>,
                                      std::span<const Point<3>>, double, std::vector<double>&);

}  // namespace smoothfem
