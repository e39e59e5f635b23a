#include "smoothing/loop/preset.h"

#include <algorithm>

#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

using Settings = std::vector<Preset::Setting>;
using Values = std::vector<std::pair<std::string, std::string>>;

void add(Settings& settings, int dim, const std::string& stage, const Values& values) {
  for (const auto& [parameter, value] : values) settings.push_back({dim, stage, parameter, value});
}

void add_sigma(Settings& settings, const std::string& stage, const std::string& type,
               const std::string& low, const std::string& high) {
  add(settings, 3, stage, {{"sigma_" + type + "_min", low}, {"sigma_" + type + "_max", high}});
}

/// The penalties of the sequential method; in the order of the text: invalid, repeated, success.
Values penalties(const std::string& invalid, const std::string& repeated,
                 const std::string& success) {
  return {
      {"penalty_invalid", invalid}, {"penalty_repeated", repeated}, {"penalty_success", success}};
}

/// Methods that stop when two q_mean in a row differ by less than 1e-6, or after 50 iterations
/// without a better q_min or q_mean (Section 5.2; Sections 5.3 and 5.4 name the first only); the
/// optimization ends with the mesh of the best q_mean that it has met.
void add_fine_stopping(Settings& settings) {
  for (const std::string stage : {"simultaneous", "smart-laplace"})
    add(settings, 3, stage, {{"tolerance", "1e-6"}, {"patience", "50"}});
  add(settings, 3, "global-optimization", {{"result", "best-q-mean"}});
}

/// Planar meshes of Sections 5.1.1 and 6.2.
void add_planar(Settings& settings) {
  add(settings, 2, "simultaneous",
      {{"lambda", "0.35"}, {"theta", "15"}, {"rho", "1"}, {"eta", "0"}, {"tolerance", "1e-4"}});
  add(settings, 2, "sequential",
      {{"lambda", "0.45"}, {"theta", "25"}, {"rho", "0.01"}, {"cycle", "100"}, {"patience", "10"}});
  add(settings, 2, "sequential", penalties("1e-4", "1e-5", "-1e-3"));
}

void add_adaptive(Settings& settings) {
  for (const std::string stage : {"mean", "min"}) {
    for (const std::string type : {"tetrahedron", "pyramid", "prism", "hexahedron"})
      add_sigma(settings, stage, type, "1.5", "1.5");
    add(settings, 3, stage,
        {{"tetrahedron_transformation", "opposite-face-normals"}, {"max_iterations", "1000"}});
  }
  add(settings, 3, "mean", {{"relaxation", "1, 0.25, 0.0625, 0"}, {"tolerance", "1e-4"}});
  add(settings, 3, "min", {{"relaxation", "0.5, 0.25, 0.1, 0.01, 0"}, {"patience", "5"}});
  add(settings, 3, "smart-laplace", {{"tolerance", "1e-4"}, {"patience", "0"}});
}

Preset bridge() {
  Preset preset{"thesis-5.1", "planar, and volume meshes by GETMe adaptive", "Section 5.1", {}};
  add_planar(preset.settings);
  add_adaptive(preset.settings);
  return preset;
}

Preset tetrahedra() {
  Preset preset{"thesis-5.2", "tetrahedral meshes", "Section 5.2", {}};
  Settings& s = preset.settings;
  add_sigma(s, "simultaneous", "tetrahedron", "40", "40");
  add(s, 3, "simultaneous",
      {{"tetrahedron_transformation", "opposite-face-normals"},
       {"scaling", "mean-volume"},
       {"rho", "0.1"},
       {"eta", "0"}});
  add_fine_stopping(s);
  add_sigma(s, "sequential", "tetrahedron", "0.0001", "0.0001");
  // The thesis stops after 5000 transformations without a better q_min or q_mean; q_mean falls.
  add(s, 3, "sequential",
      {{"tetrahedron_transformation", "opposite-face-normals"},
       {"scaling", "mean-edge-length"},
       {"rho", "0.75"},
       {"cycle", "100"},
       {"patience", "50"},
       {"max_mean_loss", "0.01"}});
  return preset;
}

Preset hexahedra() {
  Preset preset{"thesis-5.3", "hexahedral meshes", "Section 5.3", {}};
  Settings& s = preset.settings;
  add_sigma(s, "simultaneous", "hexahedron", "0.5", "0.6");
  add(s, 3, "simultaneous", {{"scaling", "mean-edge-length"}, {"rho", "0.75"}, {"eta", "0.5"}});
  add_fine_stopping(s);
  add_sigma(s, "sequential", "hexahedron", "0.01", "0.01");
  add(s, 3, "sequential",
      {{"scaling", "mean-edge-length"}, {"rho", "0.01"}, {"cycle", "100"}, {"patience", "10"}});
  add(s, 3, "sequential", penalties("0.0002", "0.0004", "-0.0002"));
  return preset;
}

