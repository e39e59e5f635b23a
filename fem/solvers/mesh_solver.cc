// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/solvers/mesh_solver.h"

#include <atomic>

#include "fem/solvers/python_solvers.h"
#include "smoothing/base/registry.h"
#include "smoothing/loop/plugin.h"
#include "smoothing/loop/python_interpreter.h"

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

std::atomic<SolverMakers (*)(const MethodInFile&)> python_maker{nullptr};

/// Returns the makers of a registered solver, or of one in a file.
SolverMakers makers_of(const std::string& type) {
  const auto in_file = method_in_file(type);
  if (!in_file) return registry().find(type).makers;
  require_python();
  return python_maker.load()(*in_file);
}

}  // namespace

void set_python_solvers(SolverMakers (*make)(const MethodInFile&)) {
  python_maker = make;
}

RegisteredSolver::RegisteredSolver(SolverInfo info, SolverMakers makers) {
  info.library = plugin_being_loaded();
  registry().add({info.name, std::move(info), std::move(makers)});
}

static const RegisteredPluginKind solvers_of_plugins({.registration = "RegisteredSolver",
                                                      .abi = solver_abi,
                                                      .n_registered = [] {
                                                        return registry().all().size();
                                                      }});

std::filesystem::path library_of_solver(const std::string& type) {
  return method_in_file(type) ? std::filesystem::path() : registry().find(type).info.library;
}

std::vector<SolverInfo> solver_catalogue() {
  std::vector<SolverInfo> all;
  for (const SolverEntry& entry : registry().all()) all.push_back(entry.info);
  return all;
}

template <int dim>
std::unique_ptr<MeshSolver<dim>> make_solver(const std::string& type) {
  const SolverMakers makers = makers_of(type);
  const auto& make = [&]() -> const auto& {
    if constexpr (dim == 2)
      return makers.planar;
    else
      return makers.volume;
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
