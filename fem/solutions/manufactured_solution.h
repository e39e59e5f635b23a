// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fem/solutions/point_function.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// u and grad u at one point, which share common parts.
template <int dim>
struct ValueAndGradient {
  double value;
  Point<dim> gradient;
};

/// The tensor A of -div(A grad u), symmetric and positive definite.
template <int dim>
using Diffusivity = Eigen::Matrix<double, dim, dim>;

/// A part of the domain with its own diffusivity. A mesh says by groups which cells it has.
template <int dim>
struct Material {
  std::string group;  ///< tag or name in the mesh; empty: the cells of no other material
  std::function<Diffusivity<dim>(const Point<dim>&)> diffusivity;
  std::optional<double> constant{};  ///< A is this number times the identity everywhere
  PointFunction<dim, double> load;   ///< f; defined around the material, too
};

/// A known solution u of -laplace(u) = f, or of -div(A grad u) = f. Its values are the boundary
/// data; on natural parts of the boundary these are A grad u . n.
template <int dim>
struct ManufacturedSolution {
  std::string name;
  std::string formula;                             ///< of u, for listings
  std::string source;                              ///< its origin
  std::function<double(const Point<dim>&)> value;  ///< u
  PointFunction<dim, ValueAndGradient<dim>> value_and_gradient;
  PointFunction<dim, double> load;                                   ///< f
  std::function<Diffusivity<dim>(const Point<dim>&)> diffusivity{};  ///< A; empty: the identity
  /// dA / dx_k for each direction k, for the energy's gradient in node positions only. Empty if A
  /// is empty or has no known derivatives.
  std::function<std::array<Diffusivity<dim>, dim>(const Point<dim>&)> diffusivity_derivatives{};
  /// Values that the conditions of its formulas compare with zero: where one changes its sign,
  /// another piece begins. Empty: no conditions.
  std::function<std::vector<double>(const Point<dim>&)> conditions{};
  /// If they belong to cells (see below), A and f are those of the cell's material, and the
  /// functions above are not used for cells. u stays a function of the position.
  std::vector<Material<dim>> materials{};
  /// Index of the material at a position; empty: groups of cells tell.
  std::function<std::size_t(const Point<dim>&)> material_at{};
  /// The material of each kind of cells (cell_materials) of one mesh, on the root: see
  /// with_materials_of. Empty: A and f are functions of the position.
  std::vector<std::uint32_t> material_of_kind{};

  /// Returns g . A g for a gradient g; its integral is the square of the energy norm.
  double energy_of(const Point<dim>& g, const Point<dim>& position) const {
    return diffusivity ? g.dot(diffusivity(position) * g) : g.squaredNorm();
  }
};

/// Registers a solution when its file is loaded: one namespace-scope object for each dimension at
/// the end of each file in fem/solutions/. A duplicate name is an InputError at the first look-up.
template <int dim>
struct RegisteredSolution {
  explicit RegisteredSolution(ManufacturedSolution<dim> solution);
};

/// Returns the solutions for studies of meshes of this dimension, sorted by name.
template <int dim>
const std::vector<ManufacturedSolution<dim>>& manufactured_solutions();

/// Returns the solution of this name; throws InputError that lists the available names.
template <int dim>
const ManufacturedSolution<dim>& manufactured_solution(const std::string& name);

/// Makes a solution from expressions in x and y (in space also z; and pi): u, its gradient as "u_x
/// ; u_y" ("u_x ; u_y ; u_z"), and f = -laplace(u). Throws InputError if an expression cannot be
/// read, or if gradient and load do not belong to u. They are compared with differences of u at
/// points in and around `sample`. diffusivity: see derived_solution. Safe to call from several
/// threads.
template <int dim>
ManufacturedSolution<dim> parsed_solution(const std::string& value, const std::string& gradient,
                                          const std::string& load,
                                          std::span<const Point<dim>> sample,
                                          const std::string& diffusivity = {});

/// Returns some 20 to 40 of the points (all, if they are fewer), to check formulas at.
template <int dim>
std::vector<Point<dim>> sample_of(std::span<const Point<dim>> points) {
  std::vector<Point<dim>> sample;
  for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(1, points.size() / 20))
    sample.push_back(points[i]);
  return sample;
}

/// The diffusivity of a group of cells, as given: formulas as in derived_solution.
struct GroupDiffusivity {
  std::string group;  ///< tag or name
  std::string formula;

  bool operator==(const GroupDiffusivity&) const = default;
};

/// Makes a solution from a formula of u alone, in x and y (in space also z); it may have
/// conditions. gradient and f = -div(A grad u) are derived. diffusivity: A as one formula, as dim x
/// dim formulas "a11, a12 ; a21, a22", or empty for the identity. of_groups: A of the cells of
/// these groups; f is derived for each. Throws InputError if a formula cannot be read, and as
/// check_solution does (with groups, with_materials_of does). Safe to call from several threads.
template <int dim>
ManufacturedSolution<dim> derived_solution(const std::string& u, const std::string& diffusivity,
                                           std::span<const Point<dim>> sample,
                                           const std::vector<GroupDiffusivity>& of_groups = {});

}  // namespace smoothfem
