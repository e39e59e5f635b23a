// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ginac/ginac.h>

#include <string>
#include <vector>

// Includes GiNaC's headers: for sources of this folder only.

namespace smoothfem {

/// Returns the variables of formulas: x, y and, in space, z. They are the same objects in every
/// call.
const std::vector<GiNaC::symbol>& formula_variables();

/// Parses a formula with the syntax of muParser: + - * / ^, comparisons, && || and !, `c ? a : b`,
/// the functions of formula_functions(), pi. Numbers are exact. dim: number of variables. Throws
/// InputError with the unknown part and its position; the text fits into parentheses of a sentence.
GiNaC::ex parse_formula(const std::string& text, int dim);

}  // namespace smoothfem
