// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "fem/assembly/cell_diffusivity.h"
#include "fem/elements/adaptive_quadrature.h"
#include "fem/solutions/point_function.h"
#include "fem/space/finite_element_space.h"
#include "smoothing/simd/cells.h"

namespace smoothfem {

/// The columns of a Jacobian, its determinant, and the rows of the inverse. The gradient of a
/// function with the reference gradient r is the sum of r_k dual_k.
template <int dim, class Real>
struct Jacobian {
  std::array<Vector<dim, Real>, dim> dual;
  Real determinant;

  Jacobian() = default;
  explicit Jacobian(const std::array<Vector<2, Real>, 2>& columns) {
    determinant = cross(columns[0], columns[1]);
    const Real inverse = 1.0 / determinant;
    dual[0] = {inverse * columns[1].y, -inverse * columns[1].x};
    dual[1] = {-inverse * columns[0].y, inverse * columns[0].x};
  }
  explicit Jacobian(const std::array<Vector<3, Real>, 3>& columns) {
    const auto normal = cross(columns[1], columns[2]);
    determinant = dot(columns[0], normal);
    const Real inverse = 1.0 / determinant;
    dual[0] = inverse * normal;
    dual[1] = inverse * cross(columns[2], columns[0]);
    dual[2] = inverse * cross(columns[0], columns[1]);
  }

  /// reference: numbers, or one for each lane.
  template <class Number>
  Vector<dim, Real> gradient(const Number* reference) const {
    auto sum = reference[0] * dual[0];
    for (int d = 1; d < dim; ++d) sum = sum + reference[d] * dual[d];
    return sum;
  }
};

/// A cell's mapping at one quadrature point.
template <int dim, class Real>
struct MappedPoint {
  Vector<dim, Real> position;
  Jacobian<dim, Real> jacobian;
  Real weight;  ///< quadrature weight times the Jacobian's determinant
};

/// vertices: the points of the cell's mapping, in the element's order: the vertices, and in curved
/// cells the midside points. q: number of the point in the table.
template <int dim, class Real, std::size_t n_vertices>
inline MappedPoint<dim, Real> map_point(const QuadratureTable& table, std::size_t q,
                                        const std::array<Vector<dim, Real>, n_vertices>& vertices) {
  Vector<dim, Real> position{};
  std::array<Vector<dim, Real>, dim> columns{};
  for (std::size_t v = 0; v < n_vertices; ++v) {
    const double* gradient = &table.geometry_gradient[dim * (q * n_vertices + v)];
    position = position + table.geometry[q * n_vertices + v] * vertices[v];
    for (int d = 0; d < dim; ++d) columns[d] = columns[d] + gradient[d] * vertices[v];
  }
  const Jacobian<dim, Real> jacobian(columns);
  return {position, jacobian, table.weights[q] * jacobian.determinant};
}

/// Calls visit(q, mapped point, value of the function there) for each point of a table, in their
/// order. The function is evaluated at many points at once.
template <int dim, class Value, std::size_t n_vertices, class Visit>
void for_each_point(const QuadratureTable& table,
                    const std::array<Vector<dim, double>, n_vertices>& vertices,
                    const PointFunction<dim, Value>& function, const Visit& visit) {
  std::array<MappedPoint<dim, double>, n_points_at_once> mapped;
  std::array<Point<dim>, n_points_at_once> positions;
  std::array<Value, n_points_at_once> values;
  for (std::size_t first = 0; first < table.n_points; first += n_points_at_once) {
    const std::size_t n = std::min(n_points_at_once, table.n_points - first);
    for (std::size_t k = 0; k < n; ++k) {
      mapped[k] = map_point<dim, double>(table, first + k, vertices);
      positions[k] = point_of(mapped[k].position);
    }
    function.at(std::span(positions.data(), n), std::span(values.data(), n));
    for (std::size_t k = 0; k < n; ++k) visit(first + k, mapped[k], values[k]);
  }
}

/// A cell's stiffness matrix (upper triangle row by row) and its load: the mass matrix times the
/// values of f at the dofs.
template <std::size_t n_dofs, class Real>
struct CellIntegrals {
  static constexpr std::size_t n_entries = n_dofs * (n_dofs + 1) / 2;
  std::array<Real, n_entries> stiffness;
  std::array<Real, n_dofs> load;
  /// Smallest and largest determinant of the mapping at the evaluated points.
  Real smallest_determinant, largest_determinant;

  /// level: of the element's rules.
  template <int dim, std::size_t n_vertices, class AnyDiffusivity>
  [[gnu::flatten]] void compute(const ReferenceElement& element, std::size_t level,
                                const std::array<Vector<dim, Real>, n_vertices>& vertices,
                                const std::array<Real, n_dofs>& f,
                                const AnyDiffusivity& diffusivity) {
    if constexpr (n_vertices == dim + 1 && std::is_same_v<AnyDiffusivity, IdentityDiffusivity>) {
      compute_affine<dim>(element, vertices, f);
    } else if constexpr (n_vertices == dim + 1 &&
                         std::is_same_v<AnyDiffusivity, ConstantDiffusivity>) {
      compute_affine<dim>(element, vertices, f);
      for (Real& entry : stiffness) entry = diffusivity.factor * entry;
    } else {
      compute_by_quadrature<dim, n_vertices>(element.rule(level), vertices, f, diffusivity);
    }
  }

