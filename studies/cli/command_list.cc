// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "fem/manufactured_solution.h"
#include "meshes/domains/catalogue.h"
#include "meshes/io/mesh_file.h"
#include "smoothing/loop/preset.h"
#include "studies/cli/commands.h"
#include "studies/framework/definition/find_study.h"
#include "studies/kinds/study_kinds.h"

namespace smoothfem {

namespace {

struct Arguments {
  std::filesystem::path studies;  ///< empty: those that come with the program
  bool study_keys = false;
};

/// Parameters of a method for meshes of one dimension, without those in `known`.
template <int dim>
void list_parameters(const std::string& method, std::set<std::string>& known) {
  if (!takes_meshes<dim>(method)) return;
  Method<dim> made = make_method<dim>(method);
  for (const auto& parameter : made.parameters())
    if (known.insert(parameter.name).second)
      std::printf("      %-40s %-8s %s%s\n", parameter.name.c_str(), value_text(parameter).c_str(),
                  parameter.description.c_str(), dim == 3 ? " [volume meshes]" : "");
}

void list_methods() {
  std::printf("METHODS (smooth -m NAME, 'methods' in study files)\n");
  for (const auto& info : method_catalogue()) {
    std::printf("\n  %s: %s\n      %s. Source: %s.\n      Meshes: %s.\n", info.name.c_str(),
                info.title.c_str(), info.description.c_str(), info.source.c_str(),
                joined(mesh_kinds(info.name)).c_str());
    std::set<std::string> known;
    list_parameters<2>(info.name, known);
    list_parameters<3>(info.name, known);
  }
  std::printf("\nPRESETS (smooth --preset NAME)\n\n");
  for (const auto& preset : presets())
    std::printf("  %-16s %s. Source: %s.\n", preset.name.c_str(), preset.description.c_str(),
                preset.source.c_str());
}

void list_studies(const std::filesystem::path& folder) {
  std::printf("\nSTUDIES (study NAME, or FILE for your own)\n\n");
  for (const auto& file : study_files(folder))
    std::printf("  %-16s %s (%s)\n", file.stem().c_str(), read_any_study(file).header.title.c_str(),
                file.c_str());
}

void list_the_rest() {
  std::printf("\nDOMAINS (generate NAME, 'domain' in study files)\n\n");
  for (const auto& domain : domains())
    std::printf("  %-16s %s (%s)\n", domain.name.c_str(), domain.description.c_str(),
                joined(domain.elements).c_str());
  std::printf("\nSOLUTIONS ('solution' in study files)\n\n");
  for (const int dimension : {2, 3})
    with_dimension(dimension, [&]<int dim>() {
      for (const auto& solution : manufactured_solutions<dim>())
        std::printf("  %-16s %s u = %s (%s)\n", solution.name.c_str(),
                    dim == 2 ? "planar:" : "volume:", solution.formula.c_str(),
                    solution.source.c_str());
    });
  std::printf("\nFORMATS\n\n");
  for (const auto& format : mesh_formats())
    std::printf("  %-8s %s: %s\n", format.extension.c_str(), format.name.c_str(),
                format.description.c_str());
}

}  // namespace

void add_list_command(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  auto* command =
      app.add_subcommand("list", "methods with their parameters and sources, studies, formats");
  command->add_option("--studies", arguments->studies,
                      "folder with study files (those that come with the program unless given)");
  command->add_flag("--study-keys", arguments->study_keys, "the keys of a study file");
  command->callback([arguments] {
    if (arguments->study_keys) {
      for (const auto& kind : study_kinds())
        std::printf("# Keys of studies of the kind %s\n%s\n", kind.name.c_str(),
                    kind.keys().c_str());
      return;
    }
    list_methods();
    list_studies(arguments->studies.empty() ? built_in_studies() : arguments->studies);
    list_the_rest();
  });
}

}  // namespace smoothfem
