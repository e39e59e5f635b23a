// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/tensor_grid.h"

namespace smoothfem {
namespace {

/// From 0 to 1, with 2 n_half intervals.
std::vector<double> finer_in_the_middle(int n_half, double growth) {
  std::vector<double> x{0.0};
  for (int i = -n_half; i < n_half; ++i)
    x.push_back(x.back() + std::pow(growth, i < 0 ? -i - 1 : i));
  const double total = x.back();
  for (double& value : x) value /= total;
  return x;
}

/// The nonuniform grid of the thesis, Section 5.3.1: 13 x 4 x 11 nodes, equidistant in y, in x and
/// z finer towards the middle. The thesis does not print its coordinates; here intervals of x and z
/// grow by constant factors from the middle to both sides, x and z lie between 0 and 1, and the
/// factors and the step of y give the printed mean ratios: least .0010, greatest .5714, mean .0943.
/// edge_scale (1 to 5): that much fewer intervals in x and z. Throws InputError for another one.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("nonuniform grid", p.edge_scale, 5);
  // The only three unknowns; they solve the equations for the three printed mean ratios.
  constexpr double growth_in_x = 5.00644, growth_in_z = 1.593665, step_in_y = 0.816804;
  const auto half = [&](int n) { return static_cast<int>(std::lround(0.5 * n / p.edge_scale)); };
  std::vector<double> y;
  for (int j = 0; j <= 3; ++j) y.push_back(step_in_y * j);
  return mesh_of(tensor_grid({finer_in_the_middle(half(12), growth_in_x), y,
                              finer_in_the_middle(half(10), growth_in_z)}),
                 "generated nonuniform grid");
}

const RegisteredDomain registered(
    {.name = "nonuniform-grid",
     .description =
         "Section 5.3.1's grid: its 13 x 4 x 11 nodes and printed mean ratios, planes of our own",
     .dimension = 3,
     .elements = {"hexahedra"},
     .make = generate});

}  // namespace
}  // namespace smoothfem
