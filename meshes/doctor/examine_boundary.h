// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "meshes/doctor/findings.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// What keeps the cells of a mesh from fitting together.
struct BoundaryExamination {
  /// Hanging nodes, coincident nodes, nodes and edges where pieces touch. The sentences name
  /// places, not numbers.
  std::vector<Finding> findings;
  /// One flag for each node: hanging nodes, corners of the facets that they lie in, coincident
  /// nodes. They must not move, since the sides of a seam would come apart. Empty if there are
  /// none.
  std::vector<bool> seam_nodes;
};
/// Examines the boundary of a mesh, which is fast.
template <int dim, int spacedim>
BoundaryExamination examine_boundary(const Mesh<dim, spacedim>& mesh);

/// Adds the findings of examine_boundary(). Returns its flags.
std::vector<bool> add_seams(Findings& findings, const Skin& skin);

/// Throws InputError for hanging nodes, unless they are constrained, and for seams of coincident
/// nodes: the solution on both sides would not fit together. The message names the first place and
/// a remedy. Returns the flags of examine_boundary().
template <int dim, int spacedim>
std::vector<bool> require_conforming(const Mesh<dim, spacedim>& mesh, const std::string& path,
                                     bool hanging_is_constrained);

}  // namespace smoothfem
