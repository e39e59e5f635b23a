// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>

#include "fem/formulas/formula_expression.h"
#include "fem/solutions/manufactured_solution.h"

// With GiNaC's headers: for sources of this folder only.

namespace smoothfem {

/// A formula that a study gives for one of its solution's keys. Throws InputError that says what in
/// it is not understood.
GiNaC::ex read_formula(const std::string& key, const std::string& text, int dim);

/// The formulas of a diffusivity: see derived_solution.
template <int dim>
struct DiffusivityFormulas {
  std::array<std::array<GiNaC::ex, dim>, dim> entries;
  std::string text;  ///< as given

  /// The identity.
  DiffusivityFormulas();
  /// Throws InputError if the text cannot be read.
  explicit DiffusivityFormulas(const std::string& given);
};

/// Gives the solution this diffusivity.
template <int dim>
void add_diffusivity(const DiffusivityFormulas<dim>& formulas, ManufacturedSolution<dim>& solution);

/// What the conditions in an expression compare with zero, each once.
void find_conditions(const GiNaC::ex& e, std::vector<GiNaC::ex>& conditions);

}  // namespace smoothfem
