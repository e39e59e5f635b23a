// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/assembly/assembly.h"

#include <algorithm>
#include <numeric>

#include "fem/assembly/add_cell.h"
#include "fem/assembly/cell_integrals.h"
#include "fem/assembly/cell_load.h"
#include "fem/materials/materials_of_mesh.h"
#include "fem/space/natural_load.h"

namespace smoothfem {

namespace {

/// Adds the integrals of the cells of one element whose rule is chosen cell by cell. The result for
/// a cell does not depend on the others.
template <int dim, std::size_t n_dofs, std::size_t n_vertices, class AnyDiffusivity, class LoadAt>
class CellAssembly {
 public:
  CellAssembly(const FiniteElementSpace<dim>& space, const ElementCells& group,
               const std::vector<Point<dim>>& x, const LoadAt& load_at,
               const AnyDiffusivity& diffusivity, PoissonSystem& system)
      : space_(space),
        group_(group),
        x_(x),
        load_at_(load_at),
        diffusivity_(diffusivity),
        system_(system) {}

  void run(std::vector<std::size_t> cells) {
    for (std::size_t level = 0; !cells.empty(); ++level) cells = add_settled(cells, level);
  }

 private:
  using Integrals = CellIntegrals<n_dofs, Lanes>;
  static constexpr bool is_constant = is_constant_diffusivity<AnyDiffusivity>;

  /// Returns the cells that need a finer rule.
  std::vector<std::size_t> add_settled(const std::vector<std::size_t>& cells, std::size_t level) {
    std::vector<std::size_t> others;
    Integrals coarse, fine;
    for (std::size_t first = 0; first < cells.size(); first += n_lanes) {
      const ElementBatch<dim, n_dofs, n_vertices> batch(group_, x_, load_at_, cells, first);
      if (level > 0)
        coarse.template compute<dim, n_vertices>(group_.element, level - 1, batch.vertices,
                                                 batch.load, diffusivity_);
      fine.template compute<dim, n_vertices>(group_.element, level, batch.vertices, batch.load,
                                             diffusivity_);
      for (std::size_t l = 0; l < batch.size; ++l) {
        const std::size_t cell = batch.cells[l];
        const bool is_folded = !(fine.smallest_determinant[l] > 0.0);
        const std::size_t n_rules = group_.element.n_rules();
        const double tolerance = adaptive_quadrature::tolerance_at(level, n_rules);
        // A nearly constant determinant does not bound the variation of a diffusivity.
        const bool is_settled = is_folded || (level == 0 ? is_constant && is_even(fine, l)
                                                         : is_near(coarse, fine, l, tolerance));
        if (!is_settled && level + 1 < n_rules) {
          others.push_back(cell);
          continue;
        }
        add_cell<dim, n_dofs>(space_, group_, cell, fine, l, system_);
        if (cell >= group_.n_own) continue;
        system_.n_folded_cells += is_folded;
        if (is_folded)
          system_.first_folded_cell =
              std::min<std::size_t>(system_.first_folded_cell, group_.numbers[cell]);
        if (n_rules > 1) system_.points.note(level, is_settled);
      }
    }
    return others;
  }

  static bool is_even(const Integrals& integrals, std::size_t lane) {
    return integrals.largest_determinant[lane] <=
           adaptive_quadrature::even_determinants * integrals.smallest_determinant[lane];
  }

  static bool is_near(const Integrals& coarse, const Integrals& fine, std::size_t lane,
                      double tolerance) {
    double change = 0.0, square = 0.0;
    for (std::size_t i = 0, p = 0; i < n_dofs; ++i)
      for (std::size_t j = i; j < n_dofs; ++j, ++p) {
        const double times = i == j ? 1.0 : 2.0, entry = fine.stiffness[p][lane],
                     difference = entry - coarse.stiffness[p][lane];
        change += times * difference * difference;
        square += times * entry * entry;
      }
    return change <= tolerance * tolerance * square;
  }

