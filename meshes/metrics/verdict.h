// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "smoothing/mesh/mesh.h"

class vtkCell;

namespace smoothfem {

/// A metric of Sandia's Verdict library (C. Stimpson et al., The Verdict Geometric Quality Library,
/// 2007), which is part of VTK as vtkMeshQuality.
struct VerdictMetric {
  using Function = double (*)(vtkCell*);
  /// Value for a planar cell that is turned over. Verdict does not detect this case, as it takes
  /// the plane from the cell.
  enum class TurnedOver { same, negative, zero, infinite };

  std::string name, meaning;
  bool larger_is_better = true;
  std::optional<double> ideal{};
  TurnedOver turned_over = TurnedOver::same;
  Function triangle = nullptr, quadrilateral = nullptr, tetrahedron = nullptr,
           hexahedron = nullptr;  ///< null: not in VTK 9.1

  /// Returns null also for other types.
  Function of(ElementType type) const;
  std::vector<ElementType> types() const;
};

/// Returns the metrics that depend on a cell's shape alone, not on its size or position.
const std::vector<VerdictMetric>& verdict_metrics();

/// Returns the value of each cell, at most infinite_metric. NaN if the metric does not support its
/// type. The worst value, 0 or infinite_metric, if Verdict returns no finite number.
template <int dim, int spacedim>
std::vector<double> verdict_values(const VerdictMetric& metric, const Mesh<dim, spacedim>& mesh);

}  // namespace smoothfem
