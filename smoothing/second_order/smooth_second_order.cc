// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/second_order/smooth_second_order.h"

#include <optional>
#include <utility>

#include "smoothing/base/scoped_timer.h"
#include "smoothing/second_order/midside_placement.h"

namespace smoothfem {

template <int dim>
SmoothingResult smooth_second_order(
    Mesh<dim>& mesh, bool keeps_floor, const std::type_identity_t<Observer<dim>>& observer,
    const std::type_identity_t<std::function<SmoothingResult(Mesh<dim>&, const Observer<dim>&)>>&
        smooth_corners) {
  if (mesh.constraints())
    throw InputError(
        "nodes of the boundary cannot slide in meshes of second order; leave the boundary fixed");
  double preparation_seconds = 0.0, placing_seconds = 0.0;
  std::optional<MidsidePlacement<dim>> placement;
  MidsideReport report;
  std::vector<double> quality;
  double floor = 0.0;
  {
    const ScopedTimer timer(preparation_seconds);
    placement.emplace(mesh);
    report = placement->repair(mesh);
    const MeshQuality initial = compute_cell_mean_ratios(mesh, quality);
    if (keeps_floor && initial.n_invalid == 0) floor = initial.q_min;
  }
  Observer<dim> corner_observer;
  if (observer)
    corner_observer = [&](const IterationRecord& of_corners, const Mesh<dim>& corners) {
      Mesh<dim> now(mesh.shared_topology(), corners.copied_coordinates(), nullptr,
                    mesh.shared_targets());
      std::vector<double> now_quality;
      placement->place(now, 0.0, now_quality);
      IterationRecord record = of_corners;
      record.quality = mesh_quality(now.topology(), now_quality);
      observer(record, now);
    };
  Mesh<dim> corners(mesh.topology().without_midside(), mesh.copied_coordinates(), nullptr,
                    mesh.shared_targets());
  SmoothingResult result = smooth_corners(corners, corner_observer);
  {
    const ScopedTimer timer(placing_seconds);
    mesh.set_coordinates(std::as_const(corners).coordinates());
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

template SmoothingResult smooth_second_order(
    Mesh<2>&, bool, const Observer<2>&,
    const std::function<SmoothingResult(Mesh<2>&, const Observer<2>&)>&);
template SmoothingResult smooth_second_order(
    Mesh<3>&, bool, const Observer<3>&,
    const std::function<SmoothingResult(Mesh<3>&, const Observer<3>&)>&);

}  // namespace smoothfem
