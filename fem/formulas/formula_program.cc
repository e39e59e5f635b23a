// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/formulas/formula_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

#include "fem/formulas/formula_expression.h"
#include "fem/formulas/formula_functions.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

using GiNaC::ex;
using GiNaC::ex_to;
using GiNaC::is_exactly_a;

/// Compiles expressions to steps.
class FormulaCompiler {
 public:
  explicit FormulaCompiler(FormulaProgram& program) : program_(program) {}

  std::uint32_t step_of(const ex& e) {
    const auto [entry, is_new] = known_.try_emplace(name_of(e, true), 0);
    if (is_new) {
      const std::uint32_t step = new_step(e);
      known_[entry->first] = step;
      return step;
    }
    return entry->second;
  }

 private:
  using Operation = FormulaProgram::Operation;
  using Step = FormulaProgram::Step;

  /// Returns the operands of a sum or a product in an order that does not depend on GiNaC's. GiNaC
  /// writes (x - y)^2 in one run and (y - x)^2 in another, so that signs count last.
  std::vector<ex> sorted_operands(const ex& e) {
    std::vector<std::pair<std::pair<std::string, std::string>, ex>> operands;
    for (const ex& operand : e)
      operands.push_back({{name_of(operand, false), name_of(operand, true)}, operand});
    std::sort(operands.begin(), operands.end(),
              [](const auto& p, const auto& q) { return p.first < q.first; });
    std::vector<ex> sorted;
    for (const auto& [names, operand] : operands) sorted.push_back(operand);
    return sorted;
  }

  /// Returns the same text for the same expression in every run, with or without the signs of
  /// numbers.
  std::string name_of(const ex& e, bool with_signs) {
    if (is_exactly_a<GiNaC::numeric>(e)) {
      std::ostringstream text;
      text << (with_signs ? e : ex(GiNaC::abs(ex_to<GiNaC::numeric>(e))));
      return text.str();
    }
    if (is_exactly_a<GiNaC::symbol>(e)) return ex_to<GiNaC::symbol>(e).get_name();
    if (is_exactly_a<GiNaC::constant>(e)) return "pi";
    std::vector<std::string> names;
    for (const ex& operand : e) names.push_back(name_of(operand, with_signs));
    std::string text = "^(";
    if (is_exactly_a<GiNaC::function>(e)) {
      text = ex_to<GiNaC::function>(e).get_name() + "(";
    } else if (!is_exactly_a<GiNaC::power>(e)) {
      text = is_exactly_a<GiNaC::add>(e) ? "+(" : "*(";
      std::sort(names.begin(), names.end());
      if (text == "*(" && !with_signs) std::erase(names, "1");  // it was -1
      if (names.size() == 1) return names.front();
    }
    for (const auto& name : names) text += name + ",";
    return text + ")";
  }

  std::uint32_t append(const Step& step) {
    program_.steps_.push_back(step);
    return static_cast<std::uint32_t>(program_.steps_.size() - 1);
  }

  std::uint32_t new_step(const ex& e) {
    if (is_exactly_a<GiNaC::numeric>(e)) {
      const auto& number = ex_to<GiNaC::numeric>(e);
      if (!number.is_real()) throw InputError("its values are complex numbers");
      return append({.operation = Operation::number, .number = number.to_double()});
    }
    if (is_exactly_a<GiNaC::constant>(e))
      return append(
          {.operation = Operation::number, .number = ex_to<GiNaC::numeric>(e.evalf()).to_double()});
    if (is_exactly_a<GiNaC::symbol>(e)) {
      std::uint32_t d = 0;
      while (!e.is_equal(formula_variables()[d])) ++d;
      return append({.operation = Operation::coordinate, .a = d});
    }
    if (is_exactly_a<GiNaC::add>(e)) return chain(e, Operation::add);
    if (is_exactly_a<GiNaC::mul>(e)) return chain(e, Operation::multiply);
    if (is_exactly_a<GiNaC::power>(e)) return power(e.op(0), e.op(1));
    return function(e);
  }

  std::uint32_t chain(const ex& e, Operation operation) {
    const auto operands = sorted_operands(e);
    std::uint32_t result = step_of(operands.front());
    for (std::size_t k = 1; k < operands.size(); ++k) {
      const std::uint32_t next = step_of(operands[k]);
      result = append({.operation = operation, .a = result, .b = next});
    }
    return result;
  }

  std::uint32_t power(const ex& base, const ex& exponent) {
    const std::uint32_t a = step_of(base);
    if (is_exactly_a<GiNaC::numeric>(exponent)) {
      const auto& number = ex_to<GiNaC::numeric>(exponent);
      if (number.is_integer())
        return append({.operation = Operation::integer_power, .a = a, .exponent = number.to_int()});
      if ((2 * number).is_integer() && number.is_real()) {
        const std::uint32_t root =
            append({.operation = Operation::function, .a = a, .function = std::sqrt});
        return append(
            {.operation = Operation::integer_power, .a = root, .exponent = (2 * number).to_int()});
      }
    }
    const std::uint32_t b = step_of(exponent);
    return append(
        {.operation = Operation::function_of_two, .a = a, .b = b, .function_of_two = std::pow});
  }

