// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <type_traits>

#include "smoothing/loop/smooth.h"

namespace smoothfem {

/// Numbers of nodes in the mesh of the corners.
enum class CornerNumbers {
  of_mesh,  ///< those of the mesh, whose midside nodes no cell uses; with labels
  dense     ///< of the corners alone, without labels: faster
};

/// Smooths a mesh of second order: `smooth_corners` moves the corners in a mesh of linear cells,
/// and midside nodes follow (midside_placement.h). The observer gets meshes whose midside nodes are
/// placed. Qualities in records and in the result are those of curved cells. keeps_floor: no cell
/// becomes worse than the worst one before. If the initial mesh is valid, or can be repaired, so is
/// the result, for every method. Where nodes slide, midside nodes of moved sides and facets go to
/// the nearest place on the initial curved surface.
template <int dim>
SmoothingResult smooth_second_order(
    Mesh<dim>& mesh, CornerNumbers numbers, bool keeps_floor,
    const std::type_identity_t<Observer<dim>>& observer,
    const std::type_identity_t<std::function<SmoothingResult(Mesh<dim>&, const Observer<dim>&)>>&
        smooth_corners);

}  // namespace smoothfem
