// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/solutions/displacement.h"

#include "fem/formulas/formula_program.h"
#include "fem/solutions/diffusivity_formulas.h"

namespace smoothfem {

using GiNaC::ex;

namespace {

std::vector<ex> components_of(const std::string& key, const std::string& text, int dim) {
  const auto parts = split_outside_brackets(text, ';');
  if (parts.size() != static_cast<std::size_t>(dim))
    throw InputError(
        "'" + key + "', '" + text + "', needs " + std::to_string(dim) +
        " formulas, one for each component: " + (dim == 2 ? "'x*y ; x^2'" : "'x*y ; x^2 ; 0'"));
  std::vector<ex> components;
  for (const auto& part : parts) components.push_back(read_formula(key, part, dim));
  return components;
}

/// Makes the program of formulas; key and text are for messages.
std::shared_ptr<const FormulaProgram> program_of(const std::string& key, const std::string& text,
                                                 const std::vector<ex>& formulas) {
  try {
    return std::make_shared<const FormulaProgram>(formulas);
  } catch (const InputError& error) {
    throw InputError("'" + key + "', '" + text + "', cannot be read (" + error.what() + ")");
  }
}

/// u, its gradient, grad div u and laplace(u), each with all components.
std::vector<ex> derivatives_of(const std::vector<ex>& u) {
  const auto& x = formula_variables();
  std::vector<ex> all = u;
  for (const ex& component : u)
    for (std::size_t j = 0; j < u.size(); ++j) all.push_back(component.diff(x[j]));
  ex divergence = 0;
  for (std::size_t j = 0; j < u.size(); ++j) divergence += u[j].diff(x[j]);
  for (std::size_t i = 0; i < u.size(); ++i) all.push_back(divergence.diff(x[i]));
  for (const ex& component : u) {
    ex laplacian = 0;
    for (std::size_t j = 0; j < u.size(); ++j) laplacian += component.diff(x[j], 2);
    all.push_back(laplacian);
  }
  return all;
}

}  // namespace

template <int dim>
VectorFormula<dim>::VectorFormula(const std::string& key, const std::string& text)
    : program_(program_of(key, text, components_of(key, text, dim))) {}

template <int dim>
Eigen::Matrix<double, dim, 1> VectorFormula<dim>::at(const Point<dim>& p) const {
  Eigen::Matrix<double, dim, 1> values;
  program_->evaluate(p.data(), values.data());
  return values;
}

template <int dim>
Displacement<dim>::Displacement(const std::string& text)
    : program_(program_of("u", text, derivatives_of(components_of("u", text, dim)))) {}

template <int dim>
auto Displacement<dim>::at(const Point<dim>& p) const -> Derivatives {
  std::array<double, dim*(dim + 3)> values;
  program_->evaluate(p.data(), values.data());
  using Vector = Eigen::Map<const Eigen::Matrix<double, dim, 1>>;
  using Rows = Eigen::Map<const Eigen::Matrix<double, dim, dim, Eigen::RowMajor>>;
  const double* const second = &values[dim + dim * dim];
  return {Vector(values.data()), Rows(&values[dim]), Vector(second), Vector(second + dim)};
}

template class VectorFormula<2>;
template class VectorFormula<3>;
template class Displacement<2>;
template class Displacement<3>;

}  // namespace smoothfem
