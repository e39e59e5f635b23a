// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "smoothing/loop/catalogue.h"

namespace smoothfem {

/// A named set of parameters: those of an experiment in the literature.
struct Preset {
  /// One parameter of the stage with this name, in methods for meshes of cells of dimension dim.
  struct Setting {
    int dim;
    std::string stage, parameter, value;
  };

  std::string name;
  std::string description;
  std::string source;
  std::vector<Setting> settings;
};

/// The presets that come with the program, the files studies/presets/NAME.json of its data folder,
/// sorted by name. A file has `description`, `source`, and objects `planar` and `volume` with, for
/// each stage, parameters and their values; `extends` names a preset whose settings come first, and
/// `why` is for readers. Throws InputError for a file that has something else.
const std::vector<Preset>& presets();

/// Throws InputError listing the names there are.
const Preset& find_preset(const std::string& name);

/// True if the preset has parameters for one of the method's stages.
template <int dim, int spacedim>
bool has_parameters_for(const Preset& preset, const Method<dim, spacedim>& method);

/// Sets the parameters of the method's stages that the preset names. Throws InputError if it names
/// none of them; the sentence says which stages it has parameters for.
template <int dim, int spacedim>
void apply_preset(const Preset& preset, Method<dim, spacedim>& method);

}  // namespace smoothfem
