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

/// Smooths a mesh of second order by a method that moves its midside nodes, too: smooth_nodes gets
/// the whole mesh, after the same repair. needs_valid: the method cannot start with invalid cells.
/// Then InputError is thrown for cells that straight edges do not repair although their corners are
/// valid. It is also thrown for nodes that slide.
template <int dim>
SmoothingResult smooth_with_midside_nodes(
    Mesh<dim>& mesh, bool needs_valid,
    const std::type_identity_t<std::function<SmoothingResult(Mesh<dim>&)>>& smooth_nodes);

}  // namespace smoothfem
