// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include "fem/formulas/formula_expression.h"
#include "fem/solutions/manufactured_solution.h"

// Includes GiNaC's headers: for sources of this folder only.

namespace smoothfem {

/// Reads a formula of a study for one of its solution's keys. Throws InputError that names the part
/// that cannot be read.
GiNaC::ex read_formula(const std::string& key, const std::string& text, int dim);

/// Splits a text at separators outside of all brackets.
std::vector<std::string> split_outside_brackets(const std::string& text, char separator);

/// The formulas of a diffusivity: see derived_solution.
template <int dim>
struct DiffusivityFormulas {
  std::array<std::array<GiNaC::ex, dim>, dim> entries;
  std::string text;  ///< as given

  /// Makes the identity.
  DiffusivityFormulas();
  /// Throws InputError if the text cannot be read.
  explicit DiffusivityFormulas(const std::string& given);
};

/// Sets the diffusivity of a solution.
template <int dim>
void add_diffusivity(const DiffusivityFormulas<dim>& formulas, ManufacturedSolution<dim>& solution);

/// Collects the expressions that conditions compare with zero, each once.
void find_conditions(const GiNaC::ex& e, std::vector<GiNaC::ex>& conditions);

}  // namespace smoothfem
