// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/preset.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "smoothing/base/data_folder.h"
#include "smoothing/base/find_named.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Adds a setting, in the place of one that an extended preset has for the same parameter.
void add_setting(Preset& preset, Preset::Setting setting) {
  for (auto& other : preset.settings)
    if (other.dim == setting.dim && other.stage == setting.stage &&
        other.parameter == setting.parameter) {
      other = std::move(setting);
      return;
    }
  preset.settings.push_back(std::move(setting));
}

void add_settings(Preset& preset, int dim, const Json& stages) {
  for (const auto& [stage, parameters] : stages.items())
    for (const auto& [parameter, entry] : parameters.items()) {
      const Json& value = entry.at(0);
      const std::string where = "preset " + preset.name + ", " + stage + "." + parameter;
      add_setting(preset, {dim, stage, parameter,
                           value.is_string() ? value.get<std::string>() : value.dump(),
                           make_origin(entry.at(1), entry.at(2), where)});
    }
}

Preset read_preset(const fs::path& file) {
  std::ifstream stream(file);
  try {
    const Json json = Json::parse(stream);
    Preset preset{file.stem().string(), json.at("description"), json.at("source"), {}};
    if (json.contains("extends"))
      preset.settings =
          read_preset(file.parent_path() / (json["extends"].get<std::string>() + ".json")).settings;
    for (const auto& [key, value] : json.items())
      if (key == "planar" || key == "volume")
        add_settings(preset, key == "planar" ? 2 : 3, value);
      else if (key != "description" && key != "source" && key != "extends" && key != "why")
        throw InputError(
            file.string() + ": a preset has no key '" + key + "'; " +
            choose_one_of({"description", "source", "extends", "planar", "volume", "why"}));
    return preset;
  } catch (const Json::exception&) {
    throw InputError(
        file.string() +
        " is not a preset: JSON with description, source, planar and volume; correct it, "
        "or reinstall the program");
  }
}

}  // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = [] {
    std::vector<Preset> read;
    for (const auto& entry : fs::directory_iterator(data_folder() / "studies/presets"))
      if (entry.path().extension() == ".json") read.push_back(read_preset(entry.path()));
    std::sort(read.begin(), read.end(),
              [](const Preset& a, const Preset& b) { return a.name < b.name; });
    return read;
  }();
  return all;
}

const Preset& find_preset(const std::string& name) {
  return find_named("preset", name, presets(), [](const Preset& preset) { return preset.name; });
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
