// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "meshes/io/mesh_file.h"
#include "meshes/metrics/metric.h"
#include "smoothing/base/find_named.h"
#include "smoothing/loop/method_scheme.h"
#include "smoothing/loop/preset.h"
#include "smoothing/transformations/catalogue.h"
#include "studies/cli/commands.h"
#include "studies/cli/list_columns.h"
#include "studies/cli/list_parts.h"

namespace smoothfem {

void list_parameter(const Parameter& parameter, const std::string& origin, const char* only_for) {
  const std::string range = range_text(parameter);
  std::printf("      %-40s %-8s %s%s%s%s\n", parameter.name.c_str(), value_text(parameter).c_str(),
              parameter.description.c_str(), range.empty() ? "" : ("; " + range).c_str(),
              origin.c_str(), only_for);
}

namespace {

struct ListArguments {
  std::string what;     ///< a part or a method; empty: everything
  std::string studies;  ///< folder; empty: the built-in studies
  std::string kind;     ///< of the study keys; empty: all
  std::string columns;  ///< CSV file; empty: all
};

/// Returns the origin of the default of a method's parameter, for its line; empty if not known.
template <int dim>
std::string origin_of(const Method<dim>& method, const std::string& parameter) {
  const auto dot = method.stages.size() > 1 ? parameter.find('.') : std::string::npos;
  const std::string stage = dot == std::string::npos ? std::string(method.stages.front()->name())
                                                     : parameter.substr(0, dot);
  const auto origin =
      default_origin(stage, dot == std::string::npos ? parameter : parameter.substr(dot + 1));
  return origin ? "; default: " + text_of(*origin) : "";
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
    list_parameter(parameter, origin_of(*planar, parameter.name),
                   volume && !has(of_volume, parameter.name) ? " [planar meshes]" : "");
  for (const auto& parameter : of_volume)
    if (!has(of_planar, parameter.name))
      list_parameter(parameter, origin_of(*volume, parameter.name),
                     planar ? " [volume meshes]" : "");
}

void list_method(const MethodInfo& info) {
  std::printf("  %s: %s\n      %s. Source: %s.\n      Meshes: %s.\n", info.name.c_str(),
              info.title.c_str(), info.description.c_str(), info.source.c_str(),
              joined(mesh_kinds(info.name)).c_str());
  list_parameters(info.name);
}

constexpr const char* methods_heading = "METHODS (smooth -m NAME, 'methods' in study files)\n";
constexpr const char* methods_in_files =
    "\nA smoother written in Python is a method, too: python:FILE:CLASS, as the tutorial shows.\n";

void list_methods() {
  std::printf("%s", methods_heading);
  for (const auto& info : method_catalogue(true)) {
    std::printf("\n");
    list_method(info);
  }
  std::printf("%s\n", methods_in_files);
}

/// Prints one line for each method.
void list_method_names() {
  std::printf("%s\n", methods_heading);
  for (const auto& info : method_catalogue(true))
    std::printf("  %-28s %s (%s)\n", info.name.c_str(), info.title.c_str(),
                joined(mesh_kinds(info.name)).c_str());
  std::printf("%s'smoothfem list METHOD' shows its parameters.\n", methods_in_files);
}

void list_transformations() {
  std::printf(
      "TRANSFORMATIONS (of elements, in GETMe; those for tetrahedra are values of the "
      "parameter tetrahedron_transformation)\n\n");
  for (const auto& info : transformation_catalogue)
    std::printf("  %-22s %s (%s). Source: %s.\n", info.name, info.description, info.elements,
                info.source);
}

void list_presets() {
  std::printf("PRESETS (smooth --preset NAME)\n\n");
  for (const auto& preset : presets())
    std::printf("  %-16s %s. Source: %s.\n", preset.name.c_str(), preset.description.c_str(),
                preset.source.c_str());
}

/// Prints the settings of a preset, each with its origin.
void list_preset(const Preset& preset) {
  std::printf("  %s: %s\n      Source: %s.\n", preset.name.c_str(), preset.description.c_str(),
              preset.source.c_str());
  for (const auto& setting : preset.settings)
    std::printf("      %-40s %-8s %s [%s meshes]\n",
                (setting.stage + "." + setting.parameter).c_str(), setting.value.c_str(),
                text_of(setting.origin).c_str(), setting.dim == 2 ? "planar" : "volume");
}

void list_metrics() {
  std::printf("METRICS (quality --metrics, 'metrics' in study files)\n\n");
  for (const auto& metric : metric_catalogue())
    std::printf("  %-16s %s; %s is better\n", metric.name.c_str(), metric.meaning.c_str(),
                metric.larger_is_better ? "larger" : "smaller");
}

void list_formats() {
  std::printf("FORMATS\n\n");
  for (const auto& format : mesh_formats())
    std::printf("  %-8s %s: %s\n", format.extension.c_str(), format.name.c_str(),
                format.description.c_str());
}

/// A part of the list. in_short: prints it where it is asked for alone.
struct Part {
  const char* name;
  std::function<void()> print, in_short;
};

/// Returns the printer of a part that only a module knows. what: see list_parts.h
std::function<void()> in_module(const char* module, const std::string& part,
                                const std::string& what = "") {
  return [=] {
    const auto name = "smoothfem_list_" + part;
    reinterpret_cast<void (*)(const std::string&)>(function_of_module(module, name))(what);
  };
}

std::vector<Part> parts(const std::string& studies) {
  const auto print_studies = in_module(study_module, "studies", studies);
  const auto print_domains = in_module(generate_module, "domains");
  const auto print_solutions = in_module(study_module, "solutions");
  const auto print_solvers = in_module(study_module, "solvers");
  return {{"methods", list_methods, list_method_names},
          {"presets", list_presets, list_presets},
          {"studies", print_studies, print_studies},
          {"domains", print_domains, print_domains},
          {"solutions", print_solutions, print_solutions},
          {"solvers", print_solvers, print_solvers},
          {"metrics", list_metrics, list_metrics},
          {"transformations", list_transformations, list_transformations},
          {"formats", list_formats, list_formats}};
}

void list_everything(const std::vector<Part>& all) {
  for (const Part& part : all) {
    if (&part != &all[0] && &part != &all[1]) std::printf("\n");
    part.print();
  }
}

/// Prints the part, the method or the preset of this name. Throws InputError if there is none.
void list_what(const std::string& what, const std::vector<Part>& all) {
  std::vector<std::string> names;
  for (const Part& part : all) {
    if (what == part.name) return part.in_short();
    names.emplace_back(part.name);
  }
  if (const auto in_file = method_in_file(what)) return list_method(make_entry(*in_file).info);
  const auto methods = method_catalogue(true);
  for (const auto& info : methods) {
    if (info.name == what) return list_method(info);
    names.push_back(info.name);
  }
  for (const auto& preset : presets()) {
    if (preset.name == what) return list_preset(preset);
    names.push_back(preset.name);
  }
  const std::string nearest = nearest_name(what, names);
  names.resize(all.size());
  throw InputError("there is no part, method or preset '" + what + "'; " +
                   (nearest.empty() ? "" : "did you mean '" + nearest + "'? ") +
                   choose_one_of(names) + ", or a method, or a preset");
}

}  // namespace

void add_list_command(CLI::App& app) {
  auto arguments = std::make_shared<ListArguments>();
  auto* command = add_subcommand(app, "list");
  command->add_option("what", arguments->what,
                      "a part: methods, presets, studies, domains, solutions, solvers, metrics, "
                      "transformations or formats; "
                      "or a method or a preset, with its parameters (default: everything)");
  command->add_option("--studies", arguments->studies,
                      "folder with study files (default: the built-in studies)");
  const auto* study_keys =
      command
          ->add_option("--study-keys", arguments->kind,
                       "the keys of study files, or of one kind of studies: smoothing, "
                       "collection, polygons or regularization")
          ->expected(0, 1)
          ->type_name("[KIND]");
  const auto* columns =
      command
          ->add_option("--columns", arguments->columns,
                       "the columns of the CSV files of results, or of one, such as summary.csv")
          ->expected(0, 1)
          ->type_name("[FILE]");
  add_plugin_option(*command, study_module);
  add_examples(*command,
               {"smoothfem list methods", "smoothfem list getme", "smoothfem list thesis-5.4",
                "smoothfem list --study-keys smoothing", "smoothfem list --columns summary.csv"});
  command->callback([arguments, columns, study_keys] {
    if (columns->count() > 0) {
      list_columns(arguments->columns);
      return;
    }
    if (study_keys->count() > 0) {
      in_module(study_module, "study_keys", arguments->kind)();
      return;
    }
    const auto all = parts(arguments->studies);
    arguments->what.empty() ? list_everything(all) : list_what(arguments->what, all);
  });
}

}  // namespace smoothfem