  std::uint32_t function(const ex& e) {
    static const std::map<std::string, double (*)(double)> of_one{
        {"abs", std::fabs},    {"acos", std::acos}, {"acosh", std::acosh}, {"asin", std::asin},
        {"asinh", std::asinh}, {"atan", std::atan}, {"atanh", std::atanh}, {"cos", std::cos},
        {"cosh", std::cosh},   {"exp", std::exp},   {"log", std::log},     {"sin", std::sin},
        {"sinh", std::sinh},   {"tan", std::tan},   {"tanh", std::tanh}};
    const std::string name =
        is_exactly_a<GiNaC::function>(e) ? ex_to<GiNaC::function>(e).get_name() : "";
    if (name == "choose") {
      const int comparison = ex_to<GiNaC::numeric>(e.op(0)).to_int();
      const auto operation = comparison == below_zero     ? Operation::below_zero
                             : comparison == at_most_zero ? Operation::at_most_zero
                                                          : Operation::equal_to_zero;
      const std::uint32_t d = step_of(e.op(1)), yes = step_of(e.op(2)), no = step_of(e.op(3));
      return append({.operation = operation, .a = d, .b = yes, .c = no});
    }
    if (name == "atan2") {
      const std::uint32_t a = step_of(e.op(0)), b = step_of(e.op(1));
      return append(
          {.operation = Operation::function_of_two, .a = a, .b = b, .function_of_two = std::atan2});
    }
    const auto found = of_one.find(name);
    if (found == of_one.end()) throw InputError("it cannot be derived");
    return append(
        {.operation = Operation::function, .a = step_of(e.op(0)), .function = found->second});
  }

  FormulaProgram& program_;
  std::map<std::string, std::uint32_t> known_;
};

FormulaProgram::FormulaProgram(const std::vector<GiNaC::ex>& formulas) {
  FormulaCompiler compiler(*this);
  for (const auto& formula : formulas) results_.push_back(compiler.step_of(formula));
}

namespace {

template <std::size_t lanes>
using InLanes = std::array<double, lanes>;

/// Computes powers by squaring: std::pow takes about twenty times as long.
template <std::size_t lanes>
void integer_power(InLanes<lanes> base, int exponent, InLanes<lanes>& result) {
  result.fill(1.0);
  for (unsigned int rest = static_cast<unsigned int>(std::abs(exponent)); rest > 0; rest /= 2) {
    if (rest % 2 == 1)
      for (std::size_t l = 0; l < lanes; ++l) result[l] *= base[l];
    for (double& b : base) b *= b;
  }
  if (exponent < 0)
    for (double& r : result) r = 1.0 / r;
}

}  // namespace

template <std::size_t lanes>
void FormulaProgram::run(std::size_t dimension, const double* coordinates, double* values) const {
  thread_local std::vector<InLanes<lanes>> kept;
  if (kept.size() < steps_.size()) kept.resize(steps_.size());
  InLanes<lanes>* value = kept.data();
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const Step& s = steps_[k];
    const InLanes<lanes>&a = value[s.a], &b = value[s.b], &c = value[s.c];
    InLanes<lanes>& result = value[k];
    const auto choose = [&](const auto& is_first) {
      for (std::size_t l = 0; l < lanes; ++l) result[l] = is_first(a[l]) ? b[l] : c[l];
    };
    switch (s.operation) {
      case Operation::number:
        result.fill(s.number);
        break;
      case Operation::coordinate:
        for (std::size_t l = 0; l < lanes; ++l) result[l] = coordinates[l * dimension + s.a];
        break;
      case Operation::add:
        for (std::size_t l = 0; l < lanes; ++l) result[l] = a[l] + b[l];
        break;
      case Operation::multiply:
        for (std::size_t l = 0; l < lanes; ++l) result[l] = a[l] * b[l];
        break;
      case Operation::integer_power:
        integer_power<lanes>(a, s.exponent, result);
        break;
      case Operation::function:
        for (std::size_t l = 0; l < lanes; ++l) result[l] = s.function(a[l]);
        break;
      case Operation::function_of_two:
        for (std::size_t l = 0; l < lanes; ++l) result[l] = s.function_of_two(a[l], b[l]);
        break;
      case Operation::below_zero:
        choose([](double d) { return d < 0.0; });
        break;
      case Operation::at_most_zero:
        choose([](double d) { return d <= 0.0; });
        break;
      case Operation::equal_to_zero:
        choose([](double d) { return d == 0.0; });
        break;
    }
  }
  for (std::size_t l = 0; l < lanes; ++l)
    for (std::size_t r = 0; r < results_.size(); ++r)
      values[l * results_.size() + r] = value[results_[r]][l];
}

void FormulaProgram::evaluate(const double* coordinates, double* values) const {
  run<1>(0, coordinates, values);
}

void FormulaProgram::evaluate(std::size_t n, std::size_t dimension, const double* coordinates,
                              double* values) const {
  constexpr std::size_t lanes = 8;
  std::size_t k = 0;
  for (; k + lanes <= n; k += lanes)
    run<lanes>(dimension, coordinates + k * dimension, values + k * results_.size());
  for (; k < n; ++k) run<1>(dimension, coordinates + k * dimension, values + k * results_.size());
}

}  // namespace smoothfem
