// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/metrics/metric.h"

#include <algorithm>
#include <limits>

#include "meshes/metrics/cell_sizes.h"
#include "meshes/metrics/verdict.h"
#include "smoothing/base/find_named.h"
#include "smoothing/base/text.h"
#include "smoothing/quality/dihedral_angles.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/quality/target_corners.h"

namespace smoothfem {

namespace {

const std::vector<ElementType> all_types{ElementType::triangle,  ElementType::quadrilateral,
                                         ElementType::polygon,   ElementType::tetrahedron,
                                         ElementType::pyramid,   ElementType::prism,
                                         ElementType::hexahedron};

/// Wraps a function that supports meshes of all dimensions.
template <class Values>
std::function<std::vector<double>(const MeshReference&)> of_any_mesh(Values values) {
  return [values](const MeshReference& reference) {
    return std::visit([&](const auto* mesh) -> std::vector<double> { return values(*mesh); },
                      reference);
  };
}

/// Wraps a function of planar and volume meshes with targets; other meshes have no values.
template <class Values>
auto of_targets(Values values) {
  return of_any_mesh([values]<int dim, int spacedim>(const Mesh<dim, spacedim>& mesh) {
    if constexpr (dim == spacedim)
      if (mesh.targets() != nullptr) return values(mesh);
    return std::vector<double>(mesh.n_cells(), std::numeric_limits<double>::quiet_NaN());
  });
}

/// Returns for each cell t or 1 / t, which is at most 1, with its size t relative to its target.
template <int dim>
std::vector<double> sizes_to_target(const Mesh<dim>& mesh) {
  std::vector<double> values(mesh.n_cells());
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    with_target_corners(mesh, c, coordinates_at(mesh.coordinates().data()), [&](auto corners) {
      const double t = node_simplex_size<dim>(corners);
      values[c] = t > 0.0 ? std::min(t, 1.0 / t) : 0.0;
    });
  return values;
}

/// Returns one end of the range of each cell's angles.
auto angles(double AngleRange::*end) {
  return of_any_mesh([end](const auto& mesh) {
    std::vector<double> values;
    values.reserve(mesh.n_cells());
    for (const AngleRange& range : cell_angle_ranges(mesh)) values.push_back(range.*end);
    return values;
  });
}

std::vector<Metric> make_catalogue() {
  std::vector<Metric> metrics{
      {.name = "mean_ratio",
       .meaning = "of the Jacobians at the corners against the regular cell's; 0 if invalid",
       .larger_is_better = true,
       .ideal = 1.0,
       .types = all_types,
       .values = of_any_mesh([](const auto& mesh) { return cell_mean_ratios(mesh); })},
      {.name = "min_angle",
       .meaning = "smallest angle in degrees, in space between two faces",
       .larger_is_better = true,
       .types = all_types,
       .values = angles(&AngleRange::min)},
      {.name = "max_angle",
       .meaning = "largest angle in degrees, in space between two faces",
       .larger_is_better = false,
       .types = all_types,
       .values = angles(&AngleRange::max)},
      {.name = "relative_size_squared",
       .meaning = "square of the size over the mean of the mesh's cells of this type, or its "
                  "inverse if that is less; 0 if turned over",
       .larger_is_better = true,
       .ideal = 1.0,
       .types = all_types,
       .values = of_any_mesh([](const auto& mesh) { return relative_sizes_squared(mesh); })},
      {.name = "size_gradation",
       .meaning = "largest ratio of area or volume between the cell and one that it shares a side "
                  "or face with, whichever is larger; cells without such a neighbour have none",
       .larger_is_better = false,
       .ideal = 1.0,
       .types = all_types,
       .values = of_any_mesh([](const auto& mesh) { return size_gradations(mesh); })},
      {.name = "initial_shape",
       .meaning =
           "mean ratio with the linear image of a regular cell that is closest to the initial cell "
           "as the ideal shape; in studies only",
       .larger_is_better = true,
       .ideal = 1.0,
       .types = all_types,
       .compares_with_initial = true,
       .values = of_targets([](const auto& mesh) { return cell_mean_ratios(mesh); })},
      {.name = "initial_size",
       .meaning = "size over the cell's initial size, or its inverse if that is less; 0 if turned "
                  "over; in studies only",
       .larger_is_better = true,
       .ideal = 1.0,
       .types = all_types,
       .compares_with_initial = true,
       .values = of_targets([](const auto& mesh) { return sizes_to_target(mesh); })}};
  for (const VerdictMetric& of_verdict : verdict_metrics())
    metrics.push_back({.name = of_verdict.name,
                       .meaning = of_verdict.meaning,
                       .larger_is_better = of_verdict.larger_is_better,
                       .ideal = of_verdict.ideal,
                       .types = of_verdict.types(),
                       .values = of_any_mesh([&of_verdict](const auto& mesh) {
                         return verdict_values(of_verdict, mesh);
                       })});
  return metrics;
}

}  // namespace

const std::vector<Metric>& metric_catalogue() {
  static const std::vector<Metric> metrics = make_catalogue();
  return metrics;
}

std::vector<const Metric*> metrics_named(const std::string& list) {
  std::vector<const Metric*> metrics;
  if (list == "all") {
    for (const Metric& metric : metric_catalogue()) metrics.push_back(&metric);
    return metrics;
  }
  for (const auto& name : split_list(list)) {
    const Metric* metric = &find_named("metric", name, metric_catalogue(),
                                       [](const Metric& candidate) { return candidate.name; });
    if (std::find(metrics.begin(), metrics.end(), metric) != metrics.end())
      throw InputError("the metric '" + name + "' is named twice; leave one of them out");
    metrics.push_back(metric);
  }
  return metrics;
}

}  // namespace smoothfem
