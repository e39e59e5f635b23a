// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/adaptivity/energy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include "fem/assembly/cell_function.h"
#include "fem/assembly/cell_load.h"
#include "fem/elements/adaptive_quadrature.h"
#include "smoothing/base/parallel.h"

namespace smoothfem {

namespace {

constexpr std::size_t cells_of_part = 256;

/// Calls work(part, first, last) for parts of the first n_cells of a group, several at a time.
template <class Work>
void for_parts(std::size_t n_cells, const Work& work) {
  parallel_for_ranges(n_cells, cells_of_part, [&](std::size_t first, std::size_t last) {
    work(first / cells_of_part, first, last);
  });
}

/// Adds in Eigen's order, so that a cell in a register gives results bitwise identical to those of
/// a single cell.
inline Lanes dot_as_eigen(Vector2<Lanes> a, Vector2<Lanes> b) {
  return dot(a, b);
}
inline Lanes dot_as_eigen(Vector3<Lanes> a, Vector3<Lanes> b) {
  return a.x * b.x + (a.y * b.y + a.z * b.z);
}

/// Adds the contribution of |grad u|^2 to the energy's derivatives by the vertices; one cell in
/// each lane.
template <int dim, std::size_t n_dofs, std::size_t n_vertices>
[[gnu::flatten]] void add_dirichlet_term(const CellFunction<dim, n_dofs, n_vertices, Lanes>& u,
                                         const QuadratureTable& table,
                                         std::array<Vector<dim, Lanes>, n_vertices>& sums) {
  for (std::size_t q = 0; q < table.n_points; ++q) {
    const auto mapped = u.map(table, q);
    const auto slope = u.slope(table, q, mapped);
    const Lanes square = dot_as_eigen(slope, slope);
    for (std::size_t v = 0; v < n_vertices; ++v) {
      const auto hat =
          mapped.jacobian.gradient(&table.geometry_gradient[dim * (q * n_vertices + v)]);
      sums[v] = sums[v] + mapped.weight * (square * hat - (2.0 * dot_as_eigen(slope, hat)) * slope);
    }
  }
}

/// Adds the contribution of A grad u . grad u for one cell.
template <int dim, std::size_t n_dofs, std::size_t n_vertices>
void add_diffusion_term(const CellFunction<dim, n_dofs, n_vertices>& u,
                        const QuadratureTable& table, const ManufacturedSolution<dim>& solution,
                        std::array<Point<dim>, n_vertices>& sums) {
  for (std::size_t q = 0; q < table.n_points; ++q) {
    const auto mapped = u.map(table, q);
    const Point<dim> position = point_of(mapped.position), slope = u.gradient(table, q, mapped),
                     flux = solution.diffusivity(position) * slope;
    const auto derivatives = solution.diffusivity_derivatives(position);
    Point<dim> by_place;
    for (std::size_t k = 0; k < dim; ++k)
      by_place[static_cast<int>(k)] = slope.dot(derivatives[k] * slope);
    const double square = slope.dot(flux);
    for (std::size_t v = 0; v < n_vertices; ++v) {
      const Point<dim> hat =
          point_of(mapped.jacobian.gradient(&table.geometry_gradient[dim * (q * n_vertices + v)]));
      sums[v] += mapped.weight * (square * hat - 2.0 * flux.dot(hat) * slope +
                                  table.geometry[q * n_vertices + v] * by_place);
    }
  }
}

/// Adds the contribution of f u; weighted_f: of each lane, at the table's points.
template <int dim, std::size_t n_dofs, std::size_t n_vertices>
[[gnu::flatten]] void add_load_term(const CellFunction<dim, n_dofs, n_vertices, Lanes>& u,
                                    const QuadratureTable& table,
                                    const std::array<const double*, n_lanes>& weighted_f,
                                    std::array<Vector<dim, Lanes>, n_vertices>& sums) {
  for (std::size_t q = 0; q < table.n_points; ++q) {
    const Lanes f{weighted_f[0][q], weighted_f[1][q], weighted_f[2][q], weighted_f[3][q]};
    const auto slope = (2.0 * f) * u.slope(table, q, u.map(table, q));
    for (std::size_t v = 0; v < n_vertices; ++v)
      sums[v] = sums[v] + table.geometry[q * n_vertices + v] * slope;
  }
}

/// Calls add(function, its cells, sums) for the cells of a list, n_lanes at a time. `sums` holds
/// the lanes' entries of `of_cells`, which are written back.
template <int dim, std::size_t n_dofs, std::size_t n_vertices, class Add>
void add_in_lanes(const ElementCells& group, std::span<const std::size_t> cells,
                  const std::vector<Point<dim>>& x, const Eigen::VectorXd& u,
                  std::vector<std::array<Point<dim>, n_vertices>>& of_cells, const Add& add) {
  for (std::size_t first = 0; first < cells.size(); first += n_lanes) {
    const auto some = cells_in_lanes(cells, first);
    std::array<Vector<dim, Lanes>, n_vertices> sums;
    for (std::size_t v = 0; v < n_vertices; ++v) {
      const auto in_lanes = [&](int d) {
        return Lanes{of_cells[some[0]][v][d], of_cells[some[1]][v][d], of_cells[some[2]][v][d],
                     of_cells[some[3]][v][d]};
      };
      sums[v].x = in_lanes(0);
      sums[v].y = in_lanes(1);
      if constexpr (dim == 3) sums[v].z = in_lanes(2);
    }
    add(CellFunction<dim, n_dofs, n_vertices, Lanes>(group, some, x, u), some, sums);
    for (std::size_t v = 0; v < n_vertices; ++v)
      for (std::size_t l = 0; l < n_lanes; ++l) of_cells[some[l]][v] = lane(sums[v], l);
  }
}

/// Elements whose functions have a constant gradient: the integrals of f phi_i contain all they
/// need of f.
template <int dim, std::size_t n_dofs, std::size_t n_vertices>
constexpr bool is_linear = n_dofs == n_vertices&& n_vertices == dim + 1;

}  // namespace

template <int dim>
Energy<dim>::Energy(std::shared_ptr<const FiniteElementSpace<dim>> space,
                    const ManufacturedSolution<dim>& solution)
    : space_(std::move(space)), solution_(solution) {
  if (solution_.diffusivity && !solution_.diffusivity_derivatives)
    throw InputError(
        "the energy of a solution needs the derivatives of its 'diffusivity' in node positions; "
        "give the diffusivity as a formula");
  const auto is_missing = [](const ElementCells& group) {
    return group.element.type == ElementType::pyramid || group.element.type == ElementType::prism;
  };
  const auto& groups = space_->groups;
  const auto n_missing =
      static_cast<std::size_t>(std::count_if(groups.begin(), groups.end(), is_missing));
  if (space_->ranks.sum(n_missing) > 0)  // one rank alone may have such cells
    throw InputError(
        "the energy of a solution is not available on pyramids and prisms; use a mesh of "
        "tetrahedra or hexahedra");
  for (const auto& group : groups) {
    const std::size_t n_cells = group.n_cells();
    loads_.push_back({.rules = make_energy_rules(group.element.type, space_->degree),
                      .levels = std::vector<std::uint8_t>(n_cells),
                      .values = std::vector<double>(n_cells * group.element.n_dofs),
                      .weighted_f = std::vector<std::vector<double>>((n_cells + cells_of_part - 1) /
                                                                     cells_of_part)});
  }
}

/// Matrices of simplices are exact with few points, unless A varies.
template <int dim>
template <std::size_t n_dofs, std::size_t n_vertices>
const QuadratureTable& Energy<dim>::gradient_rule(const ElementCells& group,
                                                  const EnergyRules& rules) const {
  const bool is_exact = n_vertices == static_cast<std::size_t>(dim) + 1 && !solution_.diffusivity;
  return is_exact ? rules.gradients : group.element.matrices;
}

template <int dim>
void Energy<dim>::integrate_load(const std::vector<Point<dim>>& x) {
  const auto run = [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group,
                                                                   std::size_t g) {
    GroupLoad& load = loads_[g];
    const auto& rules = load.rules.load;
    for_parts(group.n_cells(), [&](std::size_t part, std::size_t first, std::size_t last) {
      auto& kept = load.weighted_f[part];
      kept.clear();
      std::vector<double> weighted_f(rules.back().n_points);
      for (std::size_t cell = first; cell < last; ++cell) {
        const auto vertices = cell_vertices<dim, n_vertices>(group, cell, x);
        CellLoad<n_dofs> integrals(rules[0], vertices, solution_.load, weighted_f.data());
        bool is_settled = false;
        std::size_t level = 0;
        while (!is_settled && level + 1 < rules.size()) {
          const CellLoad<n_dofs> finer(rules[++level], vertices, solution_.load, weighted_f.data());
          is_settled = integrals.is_near(finer, adaptive_quadrature::tolerance);
          integrals = finer;
        }
        load.levels[cell] = static_cast<std::uint8_t>(level);
        std::copy(integrals.values.begin(), integrals.values.end(), &load.values[cell * n_dofs]);
        if constexpr (!is_linear<dim, n_dofs, n_vertices>)
          kept.insert(kept.end(), weighted_f.data(), weighted_f.data() + rules[level].n_points);
      }
    });
  };
  for_each_smooth_group(*space_, run);
}

template <int dim>
void Energy<dim>::add_load(Eigen::VectorXd& right_hand_side) const {
  for (std::size_t g = 0; g < loads_.size(); ++g) {
    const auto& dofs = space_->groups[g].dofs;
    for (std::size_t k = 0; k < dofs.size(); ++k)
      if (dofs[k] < space_->n_own) right_hand_side[dofs[k]] += loads_[g].values[k];
  }
}

template <int dim>
double Energy<dim>::value(const std::vector<Point<dim>>& x, const Eigen::VectorXd& u,
                          double c) const {
  double total = 0.0;
  const auto run = [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group,
                                                                   std::size_t g) {
    const GroupLoad& load = loads_[g];
    const auto& table = gradient_rule<n_dofs, n_vertices>(group, load.rules);
    std::vector<double> of_parts(load.weighted_f.size(), 0.0);
    for_parts(group.n_own, [&](std::size_t part, std::size_t first, std::size_t last) {
      for (std::size_t cell = first; cell < last; ++cell) {
        const CellFunction<dim, n_dofs, n_vertices> function(group, cell, x, u);
        for (std::size_t q = 0; q < table.n_points; ++q) {
          const auto mapped = function.map(table, q);
          of_parts[part] += mapped.weight * solution_.energy_of(function.gradient(table, q, mapped),
                                                                point_of(mapped.position));
        }
        for (std::size_t i = 0; i < n_dofs; ++i)
          of_parts[part] -= 2.0 * load.values[cell * n_dofs + i] * (function.values[i] - c);
      }
    });
    total = std::accumulate(of_parts.begin(), of_parts.end(), total);
  };
  for_each_smooth_group(*space_, run);
  return total;
}

/// Cells with the same rule share lanes.
template <int dim>
template <std::size_t n_dofs, std::size_t n_vertices>
void Energy<dim>::add_load_terms(const ElementCells& group, const GroupLoad& load, std::size_t part,
                                 const std::vector<std::size_t>& cells,
                                 const std::vector<Point<dim>>& x, const Eigen::VectorXd& u,
                                 std::vector<std::array<Point<dim>, n_vertices>>& of_cells) const {
  const auto& rules = load.rules.load;
  // The values of a cell follow those of the earlier cells in its part.
  std::vector<const double*> weighted_f;
  const double* next = load.weighted_f[part].data();
  for (const std::size_t cell : cells) {
    weighted_f.push_back(next);
    next += rules[load.levels[cell]].n_points;
  }
  for (std::size_t level = 0; level < rules.size(); ++level) {
    std::vector<std::size_t> of_level;
    std::copy_if(cells.begin(), cells.end(), std::back_inserter(of_level),
                 [&](std::size_t cell) { return load.levels[cell] == level; });
    add_in_lanes<dim, n_dofs, n_vertices>(
        group, of_level, x, u, of_cells,
        [&](const auto& function, const auto& some, auto& of_lanes) {
          std::array<const double*, n_lanes> f;
          for (std::size_t l = 0; l < n_lanes; ++l) f[l] = weighted_f[some[l] - cells.front()];
          add_load_term(function, rules[level], f, of_lanes);
        });
  }
}

template <int dim>
std::vector<Point<dim>> Energy<dim>::gradient(const std::vector<Point<dim>>& x,
                                              const Eigen::VectorXd& u) const {
  std::vector<Point<dim>> sums(x.size(), Point<dim>::Zero());
  const auto run = [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group,
                                                                   std::size_t g) {
    const GroupLoad& load = loads_[g];
    const auto& table = gradient_rule<n_dofs, n_vertices>(group, load.rules);
    std::vector<std::array<Point<dim>, n_vertices>> of_cells(group.n_own);
    for (auto& of_cell : of_cells) of_cell.fill(Point<dim>::Zero());
    for_parts(group.n_own, [&](std::size_t part, std::size_t first, std::size_t last) {
      std::vector<std::size_t> cells(last - first);
      std::iota(cells.begin(), cells.end(), first);
      if (solution_.diffusivity)
        for (const std::size_t cell : cells)
          add_diffusion_term(CellFunction<dim, n_dofs, n_vertices>(group, cell, x, u), table,
                             solution_, of_cells[cell]);
      else
        add_in_lanes<dim, n_dofs, n_vertices>(
            group, cells, x, u, of_cells, [&](const auto& function, const auto&, auto& of_lanes) {
              add_dirichlet_term(function, table, of_lanes);
            });
      if constexpr (is_linear<dim, n_dofs, n_vertices>) {
        for (const std::size_t cell : cells) {
          const CellFunction<dim, n_dofs, n_vertices> function(group, cell, x, u);
          const Point<dim> slope = function.gradient(table, 0, function.map(table, 0));
          // Vertices and dofs of these elements have the same order.
          for (std::size_t v = 0; v < n_vertices; ++v)
            of_cells[cell][v] += 2.0 * load.values[cell * n_dofs + v] * slope;
        }
      } else {
        add_load_terms<n_dofs, n_vertices>(group, load, part, cells, x, u, of_cells);
      }
    });
    for (std::size_t k = 0; k < group.n_own * n_vertices; ++k)
      sums[group.vertices[k]] += of_cells[k / n_vertices][k % n_vertices];
  };
  for_each_smooth_group(*space_, run);
  return sums;
}

template class Energy<2>;
template class Energy<3>;

}  // namespace smoothfem
