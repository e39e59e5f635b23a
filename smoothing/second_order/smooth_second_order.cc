// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/second_order/smooth_second_order.h"

#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "smoothing/base/scoped_timer.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/second_order/midside_placement.h"
#include "smoothing/second_order/raise_order.h"

namespace smoothfem {

namespace {

/// The corners of a mesh as a mesh of linear cells.
template <int dim>
class CornerMesh {
 public:
  CornerMesh(const Mesh<dim>& mesh, const MidsidePlacement<dim>& placement, CornerNumbers numbers)
      : nodes_(nodes_of(mesh, numbers)), mesh_(made(mesh, placement, numbers)) {}

  Mesh<dim>& mesh() { return mesh_; }

  /// Copies the positions of corners into the mesh of second order.
  void copy(const Mesh<dim>& corners, Mesh<dim>& mesh) const {
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      mesh.coordinates()[nodes_[i]] = corners.coordinates()[i];
  }

 private:
  static std::vector<NodeIndex> nodes_of(const Mesh<dim>& mesh, CornerNumbers numbers) {
    std::vector<bool> is_used(mesh.n_nodes(), numbers == CornerNumbers::of_mesh);
    for (const NodeIndex node : mesh.topology().cells().entries()) is_used[node] = true;
    std::vector<NodeIndex> nodes;
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      if (is_used[i]) nodes.push_back(i);
    return nodes;
  }

  Mesh<dim> made(const Mesh<dim>& mesh, const MidsidePlacement<dim>& placement,
                 CornerNumbers numbers) const {
    std::vector<Point<dim>> points;
    points.reserve(nodes_.size());
    for (const NodeIndex node : nodes_) points.push_back(mesh.coordinates()[node]);
    auto topology = placement.without_midside();
    if (numbers == CornerNumbers::dense) {
      std::vector<CellIndex> same_cells(mesh.n_cells());
      std::iota(same_cells.begin(), same_cells.end(), CellIndex{0});
      topology = topology->reordered(nodes_, same_cells);
    }
    return {std::move(topology), std::move(points), mesh.shared_constraints(),
            mesh.shared_targets()};
  }

  std::vector<NodeIndex> nodes_;  ///< of the mesh of second order
  Mesh<dim> mesh_;
};

/// Throws InputError if cells with these qualities are invalid although all corners are valid.
template <int dim>
void require_repaired(const Mesh<dim>& mesh, std::span<const double> quality) {
  const std::size_t n_invalid = invalid_cells(quality).size();
  if (n_invalid > 0 && mesh_quality(with_linear_cells(mesh)).n_invalid == 0)
    throw InputError(std::to_string(n_invalid) +
                     (n_invalid == 1 ? " curved cell is" : " curved cells are") +
                     " not proven valid, even with straight edges; move the corners first, for "
                     "example by method getme");
}

}  // namespace

template <int dim>
SmoothingResult smooth_second_order(
    Mesh<dim>& mesh, CornerNumbers numbers, bool keeps_floor,
    const std::type_identity_t<Observer<dim>>& observer,
    const std::type_identity_t<std::function<SmoothingResult(Mesh<dim>&, const Observer<dim>&)>>&
        smooth_corners) {
  if (mesh.constraints()) numbers = CornerNumbers::of_mesh;  // as the constraints
  double preparation_seconds = 0.0, placing_seconds = 0.0;
  std::optional<MidsidePlacement<dim>> placement;
  std::optional<CornerMesh<dim>> corners;
  MidsideReport report;
  std::vector<double> quality;
  double floor = 0.0;
  {
    const ScopedTimer timer(preparation_seconds);
    placement.emplace(mesh);
    report = placement->repair(mesh, quality);
    const MeshQuality initial = mesh_quality(mesh.topology(), quality);
    if (keeps_floor && initial.n_invalid == 0) floor = initial.q_min;
    corners.emplace(mesh, *placement, numbers);
  }
  Observer<dim> corner_observer;
  if (observer)
    corner_observer = [&](const IterationRecord& of_corners, const Mesh<dim>& moved) {
      Mesh<dim> now = mesh;
      corners->copy(moved, now);
      std::vector<double> now_quality;
      placement->place(now, 0.0, now_quality);
      IterationRecord record = of_corners;
      record.quality = mesh_quality(now.topology(), now_quality);
      observer(record, now);
    };
  SmoothingResult result = smooth_corners(corners->mesh(), corner_observer);
  {
    const ScopedTimer timer(placing_seconds);
    corners->copy(corners->mesh(), mesh);
    const MidsideReport placed = placement->place(mesh, floor, quality);
    report.n_bent = placed.n_bent;
    report.n_reset = placed.n_reset;
  }
  result.quality = mesh_quality(mesh.topology(), quality);
  result.preparation_seconds += preparation_seconds;
  result.smoothing_seconds += placing_seconds;
  result.midside = report;
  return result;
}

template <int dim>
SmoothingResult smooth_with_midside_nodes(
    Mesh<dim>& mesh, bool needs_valid,
    const std::type_identity_t<std::function<SmoothingResult(Mesh<dim>&)>>& smooth_nodes) {
  if (mesh.constraints())
    throw InputError(
        "a method that moves midside nodes cannot keep nodes on a surface of second order; leave "
        "the boundary and the interfaces fixed");
  double preparation_seconds = 0.0;
  MidsideReport report;
  {
    const ScopedTimer timer(preparation_seconds);
    std::vector<double> quality;
    report = MidsidePlacement<dim>(mesh).repair(mesh, quality);
    if (needs_valid) require_repaired(mesh, quality);
  }
  SmoothingResult result = smooth_nodes(mesh);
  result.preparation_seconds += preparation_seconds;
  result.midside = report;
  return result;
}

template SmoothingResult smooth_second_order(
    Mesh<2>&, CornerNumbers, bool, const Observer<2>&,
    const std::function<SmoothingResult(Mesh<2>&, const Observer<2>&)>&);
template SmoothingResult smooth_second_order(
    Mesh<3>&, CornerNumbers, bool, const Observer<3>&,
    const std::function<SmoothingResult(Mesh<3>&, const Observer<3>&)>&);
template SmoothingResult smooth_with_midside_nodes(Mesh<2>&, bool,
                                                   const std::function<SmoothingResult(Mesh<2>&)>&);
template SmoothingResult smooth_with_midside_nodes(Mesh<3>&, bool,
                                                   const std::function<SmoothingResult(Mesh<3>&)>&);

}  // namespace smoothfem
