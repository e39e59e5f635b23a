// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "smoothing/loop/catalogue.h"

namespace smoothfem::test {

/// Makes a method of the catalogue. The name may end with " NAME=VALUE", a parameter to set in all
/// of its stages.
template <int dim, int spacedim = dim>
Method<dim, spacedim> make_variant(const std::string& name) {
  const auto space = name.find(' ');
  auto method = make_method<dim, spacedim>(name.substr(0, space));
  if (space == std::string::npos) return method;
  const auto equals = name.find('=');
  for (const auto& parameter : method.parameters())
    if (parameter.name.ends_with(name.substr(space + 1, equals - space - 1)))
      method.set(parameter.name, name.substr(equals + 1));
  return method;
}

/// Makes the method with so few iterations in each stage that differences in rounding cannot grow.
template <int dim, int spacedim = dim>
Method<dim, spacedim> short_method(const std::string& name, const std::string& n_iterations) {
  auto method = make_variant<dim, spacedim>(name);
  for (const auto& parameter : method.parameters())
    if (parameter.name.ends_with("max_iterations") || parameter.name.ends_with("max_cycles"))
      method.set(parameter.name, n_iterations);
  return method;
}

/// Returns the names of all methods, which also name their tests.
inline std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& info : method_catalogue()) names.push_back(info.name);
  return names;
}
/// Returns these names and those of variants that are tested like separate methods.
inline std::vector<std::string> variant_names() {
  auto names = method_names();
  for (const auto& name : method_names())
    if (name.starts_with("getme")) names.push_back(name + " scaling=neighbour-mean-size");
  return names;
}
inline std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

/// True if all stages of the method need a valid mesh and so promise that it stays valid.
template <int dim, int spacedim>
bool claims_validity(const Method<dim, spacedim>& method) {
  return std::all_of(method.stages.begin(), method.stages.end(),
                     [](const auto& stage) { return stage->traits().needs_valid_mesh; });
}

/// Returns the number of fixed nodes that differ from the mesh `before`; 0 if the method is
/// correct.
template <int dim, int spacedim>
std::size_t n_moved_fixed_nodes(const Mesh<dim, spacedim>& before,
                                const Mesh<dim, spacedim>& after) {
  std::size_t n_moved = 0;
  for (NodeIndex i = 0; i < before.n_nodes(); ++i)
    n_moved += before.topology().is_fixed(i) && before.coordinates()[i] != after.coordinates()[i];
  return n_moved;
}

}  // namespace smoothfem::test
