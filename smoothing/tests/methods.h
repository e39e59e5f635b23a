#pragma once

#include <algorithm>
#include <string>

#include "smoothing/loop/catalogue.h"

namespace smoothfem::test {

/// The method with so few iterations a stage that differences in rounding cannot grow.
template <int dim>
Method<dim> short_method(const std::string& name, const std::string& n_iterations) {
  Method<dim> method = make_method<dim>(name);
  for (const auto& parameter : method.parameters())
    if (parameter.name.ends_with("max_iterations") || parameter.name.ends_with("max_cycles"))
      method.set(parameter.name, n_iterations);
  return method;
}

/// Methods whose stages all need a valid mesh promise that it stays valid.
template <int dim>
bool claims_validity(const Method<dim>& method) {
  return std::all_of(method.stages.begin(), method.stages.end(),
                     [](const auto& stage) { return stage->rule().needs_valid_mesh; });
}

/// How many fixed nodes are elsewhere than in the mesh `before`; 0 if nothing went wrong.
template <int dim>
std::size_t n_moved_fixed_nodes(const Mesh<dim>& before, const Mesh<dim>& after) {
  std::size_t n_moved = 0;
  for (NodeIndex i = 0; i < before.n_nodes(); ++i)
    n_moved += before.topology().is_fixed(i) && before.coordinates()[i] != after.coordinates()[i];
  return n_moved;
}

}  // namespace smoothfem::test
