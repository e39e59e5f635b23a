#include <deal.II/base/function_parser.h>

#include <cmath>
#include <memory>
#include <mutex>

#include "fem/manufactured_solution.h"

namespace smoothfem {

namespace {

/// One expression (or several, separated by semicolons) in x and y. The parser keeps state while it
/// evaluates, so one evaluation at a time.
class Expression {
 public:
  Expression(const std::string& text, unsigned int n_components)
      : parser_(std::make_shared<dealii::FunctionParser<2>>(n_components)),
        lock_(std::make_shared<std::mutex>()) {
    try {
      parser_->initialize("x,y", text, {{"pi", dealii::numbers::PI}});
      (void)component(Point<2>(0.5, 0.25), 0);  // deal.II parses at the first evaluation
    } catch (const std::exception&) {
      throw InputError("the solution's expression '" + text + "' cannot be read: it needs " +
                       std::to_string(n_components) +
                       " formula(s) in x and y, separated by ';', such as sin(pi*x)*y^2");
    }
  }

  double component(const Point<2>& p, unsigned int index) const {
    const std::lock_guard guard(*lock_);
    return parser_->value(dealii::Point<2>(p.x(), p.y()), index);
  }

 private:
  std::shared_ptr<dealii::FunctionParser<2>> parser_;
  std::shared_ptr<std::mutex> lock_;
};

/// Central differences of u against the given derivatives. Their error at this step is some 1e-6 of
/// the size of the third and fourth derivatives; a wrong sign or factor is off by far more.
void check_derivatives(const ManufacturedSolution& s, const std::vector<Point<2>>& sample) {
  constexpr double h = 1e-3, allowed = 1e-2;
  for (const auto& p : sample) {
    const Point<2> dx(h, 0.0), dy(0.0, h);
    const double u = s.value(p), right = s.value(p + dx), left = s.value(p - dx),
                 up = s.value(p + dy), down = s.value(p - dy);
    const Point<2> slope((right - left) / (2 * h), (up - down) / (2 * h));
    const double load = -(right + left + up + down - 4 * u) / (h * h);
    const double round_off = 1e-15 * std::abs(u) / (h * h);
    const std::string at = " at (" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ")";
    if (!((s.gradient(p) - slope).norm() <= allowed * (slope.norm() + 1.0)))
      throw InputError("the gradient given for the solution is not that of its value" + at +
                       ": correct 'gradient' or 'value'");
    if (!(std::abs(s.load(p) - load) <= allowed * (std::abs(load) + 1.0) + round_off))
      throw InputError("the load given for the solution is not -laplace(value)" + at +
                       ": there it should be near " + std::to_string(load));
  }
}

}  // namespace

ManufacturedSolution parsed_solution(const std::string& value, const std::string& gradient,
                                     const std::string& load, const std::vector<Point<2>>& sample) {
  const Expression u(value, 1), grad(gradient, 2), f(load, 1);
  ManufacturedSolution solution{.name = "expression",
                                .formula = value,
                                .source = "the study file",
                                .value = [u](const Point<2>& p) { return u.component(p, 0); },
                                .gradient =
                                    [grad](const Point<2>& p) {
                                      return Point<2>(grad.component(p, 0), grad.component(p, 1));
                                    },
                                .load = [f](const Point<2>& p) { return f.component(p, 0); }};
  check_derivatives(solution, sample);
  return solution;
}

}  // namespace smoothfem
