#include "smoothing/optimization/feasible_movement.h"

#include <limits>

#include "smoothing/base/parallel.h"
#include "smoothing/mesh/volume_elements.h"
#include "smoothing/simd/cell_blocks.h"

namespace smoothfem {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The smallest t in (0, 1] where constant + linear t + quadratic t^2 + cubic t^3 is zero, constant
/// > 0, or a lower bound of it; something larger if there is none. Each step goes to the root of
/// the quadratic that has the polynomial's value and slope at t and the least curvature it has
/// between t and 1: no more than the polynomial itself. The first one ends at the root if that is
/// quadratic, the others converge to it quadratically from below.
template <int n_steps, class Real>
SMOOTHFEM_INLINE Real smallest_root(Real constant, Real linear, Real quadratic, Real cubic) {
  const Real infinite = Real{} + unlimited;
  Real t{};
  for (int step = 0; step < n_steps; ++step) {
    const Real value = constant + t * (linear + t * (quadratic + t * cubic));
    const Real slope = linear + t * (2.0 * quadratic + 3.0 * t * cubic);
    const Real here = quadratic + 3.0 * t * cubic, there = quadratic + 3.0 * cubic;
    const Real half_curvature = here < there ? here : there;
    const Real discriminant = slope * slope - 4.0 * half_curvature * value;
    const Real root = square_root(discriminant > 0.0 ? discriminant : Real{});
    // Without cancellation where the polynomial falls.
    const Real denominator = root - slope;
    const Real length = 2.0 * value / denominator;
    const Real falls = denominator > 0.0 ? length : infinite;
    const Real ahead = discriminant >= 0.0 ? falls : infinite;
    // Rounding may have taken t to the root already.
    t += value > 0.0 ? ahead : Real{};
  }
  return t;
}

/// The smallest t > 0 where a corner's determinant is down to 1 - share of that at 0; more than 1
/// if there is none up to 1. Edges from the corner, and what is added to them at t = 1.
template <class Real>
SMOOTHFEM_INLINE Real corner_limit(const std::array<Vector2<Real>, 2>& edges,
                                   const std::array<Vector2<Real>, 2>& changes, double share) {
  const auto [a, b] = edges;
  const auto [da, db] = changes;
  return smallest_root<1>(share * cross(a, b), cross(da, b) + cross(a, db), cross(da, db), Real{});
}
template <class Real>
SMOOTHFEM_INLINE Real corner_limit(const std::array<Vector3<Real>, 3>& edges,
                                   const std::array<Vector3<Real>, 3>& changes, double share) {
  const auto [a, b, c] = edges;
  const auto [da, db, dc] = changes;
  const auto bc = cross(b, c), dbc = cross(db, c) + cross(b, dc), dbdc = cross(db, dc);
  return smallest_root<4>(share * dot(a, bc), dot(da, bc) + dot(a, dbc),
                          dot(da, dbc) + dot(a, dbdc), dot(da, dbdc));
}

template <class Real>
SMOOTHFEM_INLINE Real smaller(Real a, Real b) {
  return b < a ? b : a;
}

/// The smallest limit of a cell's corners; x, y: its nodes at the start and at the end.
template <class Real, std::size_t extent>
SMOOTHFEM_INLINE Real cell_limit(std::span<const Vector2<Real>, extent> x,
                                 std::span<const Vector2<Real>, extent> y, double share) {
  const std::size_t n = x.size(), n_corners = n == 3 ? 1 : n;
  Real smallest = Real{} + unlimited;
  for (std::size_t k = 0; k < n_corners; ++k) {
    const std::size_t after = k + 1 == n ? 0 : k + 1, before = k == 0 ? n - 1 : k - 1;
    const std::array edges{x[after] - x[k], x[before] - x[k]};
    const std::array changes{(y[after] - y[k]) - edges[0], (y[before] - y[k]) - edges[1]};
    smallest = smaller(smallest, corner_limit(edges, changes, share));
  }
  return smallest;
}
template <class Real, std::size_t n>
SMOOTHFEM_INLINE Real cell_limit(std::span<const Vector3<Real>, n> x,
                                 std::span<const Vector3<Real>, n> y, double share) {
  Real smallest = Real{} + unlimited;
  for (const LocalSimplex& corner : VolumeElement<n>::corners) {
    std::array<Vector3<Real>, 3> edges, changes;
    for (std::size_t i = 0; i < 3; ++i) {
      edges[i] = x[corner[i + 1]] - x[corner[0]];
      changes[i] = (y[corner[i + 1]] - y[corner[0]]) - edges[i];
    }
    smallest = smaller(smallest, corner_limit(edges, changes, share));
  }
  return smallest;
}

template <int dim>
SMOOTHFEM_INLINE double limit_block(const Topology& topology, const std::vector<Point<dim>>& from,
                                    const std::vector<Point<dim>>& to, double share,
                                    const CellBlock& block, std::vector<double>& limits) {
  double smallest = 1.0;
  const auto lower = [&](CellIndex c, double limit) SMOOTHFEM_INLINE_LAMBDA {
    limits[c] = std::min(limit, 1.0);
    smallest = std::min(smallest, limit);
  };
  for_each_block<dim>(
      topology, from, block.first, block.last,
      [&]<std::size_t n>(CellIndex c, const std::array<Vector<dim, Lanes>, n>& x)
          SMOOTHFEM_INLINE_LAMBDA {
            using Nodes = std::span<const Vector<dim, Lanes>, n>;
            const auto y = gather_block<n, dim>(to.data(), topology.cell_nodes(c).data());
            const Lanes limit = cell_limit(Nodes(x), Nodes(y), share);
            for (std::size_t l = 0; l < n_lanes; ++l) lower(c + l, limit[l]);
          },
      [&]<std::size_t n>(CellIndex c, std::span<const Vector<dim, double>, n> x)
          SMOOTHFEM_INLINE_LAMBDA {
            with_corners<dim>(topology.cell_nodes(c), to, [&](auto y) SMOOTHFEM_INLINE_LAMBDA {
              if constexpr (decltype(y)::extent == n) lower(c, cell_limit(x, y, share));
            });
          });
  return smallest;
}
double cell_limits(const Topology& topology, const std::vector<Point<2>>& from,
                   const std::vector<Point<2>>& to, double share, const CellBlock& block,
                   std::vector<double>& limits) {
  return limit_block<2>(topology, from, to, share, block, limits);
}
double cell_limits(const Topology& topology, const std::vector<Point<3>>& from,
                   const std::vector<Point<3>>& to, double share, const CellBlock& block,
                   std::vector<double>& limits) {
  return limit_block<3>(topology, from, to, share, block, limits);
}

}  // namespace

template <int dim>
double feasible_fractions(const Topology& topology, const std::vector<Point<dim>>& from,
                          const std::vector<Point<dim>>& to, double share,
                          std::vector<double>& limits) {
  constexpr std::size_t grain = 16384;
  std::vector<double> of_cells(topology.n_cells()), parts(topology.blocks().size());
  parallel_for(parts.size(), [&](std::size_t b) {
    parts[b] = cell_limits(topology, from, to, share, topology.blocks()[b], of_cells);
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

template double feasible_fractions(const Topology&, const std::vector<Point<2>>&,
                                   const std::vector<Point<2>>&, double, std::vector<double>&);
template double feasible_fractions(const Topology&, const std::vector<Point<3>>&,
                                   const std::vector<Point<3>>&, double, std::vector<double>&);

}  // namespace smoothfem
