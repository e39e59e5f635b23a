// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/periodic/mesh_rules.h"

namespace smoothfem {

/// What users ask for besides the method when they smooth a mesh, by the command or in Python.
/// Words are those of the command's options.
struct MeshOptions {
  std::string boundary;  ///< "slide"; "fixed" or empty: stays
  std::string interfaces = "fixed", periodic = "fixed";
  std::optional<FixedNodesRule> fix;
  std::vector<bool> also_fixed;  ///< flag of each node that stays besides; empty: none
  std::optional<double> feature_angle, slide_distance, only_below;
  int rings = 2;                           ///< layers of cells around the bad cells of only_below
  std::optional<std::string> keep_layers;  ///< of all groups if empty, otherwise "group=NAME"
  bool untangle = false;
  bool has_target = false;  ///< cells have targets, which thin cells keep
  /// If false, seams are looked for only where nodes of the boundary may move, and layers only to
  /// keep them; there are no warnings.
  bool examines = true;

  bool slides() const { return boundary == "slide" || interfaces == "slide"; }
  MeshRules rules() const;
};

/// Takes sentences on what preparation finds and changes.
struct NoteTaker {
  std::function<void(const std::string&)> warn;  ///< users should act
  std::function<void(const std::string&)> note;  ///< an option has no effect
  std::function<void(const std::string&)> tell;  ///< what was done
};

}  // namespace smoothfem
