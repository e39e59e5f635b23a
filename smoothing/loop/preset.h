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

/// The parameter sets of the thesis' Chapters 5 and 6.
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
