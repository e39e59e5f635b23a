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
  /// What it is for a planar cell that is turned over as a whole, which Verdict does not see: it
  /// takes the plane from the cell.
  enum class TurnedOver { same, negative, zero, infinite };

  std::string name, meaning;
  bool larger_is_better = true;
  std::optional<double> ideal{};
  TurnedOver turned_over = TurnedOver::same;
  Function triangle = nullptr, quadrilateral = nullptr, tetrahedron = nullptr,
           hexahedron = nullptr;  ///< null: VTK 9.1 has none

  /// Null for other types, too.
  Function of(ElementType type) const;
  std::vector<ElementType> types() const;
};

/// Those that depend on a cell's shape alone, not on its size or place.
const std::vector<VerdictMetric>& verdict_metrics();

/// Of each cell, at most infinite_metric; NaN where the metric does not know its type, and the
/// worst value, 0 or infinite_metric, where Verdict makes nothing of it.
template <int dim, int spacedim>
std::vector<double> verdict_values(const VerdictMetric& metric, const Mesh<dim, spacedim>& mesh);

}  // namespace smoothfem
