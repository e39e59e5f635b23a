// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>
#include <sstream>

#include "meshes/domains/catalogue.h"
#include "meshes/io/mesh_file.h"
#include "smoothing/base/find_named.h"
#include "smoothing/loop/method_scheme.h"
#include "smoothing/loop/plugin.h"
#include "studies/framework/definition/check_study.h"
#include "studies/framework/definition/find_study.h"
#include "studies/framework/definition/seeds.h"
#include "studies/framework/definition/study.h"
#include "studies/framework/definition/study_file.h"
#include "studies/framework/definition/study_keys.h"
#include "studies/framework/definition/study_solvers.h"

namespace smoothfem {

namespace {

using dealii::ParameterHandler;

std::vector<std::string> method_labels(const std::string& list, MeshDimensions dimensions) {
  if (list != "all") return split_list(list);
  std::vector<std::string> names;
  for (const auto& info : method_catalogue())
    if (with_dimensions(dimensions, [&]<int dim, int spacedim>() {
          return supports_mesh_kind<dim, spacedim>(info.name);
        }))
      names.push_back(info.name);
  return names;
}

/// Leaves only methods that work on meshes in parts.
void leave_methods_for_parts(Study& study) {
  with_dimensions(study.dimensions, [&]<int dim, int spacedim>() {
    std::erase_if(study.methods, [](const StudyMethod& method) {
      return !works_in_parts(method.make<dim, spacedim>());
    });
  });
}

/// Returns the numbers of "sequential: 10, ..."; deal.II has checked them.
std::map<std::string, int> stage_numbers(const std::string& text) {
  std::map<std::string, int> numbers;
  for (const auto& item : split_list(text)) {
    const auto colon = item.find(':');
    const auto stage = split_list(item.substr(0, colon));
    if (!stage.empty()) numbers[stage.front()] = std::stoi(item.substr(colon + 1));
  }
  return numbers;
}

StudyMesh read_mesh_section(ParameterHandler& p, const std::string& name,
                            const std::filesystem::path& folder) {
  const Subsection subsection(p, "mesh " + name);
  StudyMesh mesh{.name = name,
                 .title = p.get("title"),
                 .file = p.get("file"),
                 .domain = p.get("domain"),
                 .elements = p.get("elements"),
                 .algorithm = p.get("algorithm"),
                 .eps = p.get_double("eps"),
                 .order = static_cast<int>(std::stol(p.get("order"))),
                 .untangle = p.get_bool("untangle"),
                 .published_file = p.get("published file"),
                 .edge_scale = p.get_double("edge scale"),
                 .distort_to_q_mean = p.get_double("distort to"),
                 .distort_within = p.get_double("distort within"),
                 .distortion = p.get("distortion") == distortion_kind_names[1]
                                   ? DistortionKind::random_steps
                                   : DistortionKind::worst_candidate,
                 .distortion_candidates = static_cast<int>(p.get_integer("distortion candidates")),
                 .distortion_sweeps = static_cast<int>(p.get_integer("distortion sweeps")),
                 .distortion_least_quality = p.get_double("distortion least quality"),
                 .seed = static_cast<std::uint64_t>(p.get_integer("seed"))};
  if (!mesh.file.empty() && mesh.file.is_relative()) mesh.file = folder / mesh.file;
  if (mesh.distort_to_q_mean > 0.0 && mesh.distort_within > 0.0)
    throw InputError("the mesh " + name +
                     " has both 'distort to' and 'distort within'; choose one of them");
  return mesh;
}

/// Reads the rule for interfaces and the target of a method. Throws InputError if the method cannot
/// follow them.
template <int dim, int spacedim>
void read_mesh_rules(const ParameterHandler& p, const Method<dim, spacedim>& made,
                     StudyMethod& method) {
  method.interfaces = interface_rule(p.get("interfaces"));
  if (method.interfaces == InterfaceRule::slide && !keeps_constraints(made))
    throw InputError("method " + method.name +
                     " cannot slide on interfaces; fix or free them, or use one of " +
                     joined(methods_supporting<dim, spacedim>(true)));
  method.target = initial_target(p.get("target"));
  if (!method.target) return;
  if (spacedim > dim)
    throw InputError("method " + method.name +
                     " has a target, which is for planar and volume meshes; leave it out");
  if (!takes_targets(made))
    throw InputError("method " + method.name +
                     " knows regular cells only; set its 'target = regular', or use one of " +
                     joined(methods_with_targets<dim>()));
}

StudyMethod read_method_section(ParameterHandler& p, MeshDimensions dimensions,
                                const std::string& name, const std::string& type,
                                const std::filesystem::path& folder, bool is_stand_in) {
  const Subsection subsection(p, "method " + name);
  StudyMethod method{.name = name,
                     .type = type,
                     .title = p.get("title"),
                     .threads = static_cast<int>(p.get_integer("threads")),
                     .smooth_for = split_list(p.get("smooth for")),
                     .settings = {},
                     .folder = folder,
                     .is_stand_in = is_stand_in};
  with_dimensions(dimensions, [&]<int dim, int spacedim>() {
    auto defaults = method.make<dim, spacedim>();
    for (const auto& parameter : defaults.parameters())
      if (p.get(parameter.name) != value_text(parameter))
        method.settings.emplace_back(parameter.name, p.get(parameter.name));
    const auto made = method.make<dim, spacedim>();
    check_parameters(made);  // and throws for values out of range
    if (!is_stand_in) read_mesh_rules(p, made, method);
  });
  return method;
}

std::vector<int> read_degrees(const std::string& list, const std::string& file) {
  std::vector<int> degrees;
  for (const auto& item : split_list(list)) {
    if (item != "1" && item != "2")
      throw InputError(file + ": finite elements of degree '" + item +
                       "' are not available; choose 1 or 2");
    degrees.push_back(item == "1" ? 1 : 2);
  }
  return degrees;
}

/// Reads the solutions of the list; the first one is for the records.
void read_solutions(ParameterHandler& p, const StudyText& text,
                    const std::vector<std::string>& labels, Study& study) {
  {
    const Subsection subsection(p, "solution");
    for (const std::string key : {"name", "u", "diffusivity", "value", "gradient", "load"})
      if (!p.get(key).empty())
        throw InputError(
            "the study has both a list 'solutions' and, in the subsection 'solution', '" + key +
            "'; take one of them out");
  }
  if (!read_group_diffusivities(p, "solution").empty())
    throw InputError(
        "the study has a list 'solutions', but also a diffusivity of a group in the subsection "
        "'solution'; move it to the subsection of a solution");
  study.solution = read_solution(p, text, labels.front());
  for (std::size_t s = 1; s < labels.size(); ++s)
    study.further_solutions.push_back(read_solution(p, text, labels[s]));
}

/// Sets the solution's name if the study gives none: "expression" if it has formulas, otherwise
/// "gear".
void name_solution(ParameterHandler& p) {
  const Subsection subsection(p, "solution");
  if (p.get("name").empty())
    p.set("name",
          std::string(p.get("u").empty() && p.get("value").empty() ? "gear" : "expression"));
}

/// Reads groups from "group NAME, NAME, ..." or from the names alone.
std::vector<std::string> read_groups(const std::string& text) {
  auto groups = split_list(text);
  if (groups.empty()) return groups;
  auto& first = groups.front();
  if (first.starts_with("group ") || first.starts_with("group="))
    first.erase(0,
                std::min(first.find_first_not_of(" =", std::string("group").size()), first.size()));
  return groups;
}

std::vector<const Metric*> read_metrics(const std::string& list, const std::string& file) {
  if (list.empty()) return {};
  try {
    return metrics_named(list);
  } catch (const InputError& error) {
    throw InputError(file + ": " + error.what());
  }
}

void read_problem(ParameterHandler& p, const StudyText& text, Study& study) {
  const std::string file = text.file().string();
  study.degrees = read_degrees(p.get("degrees"), file);
  study.refined_degrees = read_degrees(p.get("refined degrees"), file);
  study.record_degrees = read_degrees(p.get("record degrees"), file);
  study.constrain_hanging_nodes = p.get("hanging nodes") == "constrain";
  study.constrain_periodic_nodes = p.get("periodic") == "constrain";
  study.only_results_of_seeds = p.get("record seeds") == "results";
  study.timing_runs = static_cast<int>(p.get_integer("timing runs"));
  study.record_warpage = p.get_bool("record warpage");
  for (const auto& item : split_list(p.get("count cells below")))
    study.count_below.push_back(std::stod(item));
  study.metrics = read_metrics(p.get("metrics"), file);
  study.write_series = p.get_bool("write series");
  study.in_parts = p.get_bool("in parts");
  study.refine = static_cast<int>(p.get_integer("refine"));
  auto of_groups = read_group_diffusivities(p, "solution");
  {
    const Subsection subsection(p, "solution");
    if (study.solution.label.empty())
      study.solution = {p.get("name"), p.get("value"), p.get("gradient"),
                        p.get("load"), p.get("u"),     p.get("diffusivity")};
    const KeyLines lines = lines_of_section(text, "solution");
    if (study.solution.label.empty()) {
      study.solution.of_groups = std::move(of_groups);
      study.solution.lines = lines;
    }
    study.finite_elements.natural_groups = read_groups(p.get("natural"));
    if (const auto natural = lines.find("natural"); natural != lines.end()) {
      study.natural_lines = {*natural};
      for (const auto& group : study.finite_elements.natural_groups)
        study.natural_lines[group] = natural->second;
    }
  }
  {
    const Subsection subsection(p, "finite elements");
    auto natural_groups = std::move(study.finite_elements.natural_groups);
    study.finite_elements = read_finite_elements(p);
    study.finite_elements.natural_groups = std::move(natural_groups);
  }
  {
    const Subsection subsection(p, "thresholds");
    study.thresholds = {p.get("reference"), p.get_double("margin")};
  }
  study.record_every = {static_cast<int>(p.get_integer("record every")),
                        stage_numbers(p.get("record stages every")), p.get_double("record growth")};
  study.edge_scale = p.get_double("edge scale");
}

/// Throws InputError for labels of solvers that columns cannot have, and for surface meshes.
void check_solvers(const std::vector<std::string>& labels, MeshDimensions dimensions,
                   const std::string& file) {
  if (labels.empty()) return;
  check_labels(labels, "solver", file);
  for (const auto& label : labels)
    if (label.find('.') != std::string::npos)
      throw InputError(file + ": the label of the solver '" + label +
                       "' has a '.', which separates it from the names of its numbers; take "
                       "another label");
  if (dimensions.space > dimensions.cells && labels != std::vector<std::string>{poisson_label})
    throw InputError(file +
                     ": solvers do not support surface meshes; leave the list 'solvers' out");
}

/// Labels of the meshes to take: all meshes of the list, or the meshes of the scale.
std::vector<std::string> meshes_taken(ParameterHandler& p, const std::vector<std::string>& known,
                                      const std::string& scale, const std::string& file) {
  const auto taken = split_list(p.get("meshes"));
  for (const auto& name : taken)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(file + ": the scale " + scale + " takes the mesh '" + name +
                       "', which is not in the list 'meshes'; " + choose_one_of(known, name));
  return taken;
}

/// Parameters without the study's kind and without newer keys that have their default. So results
/// resume that are older than kinds, surfaces, derived solutions, diffusivities, natural
/// conditions, several solutions, constraints, solvers, rules for interfaces, targets and parts.
StudyParameters said_parameters(ParameterHandler& p) {
  auto parameters = all_parameters(p);
  const auto is_key = [](const std::string& key, const std::string& path) {
    return path == key || path.ends_with("/" + key);
  };
  std::erase_if(parameters, [&](const auto& entry) {
    return entry.first == "kind" ||
           entry == std::pair<std::string, std::string>{"surface", "false"} ||
           entry == std::pair<std::string, std::string>{"hanging nodes", "refuse"} ||
           entry == std::pair<std::string, std::string>{"solvers", poisson_label} ||
           entry == std::pair<std::string, std::string>{"periodic", "prescribe"} ||
           entry == std::pair<std::string, std::string>{"in parts", "false"} ||
           (is_key("refine", entry.first) && entry.second == "0") ||
           (entry.first.starts_with("scale ") && entry.second.empty() &&
            (is_key("in parts", entry.first) || is_key("degrees", entry.first) ||
             is_key("condition number", entry.first))) ||
           (entry.first.ends_with("/interfaces") && entry.second == "fixed") ||
           (entry.first.ends_with("/target") && entry.second == "regular") ||
           (entry.second.empty() &&
            (entry.first == "solution/u" || entry.first == "solution/diffusivity" ||
             entry.first == "solution/natural" || entry.first == "solutions" ||
             entry.first.ends_with("/smooth for")));
  });
  return parameters;
}

/// Reads the header. Afterwards p has the scale's values.
StudyHeader read_header(ParameterHandler& p, const std::filesystem::path& file,
                        const std::string& scale) {
  StudyHeader header{.name = file.stem().string(),
                     .title = p.get("title"),
                     .note = p.get("note"),
                     .scale = scale,
                     .built_in = is_built_in(file),
                     .parameters = {},
                     .file_parameters = said_parameters(p)};
  check_label(header.name, "study", file.string());
  if (header.title.empty()) header.title = header.name;
  apply_scale(p, scale, file.string(), scaled_numbers, scaled_lists);
  header.parameters = said_parameters(p);
  return header;
}

/// Returns the dimensions of the first mesh that can be found. If there is none, it returns those
/// of planar meshes, and the run reports the error.
MeshDimensions dimensions_of_meshes(const StudyText& text, const std::vector<std::string>& meshes) {
  ParameterHandler p;
  for (const auto& mesh : meshes) declare_mesh(p, 2, mesh);
  parse_study(p, text, true);
  for (const auto& mesh : meshes) {
    const Subsection subsection(p, "mesh " + mesh);
    const std::filesystem::path file = p.get("file");
    if (!file.empty()) {
      const auto path = file.is_relative() ? text.file().parent_path() / file : file;
      if (!std::filesystem::is_regular_file(path)) continue;
      return std::visit(
          []<int dim, int spacedim>(const Mesh<dim, spacedim>&) {
            return MeshDimensions{dim, spacedim};
          },
          read_mesh(path).mesh);
    }
    for (const Domain& domain : domains())
      if (domain.name == p.get("domain"))
        return {domain.dimension, domain.is_surface ? 3 : domain.dimension};
  }
  return {};
}

MeshDimensions read_dimensions(ParameterHandler& p, const StudyText& text,
                               const std::vector<std::string>& meshes) {
  const std::string cells = p.get("dimension"), surface = p.get("surface");
  if (cells == "3" && surface == "true")
    throw InputError(text.file().string() +
                     ": surface meshes have 'dimension = 2', not 3; leave it out");
  if (surface == "true") return {2, 3};
  if (cells == "3") return {3, 3};
  if (cells == "2" && surface == "false") return {2, 2};
  const MeshDimensions found = dimensions_of_meshes(text, meshes);
  if (cells == "2") return {2, found.cells == 2 ? found.space : 2};
  return surface == "false" ? MeshDimensions{found.cells, found.cells} : found;
}

}  // namespace

template <int dim, int spacedim>
Method<dim, spacedim> StudyMethod::make() const {
  if (is_stand_in)
    return {.info = {.name = type, .title = title, .description = {}, .source = {}}, .stages = {}};
  auto method = make_method<dim, spacedim>(method_name_in(folder, type));
  for (const auto& [parameter, value] : settings) method.set(parameter, value);
  return method;
}
template Method<2> StudyMethod::make() const;
template Method<3> StudyMethod::make() const;
template Method<2, 3> StudyMethod::make() const;

ProblemUse StudyMethod::problem_use(MeshDimensions dimensions) const {
  return with_dimensions(
      dimensions, [&]<int dim, int spacedim>() { return make<dim, spacedim>().info.problem_use; });
}

bool StudyMethod::needs_problem(MeshDimensions dimensions) const {
  return problem_use(dimensions).any();
}

const StudySolver* solver_smoothed_for(const Study& study, const StudyMethod& method) {
  for (const auto& solver : study.solvers)
    for (const auto& label : method.smooth_for)
      if (solver.label == label) return &solver;
  return nullptr;
}

std::vector<StudySolve> solves_of(const Study& study) {
  std::vector<StudySolve> solves;
  for (const int degree : study.degrees) solves.push_back({nullptr, degree});
  for (const auto& solver : study.solvers) {
    if (solver.degrees.empty()) solves.push_back({&solver, 0});
    for (const int degree : solver.degrees) solves.push_back({&solver, degree});
  }
  return solves;
}

std::vector<int> row_degrees(const Study& study) {
  std::vector<int> degrees;
  for (const auto& solve : solves_of(study))
    if (solve.degree > 0 &&
        std::find(degrees.begin(), degrees.end(), solve.degree) == degrees.end())
      degrees.push_back(solve.degree);
  return degrees.empty() ? std::vector{0} : degrees;
}

std::vector<const StudySolution*> solutions_of(const Study& study) {
  std::vector<const StudySolution*> all{&study.solution};
  for (const auto& solution : study.further_solutions) all.push_back(&solution);
  return all;
}

Study read_study(const std::filesystem::path& file, const std::string& scale) {
  return study_of_text(StudyText(file), scale);
}

namespace {

int& n_looking() {
  static int n = 0;
  return n;
}

/// True if the method's code is in a file that the study names and that is not to be run.
bool is_not_run(const std::string& type, bool has_plugins) {
  if (!OnlyLook::is_on()) return false;
  if (method_in_file(type)) return true;
  const auto known = method_catalogue(true);
  return has_plugins && std::none_of(known.begin(), known.end(),
                                     [&](const MethodInfo& info) { return info.name == type; });
}

/// Declares the subsection of a method whose parameters are not known: with any keys that it has.
void declare_stand_in(ParameterHandler& p, const StudyText& text, const std::string& method) {
  const Subsection subsection(p, "method " + method);
  for (const std::string key : {"type", "title"})
    p.declare_entry(key, method, dealii::Patterns::Anything());
  p.declare_entry("threads", "0", dealii::Patterns::Integer(0));
  for (const std::string key : {"smooth for", "interfaces", "target"})
    p.declare_entry(key, "", dealii::Patterns::Anything());
  const std::set<std::string> declared{"type",       "title",      "threads",
                                       "smooth for", "interfaces", "target"};
  for (const auto& [section, key] : keys_of_sections(text))
    if (section == "method " + method && !declared.contains(key))
      p.declare_entry(key, "", dealii::Patterns::Anything());
}

}  // namespace

OnlyLook::OnlyLook() {
  ++n_looking();
}
OnlyLook::~OnlyLook() {
  --n_looking();
}
bool OnlyLook::is_on() {
  return n_looking() > 0;
}

Study study_of_text(const StudyText& text, const std::string& scale) {
  const std::filesystem::path& file = text.file();
  // The lists and the methods' types determine which subsections exist. So the lists are read
  // first, then the types, then everything, strictly.
  ParameterHandler lists;
  declare_lists(lists);
  parse_study(lists, text, true);
  const auto meshes = split_list(lists.get("meshes"));
  const MeshDimensions dimensions = read_dimensions(lists, text, meshes);
  const auto plugins = split_list(lists.get("plugins"));
  in_file(file, [&] {
    for (const std::filesystem::path plugin : plugins)
      if (!OnlyLook::is_on())
        load_plugin(plugin.is_relative() ? file.parent_path() / plugin : plugin);
  });
  const auto methods = method_labels(lists.get("methods"), dimensions);
  const auto solutions = split_list(lists.get("solutions"));
  const auto solvers = split_list(lists.get("solvers"));
  const auto scales = known_scales(lists, scale, file.string());
  check_labels(meshes, "mesh", file.string());
  check_labels(methods, "method", file.string());
  if (!solutions.empty()) check_labels(solutions, "solution", file.string());
  check_solvers(solvers, dimensions, file.string());

  ParameterHandler types;
  for (const auto& method : methods) declare_method(types, dimensions, method, "");
  parse_study(types, text, true);

  ParameterHandler p;
  std::map<std::string, std::string> type_of;
  declare_lists(p);
  declare_problem(p);
  for (const auto& name : scales) declare_scale(p, name);
  for (const auto& name : solutions) declare_solution(p, name, formula_of_solutions);
  for (const auto& mesh : meshes) declare_mesh(p, dimensions.cells, mesh);
  for (const auto& method : methods) {
    std::string type;
    {
      const Subsection subsection(types, "method " + method);
      type = types.get("type");
      if (type == method && !types.get("command").empty()) type = "command";
    }
    if (is_not_run(type, !plugins.empty()))
      declare_stand_in(p, text, method);
    else
      in_file(file, [&] {
        declare_method(p, dimensions, method, type, lists.get("preset"), file.parent_path());
      });
    type_of[method] = type;
  }
  declare_group_diffusivities(p, text);
  in_file(file, [&] { declare_solvers(p, text, solvers, dimensions.cells, !plugins.empty()); });
  parse_study(p, text, false);
  p.set("dimension", std::to_string(dimensions.cells));
  p.set("surface", dimensions.space > dimensions.cells);
  Study study;
  if (solutions.empty())
    name_solution(p);
  else
    in_file(file, [&] { read_solutions(p, text, solutions, study); });
  study.header = read_header(p, file, scale);
  study.folder = std::filesystem::absolute(file).parent_path();
  study.dimensions = dimensions;
  for (const auto& mesh : meshes_taken(p, meshes, scale, file.string()))
    study.meshes.push_back(
        in_file(file, [&] { return read_mesh_section(p, mesh, file.parent_path()); }));
  in_file(file, [&] { study.meshes = for_each_seed(study.meshes, read_seeds(p.get("seeds"))); });
  for (const auto& method : methods)
    study.methods.push_back(in_file(file, [&] {
      return read_method_section(p, dimensions, method, type_of[method], file.parent_path(),
                                 is_not_run(type_of[method], !plugins.empty()));
    }));
  read_problem(p, text, study);
  if (study.in_parts && lists.get("methods") == "all") leave_methods_for_parts(study);
  in_file(file,
          [&] { study.solvers = read_solvers(p, text, solvers, dimensions.cells, study.degrees); });
  if (std::find(solvers.begin(), solvers.end(), poisson_label) == solvers.end())
    study.degrees.clear();
  in_file(file, [&] { check_study(study); });
  return study;
}

}  // namespace smoothfem
