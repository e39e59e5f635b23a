// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "fem/solutions/manufactured_solution.h"
#include "meshes/domains/catalogue.h"
#include "meshes/io/mesh_file.h"
#include "meshes/metrics/metric.h"
#include "smoothing/loop/preset.h"
#include "studies/cli/commands.h"
#include "studies/cli/list_columns.h"
#include "studies/framework/definition/find_study.h"
#include "studies/kinds/study_kinds.h"

namespace smoothfem {

namespace {

struct ListArguments {
  std::filesystem::path studies;  ///< empty: the built-in studies
  bool study_keys = false;
  std::string columns;  ///< CSV file; empty: all
};

/// Prints a parameter with its range. only_for: the kind of meshes, if only one has the parameter.
void list_parameter(const Parameter& parameter, const char* only_for) {
  const std::string range = range_text(parameter);
  std::printf("      %-40s %-8s %s%s%s\n", parameter.name.c_str(), value_text(parameter).c_str(),
              parameter.description.c_str(), range.empty() ? "" : ("; " + range).c_str(), only_for);
}

template <int dim>
Parameters parameters_of(std::optional<Method<dim>>& made, const std::string& method) {
  if (!supports_mesh_kind<dim>(method)) return {};
  made.emplace(make_method<dim>(method));
  return made->parameters();
}

/// Prints the parameters for planar and for volume meshes, each once.
void list_parameters(const std::string& method) {
  std::optional<Method<2>> planar;
  std::optional<Method<3>> volume;
  const auto of_planar = parameters_of(planar, method), of_volume = parameters_of(volume, method);
  const auto has = [](const Parameters& all, const std::string& name) {
    return std::any_of(all.begin(), all.end(), [&](const auto& p) { return p.name == name; });
  };
  for (const auto& parameter : of_planar)
    list_parameter(parameter, volume && !has(of_volume, parameter.name) ? " [planar meshes]" : "");
  for (const auto& parameter : of_volume)
    if (!has(of_planar, parameter.name))
      list_parameter(parameter, planar ? " [volume meshes]" : "");
}

void list_methods() {
  std::printf("METHODS (smooth -m NAME, 'methods' in study files)\n");
  for (const auto& info : method_catalogue(true)) {
    std::printf("\n  %s: %s\n      %s. Source: %s.\n      Meshes: %s.\n", info.name.c_str(),
                info.title.c_str(), info.description.c_str(), info.source.c_str(),
                joined(mesh_kinds(info.name)).c_str());
    list_parameters(info.name);
  }
  std::printf(
      "\nA smoother written in Python is a method, too: python:FILE:CLASS, as the tutorial "
      "shows.\n");
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
  std::printf("\nMETRICS (quality --metrics, 'metrics' in study files)\n\n");
  for (const auto& metric : metric_catalogue())
    std::printf("  %-16s %s; %s is better\n", metric.name.c_str(), metric.meaning.c_str(),
                metric.larger_is_better ? "larger" : "smaller");
  std::printf("\nFORMATS\n\n");
  for (const auto& format : mesh_formats())
    std::printf("  %-8s %s: %s\n", format.extension.c_str(), format.name.c_str(),
                format.description.c_str());
}

}  // namespace

void smoothfem_add_list_command(CLI::App& app) {
  auto arguments = std::make_shared<ListArguments>();
  auto* command = add_subcommand(app, "list");
  command->add_option("--studies", arguments->studies,
                      "folder with study files (default: the built-in studies)");
  command->add_flag("--study-keys", arguments->study_keys, "the keys of a study file");
  const auto* columns =
      command
          ->add_option("--columns", arguments->columns,
                       "the columns of the CSV files of results, or of one, such as summary.csv")
          ->expected(0, 1)
          ->type_name("[FILE]");
  add_plugin_option(*command);
  add_examples(*command, {"smoothfem list", "smoothfem list --study-keys",
                          "smoothfem list --columns summary.csv"});
  command->callback([arguments, columns] {
    if (columns->count() > 0) {
      list_columns(arguments->columns);
      return;
    }
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
