// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>

#include "fem/formulas/formula_functions.h"
#include "fem/formulas/formula_program.h"
#include "fem/solutions/check_solution.h"
#include "fem/solutions/diffusivity_formulas.h"

namespace smoothfem {

using GiNaC::ex;

namespace {

template <class Work>
auto on_formula(const std::string& key, const std::string& text, const std::string& needed,
                const Work& work) {
  std::string reason;
  try {
    return work();
  } catch (const InputError& error) {
    reason = error.what();
  } catch (const std::exception&) {  // exceptions of GiNaC
    reason = "it cannot be derived";
  }
  throw InputError("the solution's '" + key + "', '" + text + "', cannot be read (" + reason +
                   "): it needs " + needed);
}

std::string one_formula(int dim) {
  return std::string("a formula in ") + (dim == 2 ? "x and y" : "x, y and z") +
         ", such as sin(pi*x)*y^2 or if(x < 0.5, x, y)";
}

/// The values of formulas at a point; copies share the program.
template <int dim, std::size_t n>
class Values {
 public:
  explicit Values(const std::vector<ex>& formulas)
      : program_(std::make_shared<const FormulaProgram>(formulas)) {}
  std::array<double, n> at(const Point<dim>& p) const {
    std::array<double, n> values;
    program_->evaluate(p.data(), values.data());
    return values;
  }
  /// Calls write(k, values) for each point.
  template <class Write>
  void at_all(std::span<const Point<dim>> points, const Write& write) const {
    static_assert(sizeof(Point<dim>) == dim * sizeof(double));
    std::array<double, n * n_points_at_once> values;
    for (std::size_t first = 0; first < points.size(); first += n_points_at_once) {
      const auto some = points.subspan(first, std::min(n_points_at_once, points.size() - first));
      program_->evaluate(some.size(), dim, some.front().data(), values.data());
      for (std::size_t k = 0; k < some.size(); ++k) write(first + k, &values[k * n]);
    }
  }

