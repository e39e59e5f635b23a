// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fem/solvers/mesh_solver.h"

namespace smoothfem {

using Settings = std::map<std::string, std::string>;
using Keyed = std::vector<std::array<std::string, 3>>;  ///< parameter, name, value

/// Makes a solver with these parameters.
template <int dim>
std::unique_ptr<MeshSolver<dim>> configured_solver(const std::string& type,
                                                   const Settings& settings,
                                                   const Keyed& keyed = {}) {
  auto made = make_solver<dim>(type);
  for (const auto& [name, value] : settings)
    set_value(find_parameter(made->parameters(), name, type), value, type);
  for (const auto& [parameter, name, value] : keyed) made->set_keyed(parameter, name, value);
  made->check_parameters();
  return made;
}

}  // namespace smoothfem
