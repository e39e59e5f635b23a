// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>

#include "meshes/preparation/prepare_mesh.h"
#include "python/module/bind.h"
#include "python/module/interruptible.h"
#include "python/module/python_mesh.h"
#include "python/module/python_smoother.h"
#include "smoothing/base/find_named.h"
#include "smoothing/base/parallel.h"
#include "smoothing/loop/preset.h"
#include "smoothing/loop/python_methods.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/quality/cell_targets.h"

namespace smoothfem {

namespace {

/// The result of smooth() for Python.
struct Result : SmoothingResult {
  std::string method;
  std::vector<IterationRecord> history;
  std::vector<std::string> notes, warnings;
};

using Settings = std::vector<std::pair<std::string, std::string>>;

/// method: a name, or the definition of a smoother in Python.
template <int dim, int spacedim>
Method<dim, spacedim> configured_method(const py::object& method, const std::string& preset,
                                        const Settings& settings) {
  const auto made = [&]() -> Method<dim, spacedim> {
    if (py::isinstance<py::str>(method))
      return make_method<dim, spacedim>(py::cast<std::string>(method));
    const MethodEntry entry = method_of_definition(method);
    if constexpr (dim == 2 && spacedim == 2)
      return {entry.info, entry.factories.planar()};
    else if constexpr (dim == 3)
      return {entry.info, entry.factories.volume()};
    else
      throw InputError("method " + entry.name + " does not support surface meshes");
  };
  Method<dim, spacedim> configured = made();
  if (!preset.empty()) apply_preset(find_preset(preset), configured);
  for (const auto& [name, value] : settings) configured.set(name, value);
  use_folders(configured, {});
  return configured;
}

/// Sets the number of threads during its lifetime; 0: no change.
class Threads {
 public:
  explicit Threads(int n) : before_(n_threads()) {
    if (n > 0) set_n_threads(n);
  }
  ~Threads() { set_n_threads(before_); }
  Threads(const Threads&) = delete;

 private:
  int before_;
};

/// What users ask for besides the method.
struct Options {
  MeshOptions mesh;
  std::optional<TargetKind> target;
  const PythonMesh* target_mesh = nullptr;
  bool allow_worse = true;

