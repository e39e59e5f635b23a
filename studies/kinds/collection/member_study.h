// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include "studies/kinds/collection/collection.h"

namespace smoothfem {

/// What of a member's initial mesh its study depends on.
struct MeshOutline {
  MeshDimensions dimensions;
  std::string elements;  ///< "triangles", ..., or "mixed"
  Eigen::AlignedBox3d box;
};

/// Of the initial mesh in the member's folder, or, where that is not there yet, of the member's
/// file or the mesh that its domain generates: distortion leaves the outline as it is. Throws
/// InputError for a file that cannot be read.
MeshOutline outline_of(const Collection& collection, const Member& member,
                       const std::filesystem::path& folder);

/// The member as a study of its own. Throws InputError if there is none: for surfaces and finite
/// elements, or a solution that meshes of its dimension do not have.
Study member_study(const Collection& collection, const Member& member, const MeshOutline& outline);

/// A formula with X, Y and Z replaced by coordinates of this box (see Collection::solutions).
std::string in_box(const std::string& formula, const Eigen::AlignedBox3d& box);

}  // namespace smoothfem
