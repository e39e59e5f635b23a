// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/metrics/verdict.h"

#include <vtkHexahedron.h>
#include <vtkMeshQuality.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkQuad.h>
#include <vtkTetra.h>
#include <vtkTriangle.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "meshes/metrics/metric.h"
#include "smoothing/base/parallel.h"
#include "smoothing/geometry/cell_size.h"

namespace smoothfem {

namespace {

using Quality = vtkMeshQuality;
using TurnedOver = VerdictMetric::TurnedOver;

/// VTK's cells, one of each type; every thread needs its own.
class VtkCellOfEachType {
 public:
  /// Sets the cell with these nodes, moved to the origin and scaled by a power of two to an extent
  /// of 1 to 2: Verdict treats areas and volumes below 1e-30 as zero.
  template <int spacedim>
  vtkCell* set(ElementType type, std::span<const NodeIndex> nodes,
               std::span<const Point<spacedim>> coordinates) {
    vtkCell* cell = of(type);
    const Point<spacedim>& origin = coordinates[nodes[0]];
    double extent = 0.0;
    for (const NodeIndex i : nodes)
      extent = std::max(extent, (coordinates[i] - origin).cwiseAbs().maxCoeff());
    const int exponent = extent > 0.0 && std::isfinite(extent) ? -std::ilogb(extent) : 0;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      double x[3] = {0.0, 0.0, 0.0};
      for (int d = 0; d < spacedim; ++d)
        x[d] = std::ldexp(coordinates[nodes[k]][d] - origin[d], exponent);
      cell->GetPoints()->SetPoint(static_cast<vtkIdType>(k), x);
    }
    return cell;
  }

 private:
  vtkCell* of(ElementType type) {
    switch (type) {
      case ElementType::triangle:
        return triangle_;
      case ElementType::quadrilateral:
        return quadrilateral_;
      case ElementType::tetrahedron:
        return tetrahedron_;
      default:
        return hexahedron_;
    }
  }

  vtkNew<vtkTriangle> triangle_;
  vtkNew<vtkQuad> quadrilateral_;
  vtkNew<vtkTetra> tetrahedron_;
  vtkNew<vtkHexahedron> hexahedron_;
};

double turned_over(TurnedOver how, double value) {
  switch (how) {
    case TurnedOver::negative:
      return -value;
    case TurnedOver::zero:
      return 0.0;
    case TurnedOver::infinite:
      return infinite_metric;
    case TurnedOver::same:
      break;
  }
  return value;
}

std::vector<VerdictMetric> make_metrics() {
  return {{.name = "edge_ratio",
           .meaning = "longest edge over the shortest",
           .larger_is_better = false,
           .ideal = 1.0,
           .triangle = Quality::TriangleEdgeRatio,
           .quadrilateral = Quality::QuadEdgeRatio,
           .tetrahedron = Quality::TetEdgeRatio,
           .hexahedron = Quality::HexEdgeRatio},
          {.name = "aspect_ratio",
           .meaning = "longest edge over the inscribed circle or sphere, in quadrilaterals over "
                      "the area and times the circumference",
           .larger_is_better = false,
           .ideal = 1.0,
           .triangle = Quality::TriangleAspectRatio,
           .quadrilateral = Quality::QuadAspectRatio,
           .tetrahedron = Quality::TetAspectRatio},
          {.name = "radius_ratio",
           .meaning = "circumscribed over inscribed circle or sphere",
           .larger_is_better = false,
           .ideal = 1.0,
           .triangle = Quality::TriangleRadiusRatio,
           .quadrilateral = Quality::QuadRadiusRatio,
           .tetrahedron = Quality::TetRadiusRatio},
          {.name = "condition",
           .meaning = "largest condition number of the Jacobians at the corners",
           .larger_is_better = false,
           .ideal = 1.0,
           .turned_over = TurnedOver::infinite,
           .triangle = Quality::TriangleCondition,
           .quadrilateral = Quality::QuadCondition,
           .tetrahedron = Quality::TetCondition,
           .hexahedron = Quality::HexCondition},
          {.name = "scaled_jacobian",
           .meaning = "least Jacobian at the corners, over the lengths of the edges there",
           .larger_is_better = true,
           .ideal = 1.0,
           .turned_over = TurnedOver::negative,
           .triangle = Quality::TriangleScaledJacobian,
           .quadrilateral = Quality::QuadScaledJacobian,
           .tetrahedron = Quality::TetScaledJacobian,
           .hexahedron = Quality::HexScaledJacobian},
          {.name = "shape",
           .meaning = "least inverse condition number of the weighted Jacobians; 0 if invalid",
           .larger_is_better = true,
           .ideal = 1.0,
           .turned_over = TurnedOver::zero,
           .triangle = Quality::TriangleShape,
           .quadrilateral = Quality::QuadShape,
           .tetrahedron = Quality::TetShape,
           .hexahedron = Quality::HexShape},
          {.name = "shear",
           .meaning = "least sine of the angles at the corners; 0 if invalid",
           .larger_is_better = true,
           .ideal = 1.0,
           .turned_over = TurnedOver::zero,
           .quadrilateral = Quality::QuadShear,
           .hexahedron = Quality::HexShear},
          {.name = "skew",
           .meaning = "largest cosine of the angles between the principal axes",
           .larger_is_better = false,
           .ideal = 0.0,
           .quadrilateral = Quality::QuadSkew,
           .hexahedron = Quality::HexSkew},
          {.name = "taper",
           .meaning = "how far opposite edges differ, over the principal axes",
           .larger_is_better = false,
           .ideal = 0.0,
           .quadrilateral = Quality::QuadTaper,
           .hexahedron = Quality::HexTaper},
          {.name = "stretch",
           .meaning = "shortest edge over the longest diagonal, 1 in squares and cubes",
           .larger_is_better = true,
           .ideal = 1.0,
           .quadrilateral = Quality::QuadStretch,
           .hexahedron = Quality::HexStretch}};
}

}  // namespace