void add_mixed(Settings& s) {
  add_sigma(s, "simultaneous", "tetrahedron", "0.77", "0.84");
  add_sigma(s, "simultaneous", "hexahedron", "2.57", "3.45");
  add_sigma(s, "simultaneous", "pyramid", "1.86", "1.86");
  add_sigma(s, "simultaneous", "prism", "1.59", "1.59");
  add(s, 3, "simultaneous",
      {{"tetrahedron_transformation", "dual-element"},
       {"scaling", "mean-edge-length"},
       {"rho", "0.6666666666666666"},
       {"eta", "0.25"}});
  add_fine_stopping(s);
  for (const std::string stage : {"sequential", "qgamma"}) {
    add_sigma(s, stage, "tetrahedron", "0.81", "0.81");
    add_sigma(s, stage, "hexahedron", "2.74", "2.74");
    add_sigma(s, stage, "pyramid", "1.82", "1.82");
    add_sigma(s, stage, "prism", "0.85", "0.85");
    add(s, 3, stage,
        {{"tetrahedron_transformation", "dual-element"},
         {"scaling", "mean-edge-length"},
         {"rho", "0.01"}});
    add(s, 3, stage, penalties("0.01", "0.0005", "-0.01"));
  }
  add(s, 3, "qgamma", {{"gamma", "0.25"}, {"cycle", "1"}});
}

Preset mixed() {
  Preset preset{"thesis-5.4", "meshes of several volume elements, and q_gamma", "Section 5.4", {}};
  add_mixed(preset.settings);
  return preset;
}

Preset adaptive() {
  Preset preset{"thesis-5.5",
                "GETMe adaptive; GETMe of Section 5.4 with the stopping rule of Chapter 6",
                "Section 5.5.1",
                {}};
  // What comes later counts: smart Laplace, the optimization and, as the parameters "of Section 5.4
  // and Chapter 6" and the printed 12 iterations say, GETMe stop earlier than in Section 5.4.
  add_mixed(preset.settings);
  add_adaptive(preset.settings);
  add(preset.settings, 3, "simultaneous", {{"tolerance", "1e-4"}, {"patience", "0"}});
  add(preset.settings, 3, "global-optimization", {{"result", "last"}});
  return preset;
}

Preset finite_elements() {
  Preset preset{"thesis-6.3",
                "meshes of Chapter 6: planar ones as in Section 6.2, tetrahedra and hexahedra",
                "Sections 6.2 and 6.3",
                {}};
  Settings& s = preset.settings;
  add_planar(s);
  for (const std::string type : {"tetrahedron", "hexahedron"}) {
    add_sigma(s, "simultaneous", type, "0.7", "50.7");
    add_sigma(s, "sequential", type, "17", "17");
  }
  add(s, 3, "simultaneous",
      {{"tetrahedron_transformation", "opposite-face-normals"},
       {"scaling", "mean-edge-length"},
       {"rho", "1"},
       {"eta", "0"},
       {"tolerance", "1e-4"}});
  add(s, 3, "sequential",
      {{"tetrahedron_transformation", "opposite-face-normals"},
       {"scaling", "mean-edge-length"},
       {"rho", "0.01"},
       {"cycle", "100"},
       {"patience", "10"}});
  add(s, 3, "sequential", penalties("1e-4", "1e-5", "-1e-3"));
  return preset;
}

}  // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = [] {
    std::vector<Preset> made{bridge(), tetrahedra(), hexahedra(),
                             mixed(),  adaptive(),   finite_elements()};
    for (Preset& preset : made)  // the Newton method as the thesis means it
      for (const int dim : {2, 3})
        preset.settings.push_back({dim, "global-optimization", "start_sweeps", "0"});
    return made;
  }();
  return all;
}

const Preset& find_preset(const std::string& name) {
  std::vector<std::string> known;
  for (const Preset& preset : presets()) {
    if (preset.name == name) return preset;
    known.push_back(preset.name);
  }
  throw InputError("there is no preset '" + name + "'; " + choose_one_of(known));
}

template <int dim, int spacedim>
bool has_parameters_for(const Preset& preset, const Method<dim, spacedim>& method) {
  return std::any_of(preset.settings.begin(), preset.settings.end(), [&](const auto& setting) {
    return setting.dim == dim &&
           std::any_of(method.stages.begin(), method.stages.end(),
                       [&](const auto& stage) { return stage->name() == setting.stage; });
  });
}

template <int dim, int spacedim>
void apply_preset(const Preset& preset, Method<dim, spacedim>& method) {
  const std::string owner = "preset " + preset.name;
  if (!has_parameters_for(preset, method)) {
    std::vector<std::string> known;
    for (const auto& setting : preset.settings)
      if (setting.dim == dim && std::find(known.begin(), known.end(), setting.stage) == known.end())
        known.push_back(setting.stage);
    throw InputError(owner + " has no parameters for method " + method.info.name + " on " +
                     mesh_kind_name(dim, spacedim) + " meshes; it has them for the stages " +
                     joined(known));
  }
  for (const auto& setting : preset.settings)
    for (auto& stage : method.stages)
      if (setting.dim == dim && stage->name() == setting.stage)
        set_value(find_parameter(stage->parameters(), setting.parameter, owner), setting.value,
                  owner);
}

template bool has_parameters_for(const Preset&, const Method<2>&);
template bool has_parameters_for(const Preset&, const Method<3>&);
template void apply_preset(const Preset&, Method<2>&);
template void apply_preset(const Preset&, Method<3>&);
template bool has_parameters_for(const Preset&, const Method<2, 3>&);
template void apply_preset(const Preset&, Method<2, 3>&);

}  // namespace smoothfem