  const FiniteElementSpace<dim>& space_;
  const ElementCells& group_;
  const std::vector<Point<dim>>& x_;
  const LoadAt& load_at_;
  const AnyDiffusivity& diffusivity_;
  PoissonSystem& system_;
};

/// True if a cell is straight-sided: its mapping is the same without midside nodes.
template <int dim>
bool is_straight(const ElementCells& group, std::size_t cell, const std::vector<Point<dim>>& x) {
  const NodeIndex* points = group.mapping_points(cell);
  const auto& substitutes = group.element.mapping.substitutes;
  for (std::size_t k = group.element.n_vertices; k < substitutes.size(); ++k) {
    Point<dim> straight = Point<dim>::Zero();
    for (const auto& [earlier, weight] : substitutes[k]) straight += weight * x[points[earlier]];
    if (x[points[k]] != straight) return false;
  }
  return true;
}

/// Adds the integrals of some cells of one element. Among curved simplices, straight-sided ones
/// have the exact matrices of straight-sided spaces, which cost much less.
template <int dim, std::size_t n_dofs, std::size_t n_points, class AnyDiffusivity, class LoadAt>
void add_cells(const FiniteElementSpace<dim>& space, const ElementCells& group,
               std::vector<std::size_t> cells, const std::vector<Point<dim>>& x,
               const LoadAt& load_at, const AnyDiffusivity& diffusivity, PoissonSystem& system) {
  if constexpr (n_points == n_curved_simplex<dim> && is_constant_diffusivity<AnyDiffusivity>) {
    const auto curved = std::stable_partition(
        cells.begin(), cells.end(), [&](std::size_t cell) { return is_straight(group, cell, x); });
    CellAssembly<dim, n_dofs, dim + 1, AnyDiffusivity, LoadAt>(space, group, x, load_at,
                                                               diffusivity, system)
        .run({cells.begin(), curved});
    cells.erase(cells.begin(), curved);
  }
  CellAssembly<dim, n_dofs, n_points, AnyDiffusivity, LoadAt>(space, group, x, load_at, diffusivity,
                                                              system)
      .run(std::move(cells));
}

/// Computes b_i += integral of f phi_i over the cells of one element. f_of(cell): f as a function
/// of the position.
template <int dim, std::size_t n_dofs, std::size_t n_vertices, class FunctionOf>
void add_quadrature_load(const FiniteElementSpace<dim>& space, const ElementCells& group,
                         const std::vector<Point<dim>>& x, const FunctionOf& f_of,
                         PoissonSystem& system) {
  const ReferenceElement& element = group.element;
  for (std::size_t cell = 0; cell < group.n_cells(); ++cell) {
    const auto vertices = cell_vertices<dim, n_vertices>(group, cell, x);
    const PointFunction<dim, double>& f = f_of(cell);
    const Settled<CellLoad<n_dofs>> load(element, [&](const QuadratureTable& table) {
      return CellLoad<n_dofs>(table, vertices, f);
    });
    if (element.n_rules() > 1 && cell < group.n_own)
      system.points.note(load.level, load.is_settled);
    for (std::size_t i = 0; i < n_dofs; ++i)
      space.for_each_master(group.dofs[cell * n_dofs + i], [&](std::uint32_t row, double weight) {
        if (row < space.n_own) system.right_hand_side[row] += weight * load.integrals.values[i];
      });
  }
}

/// Assembly of the cells of one element whose A and f are those of their materials. f is evaluated
/// on the cell's own side of interfaces.
template <int dim, std::size_t n_dofs, std::size_t n_vertices>
class MaterialAssembly {
 public:
  MaterialAssembly(const FiniteElementSpace<dim>& space, const ElementCells& group,
                   const std::vector<Point<dim>>& x, const std::vector<Point<dim>>& dof_points,
                   const std::vector<Material<dim>>& materials,
                   const std::vector<std::uint32_t>& of_kinds, Load load, PoissonSystem& system)
      : space_(space),
        group_(group),
        x_(x),
        dof_points_(dof_points),
        materials_(materials),
        of_kinds_(of_kinds),
        load_(load),
        system_(system) {}

  void run() {
    for (const Material<dim>& material : materials_) {
      std::vector<std::size_t> cells;
      for (std::size_t cell = 0; cell < group_.n_cells(); ++cell)
        if (&of_cell(cell) == &material) cells.push_back(cell);
      if (material.constant)
        add(cells, ConstantDiffusivity{*material.constant});
      else
        add(cells, VariableDiffusivity<dim>{material.diffusivity});
    }
    if (load_ == Load::quadrature)
      add_quadrature_load<dim, n_dofs, n_vertices>(
          space_, group_, x_, [&](std::size_t cell) -> auto& { return of_cell(cell).load; },
          system_);
  }

 private:
  const Material<dim>& of_cell(std::size_t cell) const {
    return materials_[of_kinds_[group_.kinds[cell]]];
  }

