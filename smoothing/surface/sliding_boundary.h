#pragma once

#include "smoothing/surface/node_constraints.h"

namespace smoothfem {

/// A volume mesh whose boundary nodes slide on the boundary that it has now: nodes of its feature
/// lines along them, corners stay. Features follow from the parameters and from borders between
/// labelled faces of different tags. Inner nodes are fixed where they were.
VolumeMesh with_sliding_boundary(const VolumeMesh& mesh, const FeatureParameters& parameters = {});

/// How far the boundary of a mesh with sliding boundary has come off its initial one, at the
/// middles of its facets and their sides: nodes lie on it, but between them facets cut across what
/// is curved.
double boundary_deviation(const VolumeMesh& mesh);

}  // namespace smoothfem
