// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// u and grad u at one point: their common parts are computed once.
template <int dim>
struct ValueAndGradient {
  double value;
  Point<dim> gradient;
};

/// The tensor A of -div(A grad u), symmetric and positive definite.
template <int dim>
using Diffusivity = Eigen::Matrix<double, dim, dim>;

/// A known solution u of -laplace(u) = f, or of -div(A grad u) = f, whose values (on natural parts
/// of the boundary: A grad u . n) are the boundary's data.
template <int dim>
struct ManufacturedSolution {
  std::string name;
  std::string formula;                             ///< of u, for listings
  std::string source;                              ///< where it comes from
  std::function<double(const Point<dim>&)> value;  ///< u
  std::function<ValueAndGradient<dim>(const Point<dim>&)> value_and_gradient;
  std::function<double(const Point<dim>&)> load;                     ///< f
  std::function<Diffusivity<dim>(const Point<dim>&)> diffusivity{};  ///< A; empty: the identity
  /// dA / dx_k for each direction k, which only the energy's gradient in node positions needs;
  /// empty with A, or where nobody has derived it.
  std::function<std::array<Diffusivity<dim>, dim>(const Point<dim>&)> diffusivity_derivatives{};
  /// What the conditions of its formulas compare with zero: where one changes its sign another
  /// piece begins. Empty: no conditions.
  std::function<std::vector<double>(const Point<dim>&)> conditions{};

  /// g . A g of a gradient g: the energy norm's square is its integral.
  double energy_of(const Point<dim>& g, const Point<dim>& position) const {
    return diffusivity ? g.dot(diffusivity(position) * g) : g.squaredNorm();
  }
};

/// Registers a solution when its file is loaded: one namespace-scope object a dimension at the end
/// of each file in fem/solutions/. A name that is taken is an InputError at the first look-up.
template <int dim>
struct RegisteredSolution {
  explicit RegisteredSolution(ManufacturedSolution<dim> solution);
};

/// The solutions that studies of meshes of this dimension can name, sorted by name.
template <int dim>
const std::vector<ManufacturedSolution<dim>>& manufactured_solutions();

/// The one of this name; throws InputError listing the names there are.
template <int dim>
const ManufacturedSolution<dim>& manufactured_solution(const std::string& name);

/// A solution from expressions in x and y (in space: and z; and pi): u, its gradient as
/// "u_x ; u_y" ("u_x ; u_y ; u_z"), and f = -laplace(u). Throws InputError if an expression cannot
/// be read, or if gradient and load are not those of u (checked against differences of u at points
/// in and around `sample`). diffusivity: see derived_solution. Safe to call from several threads.
template <int dim>
ManufacturedSolution<dim> parsed_solution(const std::string& value, const std::string& gradient,
                                          const std::string& load,
                                          std::span<const Point<dim>> sample,
                                          const std::string& diffusivity = {});

/// A solution from a formula of u alone, in x and y (in space: and z), with conditions if need be;
/// gradient and f = -div(A grad u) are derived. diffusivity: A as one formula, as dim x dim
/// formulas "a11, a12 ; a21, a22", or empty for the identity. Throws InputError if a formula cannot
/// be read, and as check_solution does. Safe to call from several threads.
template <int dim>
ManufacturedSolution<dim> derived_solution(const std::string& u, const std::string& diffusivity,
                                           std::span<const Point<dim>> sample);

}  // namespace smoothfem
