#include "smoothing/smoothers/feasible_movement.h"

#include <limits>

#include "smoothing/mesh/cell_blocks.h"

namespace smoothfem {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The smallest t > 0 where a corner's determinant, quadratic in t, is down to 1 - share of that at
/// 0; infinity if there is none.
template <class Real>
SMOOTHFEM_INLINE Real corner_limit(Vector2<Real> next, Vector2<Real> previous,
                                   Vector2<Real> next_change, Vector2<Real> previous_change,
                                   double share) {
  const Real constant = share * cross(next, previous);
  const Real linear = cross(next_change, previous) + cross(next, previous_change);
  const Real quadratic = cross(next_change, previous_change);
  const Real discriminant = linear * linear - 4.0 * quadratic * constant;
  const Real infinite = Real{} + unlimited;
  const Real root = square_root(discriminant > 0.0 ? discriminant : Real{});
  // Without cancellation where the determinant falls from the start.
  const Real denominator = root - linear;
  const Real limit = 2.0 * constant / denominator;
  const Real falls = denominator > 0.0 ? limit : infinite;
  return discriminant >= 0.0 ? falls : infinite;
}

template <class Real, std::size_t extent>
SMOOTHFEM_INLINE Real cell_limit(std::span<const Vector2<Real>, extent> x,
                                 std::span<const Vector2<Real>, extent> y, double share) {
  const std::size_t n = x.size(), n_corners = n == 3 ? 1 : n;
  Real smallest = Real{} + unlimited;
  for (std::size_t k = 0; k < n_corners; ++k) {
    const std::size_t after = k + 1 == n ? 0 : k + 1, before = k == 0 ? n - 1 : k - 1;
    const auto next = x[after] - x[k], previous = x[before] - x[k];
    const Real limit = corner_limit(next, previous, (y[after] - y[k]) - next,
                                    (y[before] - y[k]) - previous, share);
    smallest = limit < smallest ? limit : smallest;
  }
  return smallest;
}

}  // namespace

SMOOTHFEM_VECTOR_CLONES
double feasible_fractions(const Topology& topology, const std::vector<Point<2>>& from,
                          const std::vector<Point<2>>& to, double share,
                          std::vector<double>& limits) {
  limits.assign(topology.n_nodes(), 1.0);
  double smallest = 1.0;
  const auto lower = [&](CellIndex c, double limit) SMOOTHFEM_INLINE_LAMBDA {
    if (!(limit < 1.0)) return;
    smallest = std::min(smallest, limit);
    for (const NodeIndex i : topology.cell_nodes(c)) limits[i] = std::min(limits[i], limit);
  };
  for_each_block<2>(
      topology, from,
      [&]<std::size_t n>(CellIndex c, const std::array<Vector2<Lanes>, n>& x)
          SMOOTHFEM_INLINE_LAMBDA {
            const auto y = gather_block<n, 2>(to.data(), topology.cell_nodes(c).data());
            const Lanes limit = cell_limit(std::span<const Vector2<Lanes>, n>(x),
                                           std::span<const Vector2<Lanes>, n>(y), share);
            for (std::size_t l = 0; l < n_lanes; ++l) lower(c + l, limit[l]);
          },
      [&]<std::size_t n>(CellIndex c, std::span<const Vector2<double>, n> x)
          SMOOTHFEM_INLINE_LAMBDA {
            with_corners<2>(topology.cell_nodes(c), to, [&](auto y) SMOOTHFEM_INLINE_LAMBDA {
              if constexpr (decltype(y)::extent == n) lower(c, cell_limit(x, y, share));
            });
          });
  return smallest;
}

}  // namespace smoothfem
