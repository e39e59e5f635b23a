// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "meshes/preparation/mesh_options.h"

namespace smoothfem {

/// The user's arguments of `smooth`.
struct SmoothArguments : MeshOptions {
  std::string in, out, from, to, preset, fix_rule, log, series, tag_field, target;
  std::string method = "getme";
  std::vector<std::string> settings;
  std::string solution;                      ///< of the finite elements in the log
  std::vector<std::string> finite_elements;  ///< their settings
  bool resume = false;
  int n_threads = 0;  ///< 0: OpenMP's default
  bool fail_if_invalid = false, quiet = false, allow_worse = false;
  bool merge = false, keep_orientation = false;
};

}  // namespace smoothfem
