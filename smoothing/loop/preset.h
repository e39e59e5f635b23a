// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/origin.h"

namespace smoothfem {

/// A named set of parameters, those of an experiment in the literature.
struct Preset {
  /// One parameter of the stage with this name, in methods for meshes with cells of dimension dim.
  struct Setting {
    int dim;
    std::string stage, parameter, value;
    Origin origin;
  };

  std::string name;
  std::string description;
  std::string source;
  std::vector<Setting> settings;
};

/// Returns the presets of the program, sorted by name: the files studies/presets/NAME.json of its
/// data folder. A file has `description`, `source`, and objects `planar` and `volume` with
/// parameters for each stage: [value, kind of origin, place]. `extends` names a preset whose
/// settings it takes, unless it has its own; `why` is a comment. Throws InputError for a file with
/// any other key.
const std::vector<Preset>& presets();

/// Returns the preset of this name. Otherwise throws InputError that lists the available names.
const Preset& find_preset(const std::string& name);

/// True if the preset has parameters for at least one of the method's stages.
template <int dim, int spacedim>
bool has_parameters_for(const Preset& preset, const Method<dim, spacedim>& method);

/// Sets the parameters of the method's stages that the preset names. Throws InputError if it names
/// none of them; the message lists the stages that it has parameters for.
template <int dim, int spacedim>
void apply_preset(const Preset& preset, Method<dim, spacedim>& method);

}  // namespace smoothfem