  template <class AnyDiffusivity>
  void add(const std::vector<std::size_t>& cells, const AnyDiffusivity& diffusivity) {
    const auto load_at = [&](std::size_t cell, std::size_t i) {
      if (load_ != Load::nodal) return 0.0;
      Point<dim> mean = Point<dim>::Zero();
      const std::size_t n_corners = group_.element.n_vertices;
      for (std::size_t v = 0; v < n_corners; ++v) mean += x_[group_.vertices[cell * n_corners + v]];
      mean /= static_cast<double>(n_corners);
      return of_cell(cell).load(
          slightly_inside<dim>(dof_points_[group_.dofs[cell * n_dofs + i]], mean));
    };
    add_cells<dim, n_dofs, n_vertices>(space_, group_, cells, x_, load_at, diffusivity, system_);
  }

  const FiniteElementSpace<dim>& space_;
  const ElementCells& group_;
  const std::vector<Point<dim>>& x_;
  const std::vector<Point<dim>>& dof_points_;
  const std::vector<Material<dim>>& materials_;
  const std::vector<std::uint32_t>& of_kinds_;
  const Load load_;
  PoissonSystem& system_;
};

/// Throws CellError on all ranks for the first cell that is folded at a point. Collective.
void require_unfolded(const Ranks& ranks, const PoissonSystem& system) {
  const double none = static_cast<double>(no_cell);
  const double first = -ranks.max(-static_cast<double>(system.first_folded_cell));
  if (first < none)
    throw CellError(
        static_cast<std::size_t>(first),
        "is folded inside by its midside nodes: the Jacobian determinant of its mapping "
        "is not positive at a quadrature point; move these nodes towards the middle of "
        "their edges, or write 'set geometry = straight'");
}

}  // namespace

template <int dim>
PoissonSystem make_system(const FiniteElementSpace<dim>& space) {
  return {.matrix = space.pattern.zeros(),
          .right_hand_side = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.n_own)),
          .exact = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.n_local))};
}

template <int dim>
std::vector<std::uint32_t> materials_of_kinds(const Ranks& ranks,
                                              const ManufacturedSolution<dim>& solution) {
  auto materials = solution.material_of_kind;
  if (!solution.materials.empty()) ranks.broadcast(materials);
  return materials;
}

template <int dim>
void assemble(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
              const ManufacturedSolution<dim>& solution, Load load, PoissonSystem& system) {
  const auto points = space.dof_points(x);
  const auto materials = materials_of_kinds(space.ranks, solution);
  system.exact = space.values_at_dofs(solution.value, x, points);
  Eigen::VectorXd nodal_load = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.n_local));
  if (load == Load::nodal && materials.empty())
    for (std::size_t dof = 0; dof < space.n_local; ++dof)
      nodal_load[static_cast<Eigen::Index>(dof)] = solution.load(points[dof]);
  system.matrix.coeffs().setZero();
  system.right_hand_side.setZero();
  system.n_folded_cells = 0;
  system.first_folded_cell = no_cell;
  system.points = {};
  for_each_group(space, [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group) {
    if (!materials.empty())
      return MaterialAssembly<dim, n_dofs, n_vertices>(space, group, x, points, solution.materials,
                                                       materials, load, system)
          .run();
    const auto load_at = [&](std::size_t cell, std::size_t i) {
      return nodal_load[group.dofs[cell * n_dofs + i]];
    };
    std::vector<std::size_t> cells(group.n_cells());
    std::iota(cells.begin(), cells.end(), std::size_t{0});
    const auto run = [&]<class AnyDiffusivity>(const AnyDiffusivity& diffusivity) {
      add_cells<dim, n_dofs, n_vertices>(space, group, cells, x, load_at, diffusivity, system);
    };
    if (solution.diffusivity)
      run(VariableDiffusivity<dim>{solution.diffusivity});
    else
      run(IdentityDiffusivity{});
    if (load == Load::quadrature)
      add_quadrature_load<dim, n_dofs, n_vertices>(
          space, group, x, [&](std::size_t) -> auto& { return solution.load; }, system);
  });
  if (space.is_curved) require_unfolded(space.ranks, system);
  add_natural_load(space, x, solution, materials, system.right_hand_side);
}

#define SMOOTHFEM_INSTANTIATE(dim)                                                          \
  template PoissonSystem make_system(const FiniteElementSpace<dim>&);                       \
  template std::vector<std::uint32_t> materials_of_kinds(const Ranks&,                      \
                                                         const ManufacturedSolution<dim>&); \
  template void assemble(const FiniteElementSpace<dim>&, const std::vector<Point<dim>>&,    \
                         const ManufacturedSolution<dim>&, Load, PoissonSystem&);
SMOOTHFEM_INSTANTIATE(2)
SMOOTHFEM_INSTANTIATE(3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
