// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A mesh of any dimensions, which is not copied.
using MeshReference = std::variant<const PlanarMesh*, const VolumeMesh*, const SurfaceMesh*>;

/// What metrics have where they would be infinite, as Verdict has it.
inline constexpr double infinite_metric = 1e30;

/// A number that says how good, large or regular a cell is.
struct Metric {
  std::string name;     ///< "scaled_jacobian"
  std::string meaning;  ///< a phrase
  bool larger_is_better = true;
  std::optional<double> ideal{};  ///< of a regular cell; none where types of cells differ in it
  /// Of cells, all others have none.
  std::vector<ElementType> types{};
  /// Of each cell, at most infinite_metric; NaN where it has none. The same for every number of
  /// threads.
  std::function<std::vector<double>(const MeshReference&)> values{};

  bool is_defined_for(ElementType type) const;
};

/// All metrics: first those of this program, then Verdict's.
const std::vector<Metric>& metric_catalogue();

/// Metrics of a list, in its order: names separated by commas, or "all". Throws InputError for
/// unknown names, with those there are, and for a name that comes twice.
std::vector<const Metric*> metrics_named(const std::string& list);

}  // namespace smoothfem
