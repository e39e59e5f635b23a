// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/solvers/mesh_solver.h"

#include "smoothing/base/registry.h"

namespace smoothfem {

namespace {

struct SolverEntry {
  std::string name;
  SolverInfo info;
  SolverMakers makers;
};

Registry<SolverEntry>& registry() {
  static Registry<SolverEntry> solvers("solver");
  return solvers;
}

}  // namespace

RegisteredSolver::RegisteredSolver(SolverInfo info, SolverMakers makers) {
  registry().add({info.name, std::move(info), std::move(makers)});
}

std::vector<SolverInfo> solver_catalogue() {
  std::vector<SolverInfo> all;
  for (const SolverEntry& entry : registry().all()) all.push_back(entry.info);
  return all;
}

template <int dim>
std::unique_ptr<MeshSolver<dim>> make_solver(const std::string& type) {
  const SolverEntry& entry = registry().find(type);
  const auto& make = [&]() -> const auto& {
    if constexpr (dim == 2)
      return entry.makers.planar;
    else
      return entry.makers.volume;
  }
  ();
  if (!make)
    throw InputError("the solver '" + type + "' does not support " +
                     (dim == 2 ? "planar" : "volume") + " meshes; leave it out");
  return make();
}

template std::unique_ptr<MeshSolver<2>> make_solver(const std::string&);
template std::unique_ptr<MeshSolver<3>> make_solver(const std::string&);

}  // namespace smoothfem
