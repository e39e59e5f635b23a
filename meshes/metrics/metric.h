// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Reference to a mesh of any dimensions.
using MeshReference = std::variant<const PlanarMesh*, const VolumeMesh*, const SurfaceMesh*>;

/// Value of infinite metrics, as in Verdict.
inline constexpr double infinite_metric = 1e30;

/// A number that measures the quality, size or regularity of a cell.
struct Metric {
  std::string name;     ///< "scaled_jacobian"
  std::string meaning;  ///< a phrase
  bool larger_is_better = true;
  /// Value of a regular cell; nothing if types of cells differ in it.
  std::optional<double> ideal{};
  /// Supported types of cells.
  std::vector<ElementType> types{};
  /// True if the mesh must have targets (cell_targets.h), which are the cells of its initial mesh.
  bool compares_with_initial = false;
  /// Returns the value of each cell, at most infinite_metric; NaN for unsupported cells. Results
  /// are the same for every number of threads.
  std::function<std::vector<double>(const MeshReference&)> values{};
};

/// Returns all metrics: first those of this program, then Verdict's.
const std::vector<Metric>& metric_catalogue();

/// Returns the metrics of a list, in its order: names separated by commas, or "all". Throws
/// InputError for unknown names, with the available ones, and for duplicate names.
std::vector<const Metric*> metrics_named(const std::string& list);

}  // namespace smoothfem
