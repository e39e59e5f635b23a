// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/tensor_grid.h"

namespace smoothfem {
namespace {

/// Returns planes from 0 to 1, with 2 n_half intervals that grow by a factor from the middle to
/// both sides.
std::vector<double> growing(int n_half, double factor) {
  std::vector<double> x{0.0};
  for (int i = -n_half; i < n_half; ++i)
    x.push_back(x.back() + std::pow(factor, i < 0 ? -i - 1 : i));
  const double total = x.back();
  for (double& value : x) value /= total;
  return x;
}

/// Returns planes from 0 to 1 where sinh(slope t) has equal steps of t.
std::vector<double> by_sinh(int n_half, double slope) {
  std::vector<double> x;
  for (int i = -n_half; i <= n_half; ++i)
    x.push_back(0.5 + 0.5 * std::sinh(slope * i / n_half) / std::sinh(slope));
  return x;
}

/// The nonuniform grid of the thesis, Section 5.3.1: 13 x 4 x 11 nodes, equidistant in y, finer
/// towards the middle in x and z. The thesis does not print its coordinates. Here x and z lie
/// between 0 and 1. The fineness in the middle and the step of y give the printed mean ratios:
/// lowest .0010, highest .5714, mean .0943. edge_scale (1 to 5) divides the numbers of intervals in
/// x and z. Throws InputError for another edge scale.
template <std::vector<double> (*planes)(int, double)>
AnyMesh grid(const DomainParameters& p, double in_x, double in_z, double step_in_y) {
  require_edge_scale("nonuniform grid", p.edge_scale, 5);
  const auto half = [&](int n) { return static_cast<int>(std::lround(0.5 * n / p.edge_scale)); };
  std::vector<double> y;
  for (int j = 0; j <= 3; ++j) y.push_back(step_in_y * j);
  return mesh_of(tensor_grid({planes(half(12), in_x), y, planes(half(10), in_z)}),
                 "generated nonuniform grid");
}

// The three numbers of each grid solve the equations for the three printed mean ratios, which have
// more than one solution.
AnyMesh finer_in_x(const DomainParameters& p) {
  return grid<growing>(p, 5.00644, 1.593665, 0.816804);
}
AnyMesh finer_in_z(const DomainParameters& p) {
  return grid<growing>(p, 1.548082, 7.00706, 0.7915795);
}
AnyMesh sinh_in_x(const DomainParameters& p) {
  return grid<by_sinh>(p, 10.29724, 2.480047, 0.8043832);
}

const RegisteredDomain registered(
    {.name = "nonuniform-grid",
     .description =
         "Section 5.3.1's grid: its 13 x 4 x 11 nodes and printed mean ratios, other planes",
     .dimension = 3,
     .elements = {"hexahedra"},
     .make = finer_in_x});
const RegisteredDomain registered_finer_in_z(
    {.name = "nonuniform-grid-z",
     .description = "nonuniform-grid, but finer in z than in x instead of the reverse",
     .dimension = 3,
     .elements = {"hexahedra"},
     .make = finer_in_z});
const RegisteredDomain registered_sinh(
    {.name = "nonuniform-grid-sinh",
     .description = "nonuniform-grid with planes by the hyperbolic sine",
     .dimension = 3,
     .elements = {"hexahedra"},
     .make = sinh_in_x});

}  // namespace
}  // namespace smoothfem
