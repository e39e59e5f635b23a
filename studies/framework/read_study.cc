// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "meshes/domains/catalogue.h"
#include "smoothing/base/input_error.h"
#include "studies/framework/study.h"
#include "studies/framework/study_file.h"
#include "studies/framework/study_keys.h"

namespace smoothfem {

namespace {

using dealii::ParameterHandler;

std::vector<std::string> method_labels(const std::string& list, MeshDimensions dimensions) {
  if (list != "all") return split_list(list);
  std::vector<std::string> names;
  for (const auto& info : method_catalogue())
    if (with_dimensions(dimensions, [&]<int dim, int spacedim>() {
          return takes_meshes<dim, spacedim>(info.name);
        }))
      names.push_back(info.name);
  return names;
}

Recorded recorded(const std::string& text) {
  return text == "never"     ? Recorded::never
         : text == "results" ? Recorded::results
                             : Recorded::always;
}

ConditionNumberMethod condition_number_method(const std::string& text) {
  return text == "none"      ? ConditionNumberMethod::none
         : text == "lanczos" ? ConditionNumberMethod::lanczos
                             : ConditionNumberMethod::verified;
}

/// "sequential: 10, ..."; deal.II has checked the numbers.
std::map<std::string, int> stage_numbers(const std::string& text) {
  std::map<std::string, int> numbers;
  for (const auto& item : split_list(text)) {
    const auto colon = item.find(':');
    const auto stage = split_list(item.substr(0, colon));
    if (!stage.empty()) numbers[stage.front()] = std::stoi(item.substr(colon + 1));
  }
  return numbers;
}

void check_unique(std::vector<std::string> labels, const std::string& what,
                  const std::string& file) {
  if (labels.empty()) throw InputError(file + ": the study names no " + what);
  for (const auto& label : labels) check_label(label, what, file);
  std::sort(labels.begin(), labels.end());
  const auto twice = std::adjacent_find(labels.begin(), labels.end());
  if (twice != labels.end())
    throw InputError(file + ": the " + what + " '" + *twice + "' is named twice");
}

StudyMesh read_mesh_section(ParameterHandler& p, const std::string& name,
                            const std::filesystem::path& folder) {
  const Subsection subsection(p, "mesh " + name);
  StudyMesh mesh{.name = name,
                 .title = p.get("title"),
                 .file = p.get("file"),
                 .domain = p.get("domain"),
                 .elements = p.get("elements"),
                 .published_file = p.get("published file"),
                 .edge_scale = p.get_double("edge scale"),
                 .distort_to_q_mean = p.get_double("distort to"),
                 .distort_within = p.get_double("distort within"),
                 .distortion_candidates = static_cast<int>(p.get_integer("distortion candidates")),
                 .distortion_sweeps = static_cast<int>(p.get_integer("distortion sweeps")),
                 .seed = static_cast<std::uint64_t>(p.get_integer("seed"))};
  if (!mesh.file.empty() && mesh.file.is_relative()) mesh.file = folder / mesh.file;
  if (mesh.distort_to_q_mean > 0.0 && mesh.distort_within > 0.0)
    throw InputError("the mesh " + name +
                     " has both 'distort to' and 'distort within'; choose one of them");
  return mesh;
}

StudyMethod read_method_section(ParameterHandler& p, MeshDimensions dimensions,
                                const std::string& name) {
  const Subsection subsection(p, "method " + name);
  StudyMethod method{.name = name,
                     .type = p.get("type"),
                     .title = p.get("title"),
                     .threads = static_cast<int>(p.get_integer("threads")),
                     .settings = {}};
  with_dimensions(dimensions, [&]<int dim, int spacedim>() {
    auto defaults = make_method<dim, spacedim>(method.type);
    for (const auto& parameter : defaults.parameters())
      if (p.get(parameter.name) != value_text(parameter))
        method.settings.emplace_back(parameter.name, p.get(parameter.name));
    (void)method.make<dim, spacedim>();  // throws for values out of range
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

void read_problem(ParameterHandler& p, const std::string& file, Study& study) {
  study.degrees = read_degrees(p.get("degrees"), file);
  study.timing_runs = static_cast<int>(p.get_integer("timing runs"));
  study.record_warpage = p.get_bool("record warpage");
  study.write_series = p.get_bool("write series");
  {
    const Subsection subsection(p, "solution");
    study.solution = {p.get("name"), p.get("value"), p.get("gradient"), p.get("load")};
  }
  {
    const Subsection subsection(p, "finite elements");
    study.finite_elements.galerkin_load = p.get("load") == "quadrature";
    study.finite_elements.tensor_points = {static_cast<int>(p.get_integer("quadrilateral points")),
                                           static_cast<int>(p.get_integer("hexahedron points"))};
    study.finite_elements.cg_tolerance = p.get_double("cg tolerance");
    study.finite_elements.boundary_in_norm = p.get_bool("boundary in norm");
    if (p.get_double("cg seconds") > 0.0)
      study.finite_elements.max_cg_seconds = p.get_double("cg seconds");
    study.finite_elements.condition_number = condition_number_method(p.get("condition number"));
    study.finite_elements.jacobi_cg = recorded(p.get("jacobi cg"));
    study.finite_elements.multigrid_cg = recorded(p.get("multigrid cg"));
  }
  {
    const Subsection subsection(p, "thresholds");
    study.thresholds = {p.get("reference"), p.get_double("margin")};
  }
  study.record_every = {static_cast<int>(p.get_integer("record every")),
                        stage_numbers(p.get("record stages every"))};
  study.edge_scale = p.get_double("edge scale");
}

/// What the study's scale changes.
void read_scale(ParameterHandler& p, const std::string& file, Study& study) {
  const Subsection subsection(p, "scale " + study.scale);
  if (const long every = p.get_integer("record every"); every > 0)
    study.record_every.usually = static_cast<int>(every);
  if (!p.get("record stages every").empty())
    study.record_every.stages = stage_numbers(p.get("record stages every"));
  if (const double edge_scale = p.get_double("edge scale"); edge_scale > 0.0) {
    if (edge_scale < 1.0)
      throw InputError(file + ": the scale " + study.scale + " has the edge scale " +
                       p.get("edge scale") + ", but edges cannot get shorter than 1");
    study.edge_scale = edge_scale;
  }
  if (const long runs = p.get_integer("timing runs"); runs > 0)
    study.timing_runs = static_cast<int>(runs);
  if (const auto names = split_list(p.get("meshes")); !names.empty()) {
    std::vector<StudyMesh> taken;
    for (const auto& name : names) {
      const auto mesh = std::find_if(study.meshes.begin(), study.meshes.end(),
                                     [&](const StudyMesh& known) { return known.name == name; });
      if (mesh == study.meshes.end())
        throw InputError(file + ": the scale " + study.scale + " takes the mesh '" + name +
                         "', which is not in the list 'meshes'");
      taken.push_back(*mesh);
    }
    study.meshes = std::move(taken);
  }
}

MeshDimensions read_dimensions(ParameterHandler& p) {
  const int cells = static_cast<int>(p.get_integer("dimension"));
  if (!p.get_bool("surface")) return {cells, cells};
  if (cells != 2) throw InputError("surface meshes have 'dimension = 2', not 3; leave it out");
  return {cells, 3};
}

/// Whether what the study names is there; better now than after the first mesh is generated.
void check_names(const Study& study) {
  if (!study.degrees.empty() && study.dimensions.space > study.dimensions.cells)
    throw InputError(
        "finite elements are not solved on surface meshes; write 'set degrees =' without any");
  if (!study.degrees.empty() && study.solution.name != "expression")
    with_dimension(study.dimensions.cells,
                   [&]<int dim>() { (void)manufactured_solution<dim>(study.solution.name); });
  for (const auto& mesh : study.meshes)
    if (!mesh.domain.empty()) (void)find_domain(mesh.domain).elements_named(mesh.elements);
}

/// Stages that are recorded in their own way belong to one of the methods.
void check_stages(const Study& study) {
  std::vector<std::string> known;
  with_dimensions(study.dimensions, [&]<int dim, int spacedim>() {
    for (const auto& method : study.methods)
      for (const auto& stage : method.make<dim, spacedim>().stages)
        if (std::find(known.begin(), known.end(), stage->name()) == known.end())
          known.emplace_back(stage->name());
  });
  for (const auto& [stage, every] : study.record_every.stages)
    if (std::find(known.begin(), known.end(), stage) == known.end())
      throw InputError("'record stages every' names the stage '" + stage +
                       "', which none of the methods has; " + choose_one_of(known));
}

void check_thresholds(const Study& study, const std::string& file) {
  const auto& reference = study.thresholds.reference;
  if (reference.empty()) return;
  const bool named = std::any_of(study.methods.begin(), study.methods.end(),
                                 [&](const auto& method) { return method.name == reference; });
  if (!named)
    throw InputError(file + ": the thresholds' reference '" + reference +
                     "' is not one of the study's methods");
}

}  // namespace

template <int dim, int spacedim>
Method<dim, spacedim> StudyMethod::make() const {
  auto method = make_method<dim, spacedim>(type);
  for (const auto& [parameter, value] : settings) method.set(parameter, value);
  return method;
}
template Method<2> StudyMethod::make() const;
template Method<3> StudyMethod::make() const;
template Method<2, 3> StudyMethod::make() const;

std::filesystem::path built_in_studies() {
  return std::filesystem::path(SMOOTHFEM_SOURCE_DIR) / "studies";
}

std::filesystem::path find_study(const std::string& path_or_name) {
  const std::filesystem::path path = path_or_name;
  if (std::filesystem::is_regular_file(path) || path.has_parent_path() || path.has_extension())
    return path;
  const auto built_in = built_in_studies() / (path_or_name + ".prm");
  return std::filesystem::exists(built_in) ? built_in : path;
}

Study read_study(const std::filesystem::path& file, const std::string& scale) {
  const std::string text = read_study_text(file);
  // Which subsections there are depends on what the file says: first the lists, then the methods'
  // types, then everything, strictly.
  ParameterHandler lists;
  declare_lists(lists);
  parse_study(lists, text, file, true);
  const auto meshes = split_list(lists.get("meshes"));
  const MeshDimensions dimensions = in_file(file, [&] { return read_dimensions(lists); });
  const auto methods = method_labels(lists.get("methods"), dimensions);
  const auto scales = split_list(lists.get("scales"));
  require_scale(scale, scales, file.string());
  check_unique(meshes, "mesh", file.string());
  check_unique(methods, "method", file.string());

  ParameterHandler types;
  for (const auto& method : methods) declare_method(types, dimensions, method, "");
  parse_study(types, text, file, true);

  ParameterHandler p;
  declare_lists(p);
  declare_problem(p);
  for (const auto& name : scales) declare_scale(p, name);
  for (const auto& mesh : meshes) declare_mesh(p, dimensions.cells, mesh);
  for (const auto& method : methods) {
    std::string type;
    {
      const Subsection subsection(types, "method " + method);
      type = types.get("type");
    }
    in_file(file, [&] { declare_method(p, dimensions, method, type, lists.get("preset")); });
  }
  parse_study(p, text, file, false);

  Study study;
  study.name = file.stem().string();
  study.title = p.get("title");
  study.note = p.get("note");
  study.scale = scale;
  study.dimensions = dimensions;
  check_label(study.name, "study", file.string());
  if (study.title.empty()) study.title = study.name;
  for (const auto& mesh : meshes)
    study.meshes.push_back(
        in_file(file, [&] { return read_mesh_section(p, mesh, file.parent_path()); }));
  for (const auto& method : methods)
    study.methods.push_back(
        in_file(file, [&] { return read_method_section(p, dimensions, method); }));
  read_problem(p, file.string(), study);
  if (!scale.empty()) read_scale(p, file.string(), study);
  in_file(file, [&] { check_names(study); });
  in_file(file, [&] { check_stages(study); });
  check_thresholds(study, file.string());
  study.parameters = effective_parameters(p);
  // Which reader it is for; results from before there were kinds, and surfaces, go on.
  std::erase_if(study.parameters, [](const auto& entry) {
    return entry.first == "kind" ||
           entry == std::pair<std::string, std::string>{"surface", "false"};
  });
  return study;
}

}  // namespace smoothfem
