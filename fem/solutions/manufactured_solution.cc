// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/solutions/manufactured_solution.h"

#include <utility>

#include "smoothing/base/registry.h"

namespace smoothfem {

namespace {

template <int dim>
Registry<ManufacturedSolution<dim>>& registry() {
  static Registry<ManufacturedSolution<dim>> solutions(dim == 2 ? "planar solution"
                                                                : "volume solution");
  return solutions;
}

}  // namespace

template <int dim>
RegisteredSolution<dim>::RegisteredSolution(ManufacturedSolution<dim> solution) {
  registry<dim>().add(std::move(solution));
}

template <int dim>
const std::vector<ManufacturedSolution<dim>>& manufactured_solutions() {
  return registry<dim>().all();
}

template <int dim>
const ManufacturedSolution<dim>& manufactured_solution(const std::string& name) {
  return registry<dim>().find(name);
}

#define SMOOTHFEM_INSTANTIATE(dim)                                                 \
  template struct RegisteredSolution<dim>;                                         \
  template const std::vector<ManufacturedSolution<dim>>& manufactured_solutions(); \
  template const ManufacturedSolution<dim>& manufactured_solution(const std::string&);
SMOOTHFEM_INSTANTIATE(2)
SMOOTHFEM_INSTANTIATE(3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