 private:
  /// Straight-sided simplices: one mapping for the whole cell.
  template <int dim>
  void compute_affine(const ReferenceElement& element,
                      const std::array<Vector<dim, Real>, dim + 1>& vertices,
                      const std::array<Real, n_dofs>& f) {
    std::array<Vector<dim, Real>, dim> columns;
    for (int d = 0; d < dim; ++d) columns[d] = vertices[d + 1] - vertices[0];
    const Jacobian<dim, Real> jacobian(columns);
    smallest_determinant = largest_determinant = jacobian.determinant;
    std::array<Real, dim*(dim + 1) / 2> metric;
    for (int a = 0, k = 0; a < dim; ++a)
      for (int b = a; b < dim; ++b, ++k)
        metric[k] = jacobian.determinant * dot(jacobian.dual[a], jacobian.dual[b]);
    for (std::size_t p = 0; p < n_entries; ++p) {
      Real sum = element.affine.stiffness[p] * metric[0];
      for (std::size_t k = 1; k < metric.size(); ++k)
        sum += element.affine.stiffness[k * n_entries + p] * metric[k];
      stiffness[p] = sum;
    }
    load.fill(Real{});
    for (std::size_t i = 0, p = 0; i < n_dofs; ++i)
      for (std::size_t j = i; j < n_dofs; ++j, ++p) {
        const Real mass = element.affine.mass[p] * jacobian.determinant;
        load[i] += mass * f[j];
        if (i != j) load[j] += mass * f[i];
      }
  }

  /// Other cells, and varying diffusivity: by quadrature.
  template <int dim, std::size_t n_vertices, class AnyDiffusivity>
  void compute_by_quadrature(const QuadratureTable& table,
                             const std::array<Vector<dim, Real>, n_vertices>& vertices,
                             const std::array<Real, n_dofs>& f, const AnyDiffusivity& diffusivity) {
    stiffness.fill(Real{});
    load.fill(Real{});
    smallest_determinant = Real{} + std::numeric_limits<double>::infinity();
    largest_determinant = -smallest_determinant;
    for (std::size_t q = 0; q < table.n_points; ++q) {
      const auto mapped = map_point<dim, Real>(table, q, vertices);
      const Real determinant = mapped.jacobian.determinant;
      smallest_determinant =
          determinant < smallest_determinant ? determinant : smallest_determinant;
      largest_determinant = determinant > largest_determinant ? determinant : largest_determinant;
      const double* shape = &table.shape[q * n_dofs];
      std::array<Vector<dim, Real>, n_dofs> gradients;
      Real f_at_point{};
      for (std::size_t i = 0; i < n_dofs; ++i) {
        gradients[i] = mapped.jacobian.gradient(&table.shape_gradient[dim * (q * n_dofs + i)]);
        f_at_point += shape[i] * f[i];
      }
      const Real weighted_f = mapped.weight * f_at_point;
      const auto tensor = diffusivity.at(mapped.position);
      for (std::size_t i = 0, p = 0; i < n_dofs; ++i) {
        const auto weighted_gradient = tensor * (mapped.weight * gradients[i]);
        load[i] += shape[i] * weighted_f;
        for (std::size_t j = i; j < n_dofs; ++j, ++p)
          stiffness[p] += dot(weighted_gradient, gradients[j]);
      }
    }
  }
};

/// The first n_vertices points of the mappings of n_lanes cells, one in each lane.
template <int dim, std::size_t n_vertices>
std::array<Vector<dim, Lanes>, n_vertices> cell_vertices(
    const ElementCells& group, const std::array<std::size_t, n_lanes>& cells,
    const std::vector<Point<dim>>& x) {
  std::array<const NodeIndex*, n_lanes> rows;
  for (std::size_t l = 0; l < n_lanes; ++l) rows[l] = group.mapping_points(cells[l]);
  std::array<Vector<dim, Lanes>, n_vertices> vertices;
  for (std::size_t v = 0; v < n_vertices; ++v)
    vertices[v] =
        gather_corner<dim>([&](NodeIndex node) -> const Point<dim>& { return x[node]; }, rows, v);
  return vertices;
}

/// Up to n_lanes cells of a list, from the position `first` on; the last one fills missing lanes.
inline std::array<std::size_t, n_lanes> cells_in_lanes(std::span<const std::size_t> cells,
                                                       std::size_t first) {
  std::array<std::size_t, n_lanes> in_lanes;
  for (std::size_t l = 0; l < n_lanes; ++l)
    in_lanes[l] = cells[std::min(first + l, cells.size() - 1)];
  return in_lanes;
}

/// Up to n_lanes cells of one element, processed together; missing lanes repeat the last one.
template <int dim, std::size_t n_dofs, std::size_t n_vertices>
struct ElementBatch {
  std::array<std::size_t, n_lanes> cells;
  std::size_t size;
  std::array<Vector<dim, Lanes>, n_vertices> vertices;
  std::array<Lanes, n_dofs> load;  ///< f at the dofs