VerdictMetric::Function VerdictMetric::of(ElementType type) const {
  switch (type) {
    case ElementType::triangle:
      return triangle;
    case ElementType::quadrilateral:
      return quadrilateral;
    case ElementType::tetrahedron:
      return tetrahedron;
    case ElementType::hexahedron:
      return hexahedron;
    default:
      return nullptr;
  }
}

std::vector<ElementType> VerdictMetric::types() const {
  std::vector<ElementType> known{ElementType::triangle, ElementType::quadrilateral,
                                 ElementType::tetrahedron, ElementType::hexahedron};
  std::erase_if(known, [&](ElementType type) { return of(type) == nullptr; });
  return known;
}

const std::vector<VerdictMetric>& verdict_metrics() {
  static const std::vector<VerdictMetric> metrics = make_metrics();
  return metrics;
}

template <int dim, int spacedim>
std::vector<double> verdict_values(const VerdictMetric& metric, const Mesh<dim, spacedim>& mesh) {
  constexpr std::size_t grain = 4096;
  const Topology& topology = mesh.topology();
  std::vector<double> values(mesh.n_cells(), std::numeric_limits<double>::quiet_NaN());
  const double worst = metric.larger_is_better ? 0.0 : infinite_metric;
  parallel_for_ranges(values.size(), grain, [&](std::size_t first, std::size_t last) {
    VtkCellOfEachType vtk_cells;
    for (CellIndex c = static_cast<CellIndex>(first); c < last; ++c) {
      const ElementType type = topology.cell_type(c);
      const auto function = metric.of(type);
      if (!function) continue;
      double value =
          function(vtk_cells.set<spacedim>(type, topology.cell_nodes(c), mesh.coordinates()));
      if (dim == 2 && signed_cell_size(mesh, c) < 0.0)
        value = turned_over(metric.turned_over, value);
      values[c] = std::isnan(value) ? worst : std::clamp(value, -infinite_metric, infinite_metric);
    }
  });
  return values;
}
template std::vector<double> verdict_values(const VerdictMetric&, const Mesh<2>&);
template std::vector<double> verdict_values(const VerdictMetric&, const Mesh<3>&);
template std::vector<double> verdict_values(const VerdictMetric&, const Mesh<2, 3>&);

}  // namespace smoothfem
