// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <type_traits>

#include "smoothing/loop/smooth.h"

namespace smoothfem {

/// Smooths a mesh of second order: the method moves its corners, and midside nodes follow
/// (midside_placement.h). `smooth_corners` smooths a mesh of the same nodes and linear cells. The
/// observer gets meshes whose midside nodes are placed. Qualities in records and in the result are
/// those of curved cells. If the initial mesh is valid, or can be repaired, so is the result, for
/// every method. Throws InputError for nodes that slide.
template <int dim>
SmoothingResult smooth_second_order(
    Mesh<dim>& mesh, bool keeps_floor, const std::type_identity_t<Observer<dim>>& observer,
    const std::type_identity_t<std::function<SmoothingResult(Mesh<dim>&, const Observer<dim>&)>>&
        smooth_corners);

}  // namespace smoothfem
