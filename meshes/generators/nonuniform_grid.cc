#include "meshes/generators/nonuniform_grid.h"

#include <cmath>

#include "meshes/generators/tensor_grid.h"

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

}  // namespace

VolumeMesh generate_nonuniform_grid(double edge_scale) {
  require_edge_scale("nonuniform grid", edge_scale, 5);
  // The only three unknowns; they solve the equations for the three printed mean ratios.
  constexpr double growth_in_x = 5.00644, growth_in_z = 1.593665, step_in_y = 0.816804;
  const auto half = [&](int n) { return static_cast<int>(std::lround(0.5 * n / edge_scale)); };
  std::vector<double> y;
  for (int j = 0; j <= 3; ++j) y.push_back(step_in_y * j);
  return mesh_of(tensor_grid({finer_in_the_middle(half(12), growth_in_x), y,
                              finer_in_the_middle(half(10), growth_in_z)}),
                 "generated nonuniform grid");
}

}  // namespace smoothfem
