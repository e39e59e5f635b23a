// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace GiNaC {
class ex;
}

namespace smoothfem {

/// Several formulas as a list of steps that computes them together; parts that they share are
/// computed once. The steps do not depend on the order that GiNaC happens to keep terms in, which
/// changes from run to run: results have the same bits in each. Safe to call from several threads.
class FormulaProgram {
 public:
  /// formulas: in the variables of formula_variables(). Throws InputError, with a text to stand in
  /// brackets in a sentence, for what has no real value.
  explicit FormulaProgram(const std::vector<GiNaC::ex>& formulas);

  /// coordinates: x, y and, if a formula has it, z. values: one for each formula.
  void evaluate(const double* coordinates, double* values) const;

 private:
  friend class FormulaCompiler;
  enum class Operation : std::uint8_t {
    number,
    coordinate,
    add,
    multiply,
    whole_power,
    function,
    function_of_two,
    below_zero,  ///< b where a is below zero, else c; and so on
    at_most_zero,
    equal_to_zero
  };
  /// Its value is kept under its number in the list.
  struct Step {
    Operation operation = Operation::number;
    std::uint32_t a = 0, b = 0, c = 0;  ///< steps before this one; a coordinate's number
    int exponent = 0;
    double number = 0.0;
    double (*function)(double) = nullptr;
    double (*function_of_two)(double, double) = nullptr;
  };
  std::vector<Step> steps_;
  std::vector<std::uint32_t> results_;
};

}  // namespace smoothfem
