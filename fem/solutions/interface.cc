// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

namespace {

/// Diffusivities of the two materials: on the side of smaller x or inside of the circle, and on the
/// other side.
constexpr std::array<double, 2> diffusivities{1.0, 10.0};

/// Makes a solution u = s(x) / k + t(x), which has a continuous flux: s vanishes on the interface,
/// and t does not change across it. distance: negative in the first material. parts: at a position,
/// s with its gradient and Laplacian, then the same of t.
template <int dim, class Distance, class Parts>
ManufacturedSolution<dim> interface_solution(const std::string& name, const std::string& formula,
                                             const Distance& distance, const Parts& parts) {
  const auto side = [=](const Point<dim>& p) -> std::size_t { return distance(p) < 0.0 ? 0 : 1; };
  const auto value = [=](const Point<dim>& p) {
    const auto [s, t] = parts(p);
    return s.value / diffusivities[side(p)] + t.value;
  };
  ManufacturedSolution<dim> solution{
      .name = name,
      .formula = formula,
      .source = "continuous flux between two materials",
      .value = value,
      .value_and_gradient = [=](const Point<dim>& p) -> ValueAndGradient<dim> {
        const auto [s, t] = parts(p);
        return {value(p), s.gradient / diffusivities[side(p)] + t.gradient};
      },
      .load = {},
      .diffusivity = [=](const Point<dim>& p) -> Diffusivity<dim> {
        return diffusivities[side(p)] * Diffusivity<dim>::Identity();
      },
      .diffusivity_derivatives =
          [](const Point<dim>&) {
            std::array<Diffusivity<dim>, dim> none;
            none.fill(Diffusivity<dim>::Zero());
            return none;
          },
      .conditions = [=](const Point<dim>& p) { return std::vector{distance(p)}; },
      .material_at = side};
  for (const double k : diffusivities)
    solution.materials.push_back({.group = {},
                                  .diffusivity = [=](const Point<dim>&) -> Diffusivity<dim> {
                                    return k * Diffusivity<dim>::Identity();
                                  },
                                  .constant = k,
                                  .load =
                                      [=](const Point<dim>& p) {
                                        const auto [s, t] = parts(p);
                                        return -s.laplacian - k * t.laplacian;
                                      }});
  solution.load = [materials = solution.materials, side](const Point<dim>& p) {
    return materials[side(p)].load(p);
  };
  return solution;
}

template <int dim>
struct Part {
  double value = 0.0;
  Point<dim> gradient = Point<dim>::Zero();
  double laplacian = 0.0;
};
template <int dim>
struct Parts {
  Part<dim> s, t;
};

/// The plane x = 1/2.
template <int dim>
double from_plane(const Point<dim>& p) {
  return p.x() - 0.5;
}

template <int dim>
ManufacturedSolution<dim> plane_solution() {
  return interface_solution<dim>(
      "interface-plane", "(x - 1/2) / A, with A = 1 if x < 1/2 and A = 10 elsewhere",
      from_plane<dim>, [](const Point<dim>& p) -> Parts<dim> {
        return {.s = {from_plane<dim>(p), Point<dim>::Unit(0), 0.0}, .t = {}};
      });
}

template <int dim>
ManufacturedSolution<dim> quadratic_plane_solution() {
  return interface_solution<dim>("interface-plane-quadratic",
                                 std::string("(x - 1/2) / A + y^2") + (dim == 2 ? "" : " + z^2") +
                                     ", with A = 1 if x < 1/2 and A = 10 elsewhere",
                                 from_plane<dim>, [](const Point<dim>& p) -> Parts<dim> {
                                   Point<dim> across = p;
                                   across[0] = 0.0;
                                   return {
                                       .s = {from_plane<dim>(p), Point<dim>::Unit(0), 0.0},
                                       .t = {across.squaredNorm(), 2.0 * across, 2.0 * (dim - 1)}};
                                 });
}

/// Half of the difference between r^2 and R^2 for the circle with the radius R = 0.3 around the
/// centre of the unit square.
Part<2> from_circle(const Point<2>& p) {
  constexpr double radius = 0.3;
  const Point<2> r = p - Point<2>(0.5, 0.5);
  return {0.5 * (r.squaredNorm() - radius * radius), r, 2.0};
}

ManufacturedSolution<2> circle_solution() {
  return interface_solution<2>(
      "interface-circle",
      "(r^2 - 0.09) / (2 A), with A = 1 if r < 0.3 and A = 10 elsewhere, r from (1/2, 1/2)",
      [](const Point<2>& p) { return from_circle(p).value; },
      [](const Point<2>& p) -> Parts<2> { return {.s = from_circle(p), .t = {}}; });
}

const RegisteredSolution<2> planar(plane_solution<2>());
const RegisteredSolution<3> volume(plane_solution<3>());
const RegisteredSolution<2> planar_quadratic(quadratic_plane_solution<2>());
const RegisteredSolution<3> volume_quadratic(quadratic_plane_solution<3>());
const RegisteredSolution<2> circle(circle_solution());

}  // namespace

}  // namespace smoothfem
