// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/function_parser.h>

#include <iostream>
#include <memory>
#include <mutex>
#include <sstream>

#include "fem/solutions/check_solution.h"
#include "fem/solutions/diffusivity_formulas.h"
#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

namespace {

/// Captures the output of deal.II's parser on std::cerr: only there does it report what it could
/// not read.
class CapturedParserMessages {
 public:
  CapturedParserMessages() : before_(std::cerr.rdbuf(text_.rdbuf())) {}
  ~CapturedParserMessages() { std::cerr.rdbuf(before_); }
  CapturedParserMessages(const CapturedParserMessages&) = delete;
  CapturedParserMessages& operator=(const CapturedParserMessages&) = delete;

  /// Returns the unknown part and its position in this program's words; empty if the parser did not
  /// report them.
  std::string reason() const {
    const std::string token = entry("Token"), position = entry("Position");
    const bool is_number =
        !position.empty() && position.find_first_not_of("0123456789") == std::string::npos;
    if (entry("Message").starts_with("Unexpected end")) return "it ends too early";
    if (!is_number) return "";
    const std::string where = " at character " + std::to_string(std::stoul(position) + 1);
    return (token.empty() ? "the text" + where : "'" + token + "'" + where) + " is not understood";
  }

 private:
  /// Lines are "Key: <value>".
  std::string entry(const std::string& key) const {
    const std::string text = text_.str();
    const auto line = text.find(key + ":");
    const auto begin = text.find('<', line), end = text.find(">\n", begin);
    if (line == std::string::npos || end == std::string::npos) return "";
    return text.substr(begin + 1, end - begin - 1);
  }

  std::ostringstream text_;
  std::streambuf* before_;
};

/// One expression (or several, separated by semicolons) in x and y, in space also in z. The parser
/// keeps state while it evaluates, which allows one evaluation at a time.
template <int dim>
class Expression {
 public:
  /// key: of the study file, for messages.
  Expression(const std::string& key, const std::string& text, unsigned int n_components)
      : parser_(std::make_shared<dealii::FunctionParser<dim>>(n_components)),
        lock_(std::make_shared<std::mutex>()) {
    const std::string needed =
        (n_components == 1 ? "one formula" : std::to_string(n_components) + " formulas") +
        std::string(dim == 2 ? " in x and y" : " in x, y and z") +
        (n_components == 1 ? "" : ", separated by ';'") + ", such as " +
        (n_components == 1 ? "sin(pi*x)*y^2"
         : dim == 2        ? "pi*cos(pi*x)*y^2 ; 2*y*sin(pi*x)"
                           : "2*x ; 2*y ; 2*z");
    if (text.find_first_not_of(" \t") == std::string::npos)
      throw InputError("the solution's '" + key + "' is empty: it needs " + needed);
    const CapturedParserMessages messages;
    try {
      parser_->initialize(dim == 2 ? "x,y" : "x,y,z", text, {{"pi", dealii::numbers::PI}});
      (void)component(Point<dim>::Constant(0.25), 0);  // deal.II parses at the first evaluation
    } catch (const std::exception&) {
      const std::string reason = messages.reason();
      throw InputError("the solution's '" + key + "', '" + text + "', cannot be read" +
                       (reason.empty() ? "" : " (" + reason + ")") + ": it needs " + needed);
    }
  }

  double component(const Point<dim>& p, unsigned int index) const {
    dealii::Point<dim> point;
    for (int d = 0; d < dim; ++d) point[d] = p[d];
    const std::lock_guard guard(*lock_);
    return parser_->value(point, index);
  }

 private:
  std::shared_ptr<dealii::FunctionParser<dim>> parser_;
  std::shared_ptr<std::mutex> lock_;
};

}  // namespace

template <int dim>
ManufacturedSolution<dim> parsed_solution(const std::string& value, const std::string& gradient,
                                          const std::string& load,
                                          std::span<const Point<dim>> sample,
                                          const std::string& diffusivity) {
  const Expression<dim> u("value", value, 1), grad("gradient", gradient, dim), f("load", load, 1);
  ManufacturedSolution<dim> solution{
      .name = "expression",
      .formula = value,
      .source = "the study file",
      .value = [u](const Point<dim>& p) { return u.component(p, 0); },
      .value_and_gradient = [u, grad](const Point<dim>& p) -> ValueAndGradient<dim> {
        Point<dim> slope;
        for (int d = 0; d < dim; ++d) slope[d] = grad.component(p, static_cast<unsigned int>(d));
        return {u.component(p, 0), slope};
      },
      .load = [f](const Point<dim>& p) { return f.component(p, 0); }};
  if (!diffusivity.empty()) add_diffusivity(DiffusivityFormulas<dim>(diffusivity), solution);
  check_solution(solution, {"'value'", "'gradient'", "'load'"}, sample);
  return solution;
}

template ManufacturedSolution<2> parsed_solution(const std::string&, const std::string&,
                                                 const std::string&, std::span<const Point<2>>,
                                                 const std::string&);
template ManufacturedSolution<3> parsed_solution(const std::string&, const std::string&,
                                                 const std::string&, std::span<const Point<3>>,
                                                 const std::string&);

}  // namespace smoothfem
