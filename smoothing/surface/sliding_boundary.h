// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/surface/surface_constraints.h"

namespace smoothfem {

/// How far facets of a sliding boundary come off the initial one, unless said otherwise: by a
/// fraction of its mean edge length. A chord from middle to middle of two facets comes off by as
/// much where they make 23 degrees: coarse meshes of curved boundaries keep their shape, others
/// hardly notice.
constexpr double default_slide_distance = 0.1;

/// A volume mesh whose boundary nodes slide on the boundary that it has now: nodes of its feature
/// lines along them, corners stay. Features follow from the parameters and from borders between
/// labelled faces of different tags. Inner nodes are fixed where they were. slide_distance: the
/// middles of facets and of their sides, which cut across what is curved, come off the boundary by
/// no more than this fraction of its mean edge length; steps beyond are not taken. Throws
/// InputError unless it is above 0; infinity is no bound.
VolumeMesh with_sliding_boundary(const VolumeMesh& mesh, const FeatureParameters& parameters = {},
                                 double slide_distance = default_slide_distance);

}  // namespace smoothfem
