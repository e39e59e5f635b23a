// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/surface/surface_constraints.h"

namespace smoothfem {

/// Default of the largest distance of a sliding boundary's facets from the initial one, as a
/// fraction of its mean edge length. The chord between the midpoints of two facets has this
/// distance if they meet at 23 degrees. So coarse meshes of curved boundaries keep their shape;
/// other meshes hardly notice.
constexpr double default_slide_distance = 0.1;

/// Surfaces that nodes slide on.
struct SlidingSurfaces {
  bool boundary = true, interfaces = false;
};

/// Returns a volume mesh whose boundary nodes slide on its present boundary. Nodes of feature lines
/// slide along them, and corners stay. Features follow from the parameters and from borders between
/// labelled faces of different tags. Inner nodes keep their fixed flags. slide_distance: largest
/// distance from the boundary of the midpoints of facets and of their sides, as a fraction of the
/// boundary's mean edge length. Facets cut across curved parts; steps beyond the distance are not
/// taken. Throws InputError unless it is above 0; infinity means no limit.
/// what: which surfaces nodes slide on. Interfaces are those of inner_interfaces(); where they meet
/// each other or the boundary are feature lines. Nodes of surfaces that do not slide stay.
VolumeMesh with_sliding_boundary(const VolumeMesh& mesh, const FeatureParameters& parameters = {},
                                 double slide_distance = default_slide_distance,
                                 SlidingSurfaces what = {});

}  // namespace smoothfem
