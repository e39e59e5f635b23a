// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ginac/ginac.h>

#include <string>
#include <vector>

// With GiNaC's headers: for sources of this folder only.

namespace smoothfem {

/// The variables of formulas: x, y and, in space, z; always the same ones.
const std::vector<GiNaC::symbol>& formula_variables();

/// A formula as GiNaC's expression, from the syntax of muParser: + - * / ^, comparisons, && || and
/// !, `c ? a : b`, the functions of formula_functions(), pi; numbers are taken exactly. dim: how
/// many variables there are. Throws InputError with what is not understood and where, to stand in
/// brackets in a sentence.
GiNaC::ex parse_formula(const std::string& text, int dim);

}  // namespace smoothfem