 private:
  std::shared_ptr<const FormulaProgram> program_;
};

template <int dim>
void add_conditions(const std::vector<ex>& formulas, ManufacturedSolution<dim>& solution) {
  std::vector<ex> conditions;
  for (const auto& formula : formulas) find_conditions(formula, conditions);
  if (conditions.empty()) return;
  solution.conditions = [n = conditions.size(), program = std::make_shared<const FormulaProgram>(
                                                    conditions)](const Point<dim>& p) {
    std::vector<double> values(n);
    program->evaluate(p.data(), values.data());
    return values;
  };
}

template <int dim>
std::vector<ex> all_entries(const DiffusivityFormulas<dim>& formulas) {
  std::vector<ex> entries;
  for (const auto& row : formulas.entries) entries.insert(entries.end(), row.begin(), row.end());
  return entries;
}

}  // namespace

std::vector<std::string> split_outside_brackets(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (const char c : text) {
    depth += (c == '(') - (c == ')');
    if (c == separator && depth == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

void find_conditions(const ex& e, std::vector<ex>& conditions) {
  if (GiNaC::is_the_function<choose_SERIAL>(e) &&
      std::none_of(conditions.begin(), conditions.end(),
                   [&](const ex& known) { return known.is_equal(e.op(1)); }))
    conditions.push_back(e.op(1));
  for (std::size_t k = 0; k < e.nops(); ++k) find_conditions(e.op(k), conditions);
}

ex read_formula(const std::string& key, const std::string& text, int dim) {
  if (text.find_first_not_of(" \t") == std::string::npos)
    throw InputError("the solution's '" + key + "' is empty: it needs " + one_formula(dim));
  return on_formula(key, text, one_formula(dim), [&] { return parse_formula(text, dim); });
}

template <int dim>
DiffusivityFormulas<dim>::DiffusivityFormulas() {
  for (std::size_t i = 0; i < dim; ++i)
    for (std::size_t j = 0; j < dim; ++j) entries[i][j] = i == j ? 1 : 0;
}

template <int dim>
DiffusivityFormulas<dim>::DiffusivityFormulas(const std::string& given) : DiffusivityFormulas() {
  text = given;
  const auto rows = split_outside_brackets(text, ';');
  const bool one = rows.size() == 1 && split_outside_brackets(text, ',').size() == 1;
  if (one) {
    const ex a = read_formula("diffusivity", text, dim);
    for (std::size_t i = 0; i < dim; ++i) entries[i][i] = a;
    return;
  }
  bool is_square = rows.size() == dim;
  for (std::size_t i = 0; is_square && i < dim; ++i) {
    const auto row = split_outside_brackets(rows[i], ',');
    is_square = row.size() == dim;
    for (std::size_t j = 0; is_square && j < dim; ++j)
      entries[i][j] = read_formula("diffusivity", row[j], dim);
  }
  if (!is_square)
    throw InputError(
        "the solution's 'diffusivity', '" + text + "', is neither one formula nor " +
        std::to_string(dim) + " rows of " + std::to_string(dim) + " formulas: write it as " +
        (dim == 2 ? "'a11, a12 ; a21, a22'" : "'a11, a12, a13 ; a21, a22, a23 ; a31, a32, a33'"));
}

template <int dim>
void add_diffusivity(const DiffusivityFormulas<dim>& formulas,
                     ManufacturedSolution<dim>& solution) {
  constexpr std::size_t n_entries = dim * dim;
  const auto entries = all_entries(formulas);
  const auto values = on_formula("diffusivity", formulas.text, one_formula(dim),
                                 [&] { return Values<dim, n_entries>(entries); });
  solution.diffusivity = [values](const Point<dim>& p) -> Diffusivity<dim> {
    const auto a = values.at(p);
    return Eigen::Map<const Eigen::Matrix<double, dim, dim, Eigen::RowMajor>>(a.data());
  };
  std::vector<ex> derivatives;
  for (std::size_t k = 0; k < dim; ++k)
    for (const ex& entry : entries) derivatives.push_back(entry.diff(formula_variables()[k]));
  const auto slopes = on_formula("diffusivity", formulas.text, one_formula(dim),
                                 [&] { return Values<dim, n_entries * dim>(derivatives); });
  solution.diffusivity_derivatives = [slopes](const Point<dim>& p) {
    const auto values = slopes.at(p);
    std::array<Diffusivity<dim>, dim> all;
    for (std::size_t k = 0; k < dim; ++k)
      all[k] = Eigen::Map<const Eigen::Matrix<double, dim, dim, Eigen::RowMajor>>(
          &values[k * n_entries]);
    return all;
  };
  if (!solution.conditions) add_conditions(entries, solution);
}

namespace {

/// Returns -div(A grad u). value_and_gradient: u and its derivatives.
template <int dim>
ex load_of(const std::vector<ex>& value_and_gradient, const DiffusivityFormulas<dim>& a) {
  const auto& x = formula_variables();
  ex load = 0;
  for (std::size_t i = 0; i < dim; ++i) {
    ex flux = 0;
    for (std::size_t j = 0; j < dim; ++j) flux += a.entries[i][j] * value_and_gradient[1 + j];
    load -= flux.diff(x[i]);
  }
  return load;
}

template <int dim>
PointFunction<dim, double> function_of(const ex& formula) {
  const Values<dim, 1> values({formula});
  return {[values](const Point<dim>& p) { return values.at(p)[0]; },
          [values](std::span<const Point<dim>> points, std::span<double> all) {
            values.at_all(points, [&](std::size_t k, const double* at) { all[k] = *at; });
          }};
}

/// formulas: u and its derivatives.
template <int dim>
PointFunction<dim, ValueAndGradient<dim>> value_and_gradient_of(const std::vector<ex>& formulas) {
  using Both = ValueAndGradient<dim>;
  const Values<dim, 1 + dim> values(formulas);
  return {[values](const Point<dim>& p) -> Both {
            const auto all = values.at(p);
            return {all[0], Eigen::Map<const Point<dim>>(all.data() + 1)};
          },
          [values](std::span<const Point<dim>> points, std::span<Both> all) {
            values.at_all(points, [&](std::size_t k, const double* at) {
              all[k] = {at[0], Eigen::Map<const Point<dim>>(at + 1)};
            });
          }};
}

/// Returns A if it is a number times the identity.
template <int dim>
std::optional<double> constant_of(const DiffusivityFormulas<dim>& a) {
  if (!GiNaC::is_a<GiNaC::numeric>(a.entries[0][0].evalf())) return std::nullopt;
  for (std::size_t i = 0; i < dim; ++i)
    for (std::size_t j = 0; j < dim; ++j)
      if (!a.entries[i][j].is_equal(i == j ? a.entries[0][0] : ex(0))) return std::nullopt;
  return GiNaC::ex_to<GiNaC::numeric>(a.entries[0][0].evalf()).to_double();
}

/// Makes a material of a group. An empty formula means the identity.
template <int dim>
Material<dim> material_of(const GroupDiffusivity& given, const std::vector<ex>& value_and_gradient,
                          std::vector<ex>& formulas) {
  const auto a =
      given.formula.empty() ? DiffusivityFormulas<dim>() : DiffusivityFormulas<dim>(given.formula);
  const auto entries = all_entries(a);
  formulas.insert(formulas.end(), entries.begin(), entries.end());
  ManufacturedSolution<dim> only_a;
  add_diffusivity(a, only_a);
  return {.group = given.group,
          .diffusivity = only_a.diffusivity,
          .constant = constant_of(a),
          .load = on_formula("diffusivity", given.formula, one_formula(dim),
                             [&] { return function_of<dim>(load_of(value_and_gradient, a)); })};
}

}  // namespace

template <int dim>
ManufacturedSolution<dim> derived_solution(const std::string& u, const std::string& diffusivity,
                                           std::span<const Point<dim>> sample,
                                           const std::vector<GroupDiffusivity>& of_groups) {
  const ex value = read_formula("u", u, dim);
  const auto a =
      diffusivity.empty() ? DiffusivityFormulas<dim>() : DiffusivityFormulas<dim>(diffusivity);
  ManufacturedSolution<dim> solution{.name = "expression",
                                     .formula = u,
                                     .source = "the study file",
                                     .value = {},
                                     .value_and_gradient = {},
                                     .load = {}};
  std::vector<ex> value_and_gradient{value};
  on_formula("u", u, one_formula(dim), [&] {
    const auto& x = formula_variables();
    for (std::size_t j = 0; j < dim; ++j) value_and_gradient.push_back(value.diff(x[j]));
    solution.value = function_of<dim>(value);
    solution.load = function_of<dim>(load_of(value_and_gradient, a));
    solution.value_and_gradient = value_and_gradient_of<dim>(value_and_gradient);
  });
  std::vector<ex> formulas = all_entries(a);
  formulas.push_back(value);
  for (const GroupDiffusivity& given : of_groups)
    solution.materials.push_back(material_of<dim>(given, value_and_gradient, formulas));
  if (!of_groups.empty())
    solution.materials.push_back(
        material_of<dim>({.group = {}, .formula = diffusivity}, value_and_gradient, formulas));
  add_conditions(formulas, solution);
  if (!of_groups.empty()) return solution;
  if (!diffusivity.empty()) add_diffusivity(a, solution);
  check_solution(solution, {"'u'", "gradient, derived from 'u',", "load, derived from 'u',", true},
                 sample);
  return solution;
}

#define SMOOTHFEM_INSTANTIATE(dim)                                                            \
  template struct DiffusivityFormulas<dim>;                                                   \
  template void add_diffusivity(const DiffusivityFormulas<dim>&, ManufacturedSolution<dim>&); \
  template ManufacturedSolution<dim> derived_solution(const std::string&, const std::string&, \
                                                      std::span<const Point<dim>>,            \
                                                      const std::vector<GroupDiffusivity>&);
SMOOTHFEM_INSTANTIATE(2)
SMOOTHFEM_INSTANTIATE(3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
