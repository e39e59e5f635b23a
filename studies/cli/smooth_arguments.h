// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "smoothing/loop/catalogue.h"
#include "smoothing/surface/sliding_boundary.h"

namespace smoothfem {

/// The user's arguments of `smooth`.
struct SmoothArguments {
  std::string in, out, from, to, preset, boundary, fix, log, series, tag_field, target;
  std::string interfaces = "fixed", periodic = "fixed";
  std::string method = "getme";
  std::vector<std::string> settings;
  std::optional<double> feature_angle, slide_distance, only_below;
  int rings = 2;                           ///< layers of cells around the bad cells of only_below
  int n_threads = 0;                       ///< 0: OpenMP's default
  std::optional<std::string> keep_layers;  ///< of all groups if empty, otherwise "group=NAME"
  bool untangle = false, fail_if_invalid = false, quiet = false, allow_worse = false;
  bool merge = false, keep_orientation = false;
};

inline FeatureParameters features_of(const SmoothArguments& arguments) {
  FeatureParameters features;
  if (arguments.feature_angle) features.angle_degrees = *arguments.feature_angle;
  return features;
}

inline double slide_distance_of(const SmoothArguments& arguments) {
  return arguments.slide_distance.value_or(default_slide_distance);
}

/// Makes a tangled mesh valid if --untangle is set. Otherwise throws InputError if a stage needs a
/// valid mesh.
template <int dim, int spacedim>
void make_valid(const SmoothArguments& arguments, const Method<dim, spacedim>& method,
                Mesh<dim, spacedim>& mesh, const std::vector<std::size_t>& cell_lines);

}  // namespace smoothfem
