// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

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

/// A known solution u of -laplace(u) = f with u = g on the boundary.
template <int dim>
struct ManufacturedSolution {
  std::string name;
  std::string formula;                             ///< of u, for listings
  std::string source;                              ///< where it comes from
  std::function<double(const Point<dim>&)> value;  ///< u
  std::function<ValueAndGradient<dim>(const Point<dim>&)> value_and_gradient;
  std::function<double(const Point<dim>&)> load;  ///< f = -laplace(u)
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
/// in and around `sample`). Safe to call from several threads.
template <int dim>
ManufacturedSolution<dim> parsed_solution(const std::string& value, const std::string& gradient,
                                          const std::string& load,
                                          std::span<const Point<dim>> sample);

}  // namespace smoothfem