  /// x: local nodes' coordinates. load_at(cell, i): f at a cell's i-th dof. of_group: cells, of
  /// which the batch takes those from `first` on.
  template <class LoadAt>
  ElementBatch(const ElementCells& group, const std::vector<Point<dim>>& x, const LoadAt& load_at,
               const std::vector<std::size_t>& of_group, std::size_t first)
      : cells(cells_in_lanes(of_group, first)),
        size(std::min(n_lanes, of_group.size() - first)),
        vertices(cell_vertices<dim, n_vertices>(group, cells, x)) {
    for (std::size_t i = 0; i < n_dofs; ++i)
      for (std::size_t l = 0; l < n_lanes; ++l) load[i][l] = load_at(cells[l], i);
  }
};

/// Integrals over a cell by a chosen rule.
template <class Integrals>
struct Settled {
  Integrals integrals;
  std::size_t level = 0;   ///< of the element's rules
  bool is_settled = true;  ///< the last finer rule changed little

  /// Starts with the rule for errors, and takes finer ones until one changes the integrals little.
  /// by_rule(table): the integrals.
  template <class ByRule>
  Settled(const ReferenceElement& element, const ByRule& by_rule)
      : integrals(by_rule(element.errors)), is_settled(element.n_rules() == 1) {
    while (!is_settled && level + 1 < element.n_rules()) {
      const Integrals finer = by_rule(element.rule(++level));
      is_settled =
          integrals.is_near(finer, adaptive_quadrature::tolerance_at(level, element.n_rules()));
      integrals = finer;
    }
  }
};

/// Returns the points of a cell's mapping, one cell at a time.
template <int dim, std::size_t n_vertices>
std::array<Vector<dim, double>, n_vertices> cell_vertices(const ElementCells& group,
                                                          std::size_t cell,
                                                          const std::vector<Point<dim>>& x) {
  const NodeIndex* points = group.mapping_points(cell);
  std::array<Vector<dim, double>, n_vertices> vertices;
  for (std::size_t v = 0; v < n_vertices; ++v) vertices[v] = vector_of(x[points[v]]);
  return vertices;
}

/// Calls visit.operator()<n_dofs, n_vertices>(group) for the cells of each available element of a
/// straight-sided space.
template <int dim, class Visit>
void for_each_straight_group(const FiniteElementSpace<dim>& space, const Visit& visit) {
  constexpr std::size_t n_simplex = dim + 1, n_tensor = dim == 2 ? 4 : 8;
  [[maybe_unused]] constexpr std::size_t n_pyramid = 5, n_prism = 6;
  for (const auto& group : space.groups) {
    const std::size_t n_vertices = group.element.n_vertices;
    if constexpr (dim == 3) {
      if (n_vertices == n_pyramid) {
        visit.template operator()<n_pyramid, n_pyramid>(group);
        continue;
      }
      if (n_vertices == n_prism) {
        visit.template operator()<n_prism, n_prism>(group);
        continue;
      }
    }
    if (n_vertices == n_simplex && space.degree == 1)
      visit.template operator()<n_simplex, n_simplex>(group);
    else if (n_vertices == n_simplex)
      visit.template operator()<dim == 2 ? 6 : 10, n_simplex>(group);
    else if (space.degree == 1)
      visit.template operator()<n_tensor, n_tensor>(group);
    else
      visit.template operator()<dim == 2 ? 9 : 27, n_tensor>(group);
  }
}

/// Numbers of points of the mappings of curved simplices.
template <int dim>
constexpr std::size_t n_curved_simplex = dim == 2 ? 7 : 10;

/// Calls visit.operator()<n_dofs, n_points>(group) for the cells of each available element, with
/// the number of points of its mapping: n_vertices in straight-sided spaces.
template <int dim, class Visit>
void for_each_group(const FiniteElementSpace<dim>& space, const Visit& visit) {
  if (!space.is_curved) return for_each_straight_group(space, visit);
  constexpr std::size_t n_tensor = dim == 2 ? 9 : 27;
  for_each_straight_group(
      space, [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group) {
        if constexpr (n_vertices == dim + 1)
          visit.template operator()<n_dofs, n_curved_simplex<dim>>(group);
        else if constexpr (n_vertices == 5)
          visit.template operator()<n_dofs, 14>(group);
        else if constexpr (n_vertices == 6)
          visit.template operator()<n_dofs, 18>(group);
        else
          visit.template operator()<n_dofs, n_tensor>(group);
      });
}

}  // namespace smoothfem
