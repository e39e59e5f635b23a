// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ginac/ginac.h>

#include <string>
#include <vector>

// Includes GiNaC's headers: for sources of this folder only.

namespace smoothfem {

/// choose(comparison, d, a, b): a if d is below (0), at most (1) or equal to (2) zero, otherwise b.
/// Its derivative is that of the chosen piece, so that formulas with conditions have derivatives.
DECLARE_FUNCTION_4P(choose)
constexpr int below_zero = 0, at_most_zero = 1, equal_to_zero = 2;

/// Makes `choose` with a number for the comparison.
GiNaC::ex choice(int comparison, const GiNaC::ex& d, const GiNaC::ex& a, const GiNaC::ex& b);
/// Makes a conditional. As in muParser, true is 1 and false is 0.
GiNaC::ex if_else(const GiNaC::ex& condition, const GiNaC::ex& a, const GiNaC::ex& b);

/// A function of formulas.
struct FormulaFunction {
  std::string name;
  std::size_t fewest, most;  ///< numbers of arguments
  GiNaC::ex (*make)(const GiNaC::exvector& arguments);
};

/// Returns all functions, sorted by name.
const std::vector<FormulaFunction>& formula_functions();

}  // namespace smoothfem
