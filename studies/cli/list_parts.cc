// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/cli/list_parts.h"

#include <cstdio>
#include <filesystem>
#include <vector>

#include "fem/solutions/manufactured_solution.h"
#include "smoothing/base/find_named.h"
#include "studies/framework/definition/find_study.h"
#include "studies/framework/definition/study.h"
#include "studies/kinds/study_kinds.h"

namespace smoothfem {

/// An empty name of the folder: the built-in studies.
void smoothfem_list_studies(const std::string& folder) {
  std::printf("STUDIES (study NAME, or FILE for your own)\n\n");
  const std::filesystem::path given(folder);
  for (const auto& file : study_files(given.empty() ? built_in_studies() : given))
    std::printf("  %-16s %s (%s)\n", file.stem().c_str(), read_summary(file).title.c_str(),
                file.c_str());
}

void smoothfem_list_solutions(const std::string&) {
  std::printf("SOLUTIONS ('solution' in study files)\n\n");
  for (const int dimension : {2, 3})
    with_dimension(dimension, [&]<int dim>() {
      for (const auto& solution : manufactured_solutions<dim>())
        std::printf("  %-16s %s u = %s (%s)\n", solution.name.c_str(),
                    dim == 2 ? "planar:" : "volume:", solution.formula.c_str(),
                    solution.source.c_str());
    });
}

/// Prints the solvers with their parameters and numbers in the plane; in space they are alike.
void smoothfem_list_solvers(const std::string&) {
  std::printf(
      "SOLVERS ('solvers' in study files)\n\n  %s: the program's own, for the problem of the "
      "study file: -div(A grad u) = f\n",
      poisson_label);
  for (const auto& info : solver_catalogue()) {
    const auto solver = make_solver<2>(info.name);
    std::printf("\n  %s: %s\n      %s. Source: %s.\n", info.name.c_str(), info.title.c_str(),
                info.description.c_str(), info.source.c_str());
    for (const auto& parameter : solver->parameters()) list_parameter(parameter, "", "");
    for (const auto& key : solver->keyed_parameters())
      std::printf("      %-40s one value for each name: set %s NAME = VALUE\n", key.c_str(),
                  key.c_str());
    for (const auto& number : solver->numbers())
      std::printf("      records %-32s %s%s\n", number.name.c_str(), number.description.c_str(),
                  number.unit.empty() ? "" : (" [" + number.unit + "]").c_str());
  }
}

/// Prints the keys of a kind of studies; of all kinds, the default one first, for an empty name.
void smoothfem_list_study_keys(const std::string& wanted) {
  std::vector<std::string> names{default_study_kind};
  for (const auto& kind : study_kinds())
    if (kind.name != default_study_kind) names.push_back(kind.name);
  if (!wanted.empty()) names = {find_named("study kind", wanted, names)};
  for (const auto& name : names)
    for (const auto& kind : study_kinds())
      if (kind.name == name)
        std::printf("# Keys of studies of the kind %s\n%s\n", name.c_str(), kind.keys().c_str());
}

}  // namespace smoothfem
