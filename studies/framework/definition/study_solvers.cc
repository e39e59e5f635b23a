// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/definition/study_solvers.h"

#include <algorithm>

#include "smoothing/base/find_named.h"
#include "smoothing/loop/method_scheme.h"
#include "studies/framework/definition/study_keys.h"

namespace smoothfem {

namespace {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

std::string section_of(const std::string& label) {
  return "solver " + label;
}

/// Calls visit(parameter, name, key) for the keys of a solver's section that belong to its keyed
/// parameters, for example "E group steel".
template <class Visit>
void for_each_keyed(const StudyText& text, const std::string& label,
                    const std::vector<std::string>& parameters, const Visit& visit) {
  for (const auto& [section, key] : keys_of_sections(text))
    for (const auto& parameter : parameters)
      if (section == section_of(label) && key.starts_with(parameter + " "))
        visit(parameter, key.substr(parameter.size() + 1), key);
}

/// Returns the types of the solvers. A solver with a command and no type is a command; others are
/// of the type of their label.
std::vector<std::string> types_of(const StudyText& text, const std::vector<std::string>& labels) {
  ParameterHandler types;
  for (const auto& label : labels) {
    const Subsection subsection(types, section_of(label));
    types.declare_entry("type", label, Patterns::Anything());
    types.declare_entry("command", "", Patterns::Anything());
  }
  parse_study(types, text, true);
  std::vector<std::string> found;
  for (const auto& label : labels) {
    const Subsection subsection(types, section_of(label));
    const std::string type = types.get("type");
    found.push_back(type == label && !types.get("command").empty() ? "command" : type);
  }
  return found;
}

/// True if the solver's code is in a file that is not to be run: in Python, or in a plugin.
bool is_not_run(const std::string& type, bool has_plugins) {
  if (!OnlyLook::is_on()) return false;
  if (method_in_file(type)) return true;
  const auto known = solver_catalogue();
  return has_plugins && std::none_of(known.begin(), known.end(),
                                     [&](const SolverInfo& info) { return info.name == type; });
}

/// Declares the subsection of a solver whose parameters are not known: with any keys that it has.
void declare_stand_in(ParameterHandler& p, const StudyText& text, const std::string& label) {
  const Subsection subsection(p, section_of(label));
  for (const auto& [section, key] : keys_of_sections(text))
    if (section == section_of(label)) p.declare_entry(key, "", Patterns::Anything());
}

template <int dim>
void declare_solver(ParameterHandler& p, const StudyText& text, const std::string& label,
                    const std::string& type, bool has_plugins) {
  if (is_not_run(type, has_plugins)) return declare_stand_in(p, text, label);
  const auto solver = make_solver<dim>(method_name_in(text.file().parent_path(), type));
  const Subsection subsection(p, section_of(label));
  p.declare_entry(
      "type", type, Patterns::Anything(),
      "Registered solver (see 'list'), or 'python:FILE:CLASS', the file relative to this "
      "one.");
  p.declare_entry("title", label, Patterns::Anything(), "Title in tables and figures.");
  p.declare_entry("degrees", "", Patterns::Anything(),
                  "Degrees of its finite elements; empty: those of the study.");
  declare_parameters(p, solver->parameters());
  for_each_keyed(text, label, solver->keyed_parameters(),
                 [&](const auto&, const auto&, const std::string& key) {
                   p.declare_entry(key, "", Patterns::Anything());
                 });
}

/// Returns the degrees of a solver. Throws InputError for a degree that it does not have.
std::vector<int> degrees_of(const std::string& given, const std::vector<int>& of_study,
                            const std::vector<int>& offered, const std::string& label) {
  if (offered.empty()) {
    if (!given.empty())
      throw InputError("the solver " + label + " has no degrees; leave its 'degrees' out");
    return {};
  }
  std::vector<std::string> names;
  for (const int degree : offered) names.push_back(std::to_string(degree));
  std::vector<int> degrees;
  for (const auto& item : split_list(given)) {
    const auto found = std::find(names.begin(), names.end(), item);
    if (found == names.end())
      throw InputError("the solver " + label + " has no finite elements of degree '" + item +
                       "'; " + choose_one_of(names, item));
    degrees.push_back(offered[static_cast<std::size_t>(found - names.begin())]);
  }
  if (!degrees.empty()) return degrees;
  for (const int degree : of_study)
    if (std::find(offered.begin(), offered.end(), degree) != offered.end())
      degrees.push_back(degree);
  if (degrees.empty())
    throw InputError("the solver " + label +
                     " has none of the study's degrees; write 'set degrees = " + names.front() +
                     "' in its subsection");
  return degrees;
}

template <int dim>
StudySolver read_solver(ParameterHandler& p, const StudyText& text, const std::string& label,
                        const std::vector<int>& degrees) {
  const bool has_plugins = !p.get("plugins").empty();
  const Subsection subsection(p, section_of(label));
  if (is_not_run(p.get("type"), has_plugins))
    return {.label = label, .type = p.get("type"), .title = label};
  StudySolver solver{.label = label,
                     .type = p.get("type"),
                     .title = p.get("title"),
                     .folder = std::filesystem::absolute(text.file()).parent_path()};
  auto defaults = make_solver<dim>(method_name_in(solver.folder, solver.type));
  for (const auto& parameter : defaults->parameters())
    if (p.get(parameter.name) != value_text(parameter))
      solver.settings.emplace_back(parameter.name, p.get(parameter.name));
  for_each_keyed(text, label, defaults->keyed_parameters(),
                 [&](const auto& parameter, const auto& name, const std::string& key) {
                   solver.keyed.push_back({parameter, name, p.get(key)});
                 });
  solver.traits = defaults->traits();
  solver.degrees = degrees_of(p.get("degrees"), degrees, solver.traits.degrees, label);
  at_line(lines_of_section(text, section_of(label)), [&] { (void)solver.make<dim>(); });
  return solver;
}

/// Returns the labels without Poisson's.
std::vector<std::string> others_of(std::vector<std::string> labels) {
  std::erase(labels, poisson_label);
  return labels;
}

}  // namespace

template <int dim>
std::unique_ptr<MeshSolver<dim>> StudySolver::make() const {
  auto solver = make_solver<dim>(method_name_in(folder, type));
  const std::string owner = "the solver " + label;
  const auto parameters = solver->parameters();
  for (const auto& [name, value] : settings)
    set_value(find_parameter(parameters, name, owner), value, owner);
  for (const auto& [parameter, name, value] : keyed) solver->set_keyed(parameter, name, value);
  solver->use_folders({folder, {}});
  solver->check_parameters();
  return solver;
}
template std::unique_ptr<MeshSolver<2>> StudySolver::make() const;
template std::unique_ptr<MeshSolver<3>> StudySolver::make() const;

void declare_solvers(ParameterHandler& p, const StudyText& text,
                     const std::vector<std::string>& labels, int dimension, bool has_plugins) {
  const auto others = others_of(labels);
  const auto types = types_of(text, others);
  for (std::size_t k = 0; k < others.size(); ++k)
    with_dimension(dimension, [&]<int dim>() {
      declare_solver<dim>(p, text, others[k], types[k], has_plugins);
    });
}

std::vector<StudySolver> read_solvers(ParameterHandler& p, const StudyText& text,
                                      const std::vector<std::string>& labels, int dimension,
                                      const std::vector<int>& degrees) {
  std::vector<StudySolver> solvers;
  for (const auto& label : others_of(labels))
    with_dimension(dimension, [&]<int dim>() {
      solvers.push_back(read_solver<dim>(p, text, label, degrees));
    });
  return solvers;
}

}  // namespace smoothfem
