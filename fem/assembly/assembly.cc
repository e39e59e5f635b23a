// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/assembly/assembly.h"

#include <numeric>

#include "fem/assembly/cell_integrals.h"
#include "fem/assembly/cell_load.h"
#include "fem/space/natural_load.h"

namespace smoothfem {

namespace {

constexpr auto absent = FiniteElementSpace<2>::absent;

/// Adds a cell's integrals to the equations of this rank that they contribute to. lane: the cell's
/// position in the batch.
template <int dim, std::size_t n_dofs>
void add_cell(const FiniteElementSpace<dim>& space, const ElementCells& group, std::size_t cell,
              const CellIntegrals<n_dofs, Lanes>& integrals, std::size_t lane,
              PoissonSystem& system) {
  const std::uint32_t* dofs = &group.dofs[cell * n_dofs];
  const std::uint32_t* entries = &group.entries[cell * n_dofs * n_dofs];
  double* values = system.matrix.valuePtr();
  const auto add = [&](std::size_t i, std::size_t j, double stiffness) {
    if (dofs[i] >= space.n_own) return;
    const std::uint32_t entry = entries[i * n_dofs + j];
    if (entry != absent)
      values[entry] += stiffness;
    else
      system.right_hand_side[dofs[i]] -= stiffness * system.exact[dofs[j]];
  };
  for (std::size_t i = 0, p = 0; i < n_dofs; ++i) {
    if (dofs[i] < space.n_own) system.right_hand_side[dofs[i]] += integrals.load[i][lane];
    for (std::size_t j = i; j < n_dofs; ++j, ++p) {
      const double stiffness = integrals.stiffness[p][lane];
      add(i, j, stiffness);
      if (i != j) add(j, i, stiffness);
    }
  }
}

/// Adds the integrals of the cells of one element whose rule is chosen cell by cell. The result for
/// a cell does not depend on the others.
template <int dim, std::size_t n_dofs, std::size_t n_vertices, class AnyDiffusivity>
class CellAssembly {
 public:
  CellAssembly(const FiniteElementSpace<dim>& space, const ElementCells& group,
               const std::vector<Point<dim>>& x, const Eigen::VectorXd& nodal_load,
               const AnyDiffusivity& diffusivity, PoissonSystem& system)
      : space_(space),
        group_(group),
        x_(x),
        nodal_load_(nodal_load),
        diffusivity_(diffusivity),
        system_(system) {}

  void run() {
    std::vector<std::size_t> cells(group_.n_cells());
    std::iota(cells.begin(), cells.end(), std::size_t{0});
    for (std::size_t level = 0; !cells.empty(); ++level) cells = add_settled(cells, level);
  }

 private:
  using Integrals = CellIntegrals<n_dofs, Lanes>;
  static constexpr bool is_constant = std::is_same_v<AnyDiffusivity, IdentityDiffusivity>;

  /// Returns the cells that need a finer rule.
  std::vector<std::size_t> add_settled(const std::vector<std::size_t>& cells, std::size_t level) {
    std::vector<std::size_t> others;
    Integrals coarse, fine;
    for (std::size_t first = 0; first < cells.size(); first += n_lanes) {
      const ElementBatch<dim, n_dofs, n_vertices> batch(group_, x_, nodal_load_, cells, first);
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
        add_cell(space_, group_, cell, fine, l, system_);
        if (cell >= group_.n_own) continue;
        system_.n_folded_cells += is_folded;
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
  const Eigen::VectorXd& nodal_load_;
  const AnyDiffusivity& diffusivity_;
  PoissonSystem& system_;
};

/// Computes b_i += integral of f phi_i over the cells of one element.
template <int dim, std::size_t n_dofs, std::size_t n_vertices>
void add_quadrature_load(const FiniteElementSpace<dim>& space, const ElementCells& group,
                         const std::vector<Point<dim>>& x,
                         const ManufacturedSolution<dim>& solution, PoissonSystem& system) {
  const ReferenceElement& element = group.element;
  for (std::size_t cell = 0; cell < group.n_cells(); ++cell) {
    const auto vertices = cell_vertices<dim, n_vertices>(group, cell, x);
    CellLoad<n_dofs> load(element.errors, vertices, solution);
    bool is_settled = element.n_rules() == 1;
    std::size_t level = 0;
    while (!is_settled && level + 1 < element.n_rules()) {
      const CellLoad<n_dofs> finer(element.rule(++level), vertices, solution);
      is_settled = load.is_near(finer, adaptive_quadrature::tolerance_at(level, element.n_rules()));
      load = finer;
    }
    if (element.n_rules() > 1 && cell < group.n_own) system.points.note(level, is_settled);
    for (std::size_t i = 0; i < n_dofs; ++i) {
      const std::uint32_t row = group.dofs[cell * n_dofs + i];
      if (row < space.n_own) system.right_hand_side[row] += load.values[i];
    }
  }
}

}  // namespace

template <int dim>
PoissonSystem make_system(const FiniteElementSpace<dim>& space) {
  return {.matrix = space.pattern,
          .right_hand_side = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.n_own)),
          .exact = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.n_local))};
}

template <int dim>
void assemble(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
              const ManufacturedSolution<dim>& solution, Load load, PoissonSystem& system) {
  const auto points = space.dof_points(x);
  Eigen::VectorXd nodal_load = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.n_local));
  for (std::size_t dof = 0; dof < space.n_local; ++dof) {
    const auto i = static_cast<Eigen::Index>(dof);
    system.exact[i] = solution.value(points[dof]);
    if (load == Load::nodal) nodal_load[i] = solution.load(points[dof]);
  }
  system.matrix.coeffs().setZero();
  system.right_hand_side.setZero();
  system.n_folded_cells = 0;
  system.points = {};
  for_each_group(space, [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group) {
    const auto run = [&]<class AnyDiffusivity>(const AnyDiffusivity& diffusivity) {
      CellAssembly<dim, n_dofs, n_vertices, AnyDiffusivity>(space, group, x, nodal_load,
                                                            diffusivity, system)
          .run();
    };
    if (solution.diffusivity)
      run(VariableDiffusivity<dim>{solution.diffusivity});
    else
      run(IdentityDiffusivity{});
    if (load == Load::quadrature)
      add_quadrature_load<dim, n_dofs, n_vertices>(space, group, x, solution, system);
  });
  add_natural_load(space, x, solution, system.right_hand_side);
}

#define SMOOTHFEM_INSTANTIATE(dim)                                                       \
  template PoissonSystem make_system(const FiniteElementSpace<dim>&);                    \
  template void assemble(const FiniteElementSpace<dim>&, const std::vector<Point<dim>>&, \
                         const ManufacturedSolution<dim>&, Load, PoissonSystem&);
SMOOTHFEM_INSTANTIATE(2)
SMOOTHFEM_INSTANTIATE(3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
