// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ginac/ginac.h>

#include <string>
#include <vector>

// With GiNaC's headers: for sources of this folder only.

namespace smoothfem {

/// choose(comparison, d, a, b): a where d is below (0), at most (1) or equal to (2) zero, else b.
/// Its derivative is that of the piece chosen, so formulas with conditions can be derived.
DECLARE_FUNCTION_4P(choose)
constexpr int below_zero = 0, at_most_zero = 1, equal_to_zero = 2;

/// The same with a number for the comparison.
GiNaC::ex choice(int comparison, const GiNaC::ex& d, const GiNaC::ex& a, const GiNaC::ex& b);
/// As in muParser, what is true is 1, what is false is 0.
GiNaC::ex if_else(const GiNaC::ex& condition, const GiNaC::ex& a, const GiNaC::ex& b);

/// A function that formulas can have.
struct FormulaFunction {
  std::string name;
  std::size_t fewest, most;  ///< arguments
  GiNaC::ex (*make)(const GiNaC::exvector& arguments);
};

/// All of them, sorted by name.
const std::vector<FormulaFunction>& formula_functions();

}  // namespace smoothfem
