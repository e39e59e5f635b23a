// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include "studies/kinds/collection/definition/collection.h"

namespace smoothfem {

/// The facts of a member's initial mesh that its study depends on.
struct MeshOutline {
  MeshDimensions dimensions;
  std::string elements;  ///< "triangles", ..., or "mixed"
  Eigen::AlignedBox3d box;
};

/// Returns the outline of the initial mesh in the member's folder. If that does not exist yet, or
/// the folder is empty, it is the outline of the member's file or of its domain's mesh. Distortion
/// does not change the outline. Throws InputError for a file that cannot be read.
MeshOutline outline_of(const Collection& collection, const Member& member,
                       const std::filesystem::path& folder);

/// Returns the member as a study. Throws InputError for surfaces with finite elements, and for a
/// solution that meshes of its dimension do not have.
Study member_study(const Collection& collection, const Member& member, const MeshOutline& outline);

/// Returns a formula with X, Y and Z replaced by coordinates of this box (see
/// Collection::solutions).
std::string in_box(const std::string& formula, const Eigen::AlignedBox3d& box);

}  // namespace smoothfem
