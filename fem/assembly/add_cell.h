// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "fem/assembly/assembly.h"

namespace smoothfem {

/// Does the same as add_cell, for a cell with tied dofs: its parts go to these dofs' masters.
template <int dim, std::size_t n_dofs, class Integrals>
void add_tied_cell(const FiniteElementSpace<dim>& space, const std::uint32_t* dofs,
                   const Integrals& integrals, std::size_t lane, PoissonSystem& system) {
  const auto add = [&](std::size_t i, std::size_t j, double stiffness) {
    space.for_each_master(dofs[i], [&](std::uint32_t row, double of_row) {
      if (row >= space.n_own) return;
      space.for_each_master(dofs[j], [&](std::uint32_t column, double of_column) {
        const double part = of_row * of_column * stiffness;
        if (const std::uint32_t entry = space.entry(row, column);
            entry != FiniteElementSpace<dim>::absent)
          system.matrix.valuePtr()[entry] += part;
        else
          system.right_hand_side[row] -= part * system.exact[column];
      });
    });
  };
  for (std::size_t i = 0, p = 0; i < n_dofs; ++i) {
    space.for_each_master(dofs[i], [&](std::uint32_t row, double weight) {
      if (row < space.n_own) system.right_hand_side[row] += weight * integrals.load[i][lane];
    });
    for (std::size_t j = i; j < n_dofs; ++j, ++p) {
      add(i, j, integrals.stiffness[p][lane]);
      if (i != j) add(j, i, integrals.stiffness[p][lane]);
    }
  }
}

/// Adds a cell's integrals to the equations of this rank that they contribute to. lane: the cell's
/// position in the batch.
template <int dim, std::size_t n_dofs, class Integrals>
void add_cell(const FiniteElementSpace<dim>& space, const ElementCells& group, std::size_t cell,
              const Integrals& integrals, std::size_t lane, PoissonSystem& system) {
  const std::uint32_t* dofs = &group.dofs[cell * n_dofs];
  if (!space.ties.empty() &&
      std::any_of(dofs, dofs + n_dofs, [&](std::uint32_t dof) { return space.is_tied(dof); }))
    return add_tied_cell<dim, n_dofs>(space, dofs, integrals, lane, system);
  const std::uint32_t* entries =
      group.entries.empty() ? nullptr : &group.entries[cell * n_dofs * n_dofs];
  double* values = system.matrix.valuePtr();
  const auto add = [&](std::size_t i, std::size_t j, double stiffness) {
    if (dofs[i] >= space.n_own) return;
    const std::uint32_t entry =
        entries != nullptr ? entries[i * n_dofs + j] : space.entry(dofs[i], dofs[j]);
    if (entry != FiniteElementSpace<dim>::absent)
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

}  // namespace smoothfem
