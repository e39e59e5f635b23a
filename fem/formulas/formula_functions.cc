// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/formulas/formula_functions.h"

#include <limits>

namespace smoothfem {

namespace {

using GiNaC::ex;
using GiNaC::exvector;

ex choose_eval(const ex& comparison, const ex& d, const ex& a, const ex& b) {
  if (a.is_equal(b)) return a;
  if (!GiNaC::is_exactly_a<GiNaC::numeric>(d)) return choose(comparison, d, a, b).hold();
  const auto& number = GiNaC::ex_to<GiNaC::numeric>(d);
  const bool holds = comparison.is_equal(below_zero)     ? number.is_negative()
                     : comparison.is_equal(at_most_zero) ? !number.is_positive()
                                                         : number.is_zero();
  return holds ? a : b;
}

ex choose_derivative(const ex& comparison, const ex& d, const ex& a, const ex& b,
                     const GiNaC::symbol& variable) {
  return choose(comparison, d, a.diff(variable), b.diff(variable));
}

}  // namespace

REGISTER_FUNCTION(choose, eval_func(choose_eval).expl_derivative_func(choose_derivative))

ex choice(int comparison, const ex& d, const ex& a, const ex& b) {
  return choose(ex(comparison), d, a, b);
}

ex if_else(const ex& condition, const ex& a, const ex& b) {
  if (GiNaC::is_the_function<choose_SERIAL>(condition) && condition.op(2).is_equal(1) &&
      condition.op(3).is_zero())
    return choose(condition.op(0), condition.op(1), a, b);
  return choice(equal_to_zero, condition, b, a);
}

namespace {

/// Returns the smallest or the largest of all; the comparison decides which.
template <class TakesSecond>
ex extreme(const exvector& of, const TakesSecond& difference) {
  ex result = of.front();
  for (std::size_t k = 1; k < of.size(); ++k)
    result = choice(below_zero, difference(of[k], result), of[k], result);
  return result;
}

}  // namespace

const std::vector<FormulaFunction>& formula_functions() {
  constexpr std::size_t any = std::numeric_limits<std::size_t>::max();
  static const std::vector<FormulaFunction> all{
      {"abs", 1, 1, [](const exvector& a) { return choice(below_zero, a[0], -a[0], a[0]); }},
      {"acos", 1, 1, [](const exvector& a) -> ex { return GiNaC::acos(a[0]); }},
      {"acosh", 1, 1, [](const exvector& a) -> ex { return GiNaC::acosh(a[0]); }},
      {"asin", 1, 1, [](const exvector& a) -> ex { return GiNaC::asin(a[0]); }},
      {"asinh", 1, 1, [](const exvector& a) -> ex { return GiNaC::asinh(a[0]); }},
      {"atan", 1, 1, [](const exvector& a) -> ex { return GiNaC::atan(a[0]); }},
      {"atan2", 2, 2, [](const exvector& a) -> ex { return GiNaC::atan2(a[0], a[1]); }},
      {"atanh", 1, 1, [](const exvector& a) -> ex { return GiNaC::atanh(a[0]); }},
      {"cos", 1, 1, [](const exvector& a) -> ex { return GiNaC::cos(a[0]); }},
      {"cosh", 1, 1, [](const exvector& a) -> ex { return GiNaC::cosh(a[0]); }},
      {"exp", 1, 1, [](const exvector& a) -> ex { return GiNaC::exp(a[0]); }},
      {"if", 3, 3, [](const exvector& a) { return if_else(a[0], a[1], a[2]); }},
      {"ln", 1, 1, [](const exvector& a) -> ex { return GiNaC::log(a[0]); }},
      {"log", 1, 1, [](const exvector& a) -> ex { return GiNaC::log(a[0]); }},
      {"log10", 1, 1, [](const exvector& a) { return GiNaC::log(a[0]) / GiNaC::log(ex(10)); }},
      {"log2", 1, 1, [](const exvector& a) { return GiNaC::log(a[0]) / GiNaC::log(ex(2)); }},
      {"max", 1, any,
       [](const exvector& a) {
         return extreme(a, [](const ex& next, const ex& so_far) { return so_far - next; });
       }},
      {"min", 1, any,
       [](const exvector& a) {
         return extreme(a, [](const ex& next, const ex& so_far) { return next - so_far; });
       }},
      {"pow", 2, 2, [](const exvector& a) -> ex { return GiNaC::pow(a[0], a[1]); }},
      {"sin", 1, 1, [](const exvector& a) -> ex { return GiNaC::sin(a[0]); }},
      {"sinh", 1, 1, [](const exvector& a) -> ex { return GiNaC::sinh(a[0]); }},
      {"sqrt", 1, 1, [](const exvector& a) -> ex { return GiNaC::sqrt(a[0]); }},
      {"tan", 1, 1, [](const exvector& a) -> ex { return GiNaC::tan(a[0]); }},
      {"tanh", 1, 1, [](const exvector& a) -> ex { return GiNaC::tanh(a[0]); }}};
  return all;
}

}  // namespace smoothfem
