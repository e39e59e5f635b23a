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

/// Several formulas, compiled to a list of steps that computes them together. Common parts are
/// computed once. The steps do not depend on GiNaC's order of terms, which changes from run to run:
/// results are bitwise identical in every run. Safe to call from several threads.
class FormulaProgram {
 public:
  /// formulas: in the variables of formula_variables(). Throws InputError for formulas without real
  /// values; the text fits into parentheses of a sentence.
  explicit FormulaProgram(const std::vector<GiNaC::ex>& formulas);

  /// Evaluates the formulas. coordinates: x, y and, if a formula has it, z. values: one for each
  /// formula.
  void evaluate(const double* coordinates, double* values) const;

  /// Evaluates the formulas at n points, which is faster. coordinates: of the points, one after the
  /// other, `dimension` for each. values: of the points, one after the other, one for each formula.
  void evaluate(std::size_t n, std::size_t dimension, const double* coordinates,
                double* values) const;

 private:
  friend class FormulaCompiler;
  enum class Operation : std::uint8_t {
    number,
    coordinate,
    add,
    multiply,
    integer_power,
    function,
    function_of_two,
    below_zero,  ///< b if a is below zero, otherwise c; similarly below
    at_most_zero,
    equal_to_zero
  };
  /// A step of the program. Its value is stored under its number in the list.
  struct Step {
    Operation operation = Operation::number;
    std::uint32_t a = 0, b = 0, c = 0;  ///< earlier steps; a coordinate's number
    int exponent = 0;
    double number = 0.0;
    double (*function)(double) = nullptr;
    double (*function_of_two)(double, double) = nullptr;
  };
  /// Evaluates the formulas at one point in each lane.
  template <std::size_t lanes>
  void run(std::size_t dimension, const double* coordinates, double* values) const;

  std::vector<Step> steps_;
  std::vector<std::uint32_t> results_;
};

}  // namespace smoothfem