  template <int dim, int spacedim>
  Mesh<dim, spacedim> with_target(Mesh<dim, spacedim> work) const {
    if (!target && target_mesh == nullptr) return work;
    if constexpr (dim != spacedim) {
      throw InputError("target is for planar and volume meshes; leave it out");
    } else {
      if (target) return with_initial_targets(work, *target);
      return target_mesh->visit([&](const auto& reference) {
        return with_cells_as_targets(work, AnyMesh(reference), "this mesh", "the target");
      });
    }
  }
};

/// words: the arguments of smooth() by name. None: the default.
Options options_of(const py::dict& words, std::size_t n_nodes, bool is_surface) {
  const auto text = [&](const char* key, const std::vector<std::string>& known) {
    return find_named(key, py::cast<std::string>(words[key]), known);
  };
  const auto number = [&](const char* key) { return py::cast<std::optional<double>>(words[key]); };
  Options options;
  MeshOptions& mesh = options.mesh;
  mesh.examines = false;
  mesh.interfaces = text("interfaces", {interface_rule_names.begin(), interface_rule_names.end()});
  mesh.boundary = text("boundary", {"fixed", "slide"});
  if (is_surface && mesh.boundary == "fixed") mesh.boundary.clear();
  mesh.periodic = text("periodic", {"fixed", "smooth"});
  if (!words["fix"].is_none())
    mesh.fix = parse_fixed_nodes_rule(py::cast<std::string>(words["fix"]));
  if (const auto groups = py::cast<std::vector<std::string>>(words["fix_groups"]); !groups.empty())
    mesh.fix = FixedNodesRule{FixedNodesRule::Kind::groups, groups};
  if (const auto flags = node_flags("fix", words["fix_nodes"], n_nodes)) mesh.also_fixed = *flags;
  mesh.feature_angle = number("feature_angle");
  mesh.slide_distance = number("slide_distance");
  mesh.only_below = number("only_below");
  mesh.rings = py::cast<int>(words["rings"]);
  mesh.keep_layers = py::cast<std::optional<std::string>>(words["keep_layers"]);
  mesh.untangle = py::cast<bool>(words["untangle"]);
  options.allow_worse = py::cast<bool>(words["allow_worse"]);
  if (py::isinstance<PythonMesh>(words["target"])) {
    options.target_mesh = words["target"].cast<const PythonMesh*>();
  } else {
    std::vector<std::string> targets{"regular"};
    targets.insert(targets.end(), initial_target_names.begin(), initial_target_names.end());
    options.target = initial_target(text("target", targets));
  }
  return options;
}

/// Adds the sentences of the preparation to a result.
NoteTaker notes_for(Result& result) {
  const auto note = [&](const std::string& sentence) { result.notes.push_back(sentence); };
  const auto warn = [&](const std::string& sentence) { result.warnings.push_back(sentence); };
  return {.warn = warn, .note = warn, .tell = note};
}

/// Adds warnings about the cells and nodes of a result.
void add_warnings(std::size_t n_cells, Result& result) {
  for (const auto& text :
       {floor_text(result), invalid_cells_text(result.quality.n_invalid, n_cells)})
    if (!text.empty()) result.warnings.push_back(text);
  for (const auto& [sentence, is_warning] : midside_notes(result.midside))
    (is_warning ? result.warnings : result.notes).push_back(sentence);
}

/// The GIL must be held; others may run meanwhile. Python's arrays look at the memory of `mesh`, so
/// that another one is smoothed, whose points come back into it.
template <int dim, int spacedim>
Result smooth_in_place(Mesh<dim, spacedim>& mesh, Method<dim, spacedim>& method,
                       const Options& options,
                       const std::function<void(const IterationRecord&)>& callback,
                       bool keep_history) {
  Result result;
  result.method = method.info.name;
  for (auto& stage : method.stages)
    stage = std::make_unique<Interruptible<dim, spacedim>>(std::move(stage));
  Observer<dim, spacedim> observer;  // empty unless needed, as it costs a pass over all cells
  if (keep_history || callback)
    observer = [&](const IterationRecord& record, const Mesh<dim, spacedim>& now) {
      if (keep_history) result.history.push_back(record);
      if (!callback) return;
      const py::gil_scoped_acquire gil;
      mesh.set_coordinates(now.coordinates());
      callback(record);
    };
  const py::gil_scoped_release others_may_run;
  auto work = prepared_mesh(Mesh<dim, spacedim>(mesh.shared_topology(), mesh.copied_coordinates(),
                                                mesh.shared_constraints()),
                            options.mesh, notes_for(result));
  try {
    untangle_as_asked(options.mesh, method, {}, notes_for(result), work);
    work = options.with_target(std::move(work));
    if (!options.allow_worse) method.floor = 1;
    static_cast<SmoothingResult&>(result) = smooth_prepared(work, method, options.mesh, observer);
  } catch (...) {
    mesh.set_coordinates(work.coordinates());
    throw;
  }
  mesh.set_coordinates(work.coordinates());
  add_warnings(work.n_cells(), result);
  return result;
}

Result smooth_mesh(const py::object& object, const py::object& method, const py::object& callback,
                   const std::string& preset, const Settings& settings, bool history, int threads,
                   const py::dict& words) {
  if (threads < 0 || threads > 1024)
    throw InputError("threads is " + std::to_string(threads) +
                     ", but has to be from 1 to 1024, or 0 for all cores");
  const Threads of_this_call(threads);
  std::function<void(const IterationRecord&)> call;
  if (!callback.is_none()) call = [&](const IterationRecord& record) { callback(record, object); };
  return object.cast<PythonMesh&>().visit([&]<int dim, int spacedim>(Mesh<dim, spacedim>& mesh) {
    auto configured = configured_method<dim, spacedim>(method, preset, settings);
    check_parameters(configured);
    const Options options = options_of(words, mesh.n_nodes(), dim != spacedim);
    return smooth_in_place(mesh, configured, options, call, history);
  });
}

/// Converts numbers to numbers, everything else to its text.
py::object python_value(const Parameter& parameter) {
  if (const auto* number = std::get_if<double*>(&parameter.value)) return py::float_(**number);
  if (const auto* number = std::get_if<int*>(&parameter.value)) return py::int_(**number);
  return py::str(value_text(parameter));
}

/// name -> (default, description, range)
py::dict parameters_of(const py::object& method, const std::string& kind) {
  const std::map<std::string, MeshDimensions> kinds{
      {"planar", {2, 2}}, {"volume", {3, 3}}, {"surface", {2, 3}}};
  const auto& [name, dimensions] =
      find_named("kind of mesh", kind, kinds, [](const auto& entry) { return entry.first; });
  return with_dimensions(dimensions, [&]<int dim, int spacedim>() {
    auto made = configured_method<dim, spacedim>(method, {}, {});
    py::dict parameters;
    for (const auto& parameter : made.parameters())
      parameters[parameter.name.c_str()] =
          py::make_tuple(python_value(parameter), parameter.description, range_text(parameter));
    return parameters;
  });
}

/// name -> (title, description, source, kinds of meshes)
py::dict methods() {
  py::dict all;
  for (const auto& info : method_catalogue())
    all[info.name.c_str()] =
        py::make_tuple(info.title, info.description, info.source, mesh_kinds(info.name));
  return all;
}

void bind_results(py::module_& module) {
  py::class_<IterationRecord>(module, "Iteration", "One iteration; record 0 is the initial mesh.")
      .def_readonly("record", &IterationRecord::record, "0, 1, 2, ...")
      .def_readonly("stage", &IterationRecord::stage, "smoother that ran; 'initial' for record 0")
      .def_readonly("iteration", &IterationRecord::iteration,
                    "number within the stage, as the method counts")
      .def_readonly("smoothing_seconds", &IterationRecord::smoothing_seconds,
                    "time of the stages' main loops so far, without the callback's time")
      .def_readonly("preparation_seconds", &IterationRecord::preparation_seconds,
                    "time before the main loops: order of the nodes, tables, the initial quality")
      .def_readonly("wall_seconds", &IterationRecord::wall_seconds,
                    "time of the external program that made the mesh, with its start; or None")
      .def_readonly("quality", &IterationRecord::quality)
      .def_readonly("n_made_invalid", &IterationRecord::n_made_invalid,
                    "cells that the step made invalid, before nodes were reset; or None")
      .def_readonly("n_reset", &IterationRecord::n_reset, "number of reset nodes");
  py::class_<StageResult>(module, "Stage", "The result of one stage of a method.")
      .def_readonly("name", &StageResult::name)
      .def_readonly("iterations", &StageResult::iterations, "number, as the method counts")
      .def_readonly("why_stopped", &StageResult::why_stopped)
      .def_readonly("n_last_reset", &StageResult::n_last_reset,
                    "number of reset nodes of the last iteration");
  py::class_<Result>(module, "Result", "The result of smooth().")
      .def_readonly("method", &Result::method, "name of the method")
      .def_readonly("stages", &Result::stages)
      .def_property_readonly("iterations", &Result::iterations_text,
                             "one number a stage, as in the thesis: '40/2800'")
      .def_readonly("smoothing_seconds", &Result::smoothing_seconds,
                    "time of the stages' main loops")
      .def_readonly("preparation_seconds", &Result::preparation_seconds,
                    "time before the main loops: order of the nodes, tables, qualities")
      .def_readonly("quality", &Result::quality, "quality of the resulting mesh")
      .def_readonly("result_record", &Result::result_record,
                    "number of the iteration whose mesh is the result")
      .def_readonly("history", &Result::history,
                    "the iterations, the initial mesh first; empty unless requested")
      .def_readonly("notes", &Result::notes, "sentences on what was done before smoothing")
      .def_readonly("warnings", &Result::warnings, "sentences that smooth() has warned with")
      .def("__repr__", [](const Result& r) {
        return "<smoothfem.Result: " + r.method + ", " + r.iterations_text() + " iterations>";
      });
}

}  // namespace

void bind_smoothing(py::module_& module) {
  bind_results(module);
  module.def("smooth", &smooth_mesh);
  module.def("methods", &methods);
  module.def("parameters", &parameters_of);
  module.def("started_python", &started_python);
}

}  // namespace smoothfem
