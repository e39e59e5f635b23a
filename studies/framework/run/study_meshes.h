// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fem/constraints/node_ties.h"
#include "studies/framework/results/mesh_facts.h"
#include "studies/framework/results/provenance.h"
#include "studies/framework/run/kept/kept_results.h"
#include "studies/framework/run/parts/mesh_in_parts.h"

namespace smoothfem {

/// A study's mesh, ready to be smoothed.
template <int dim, int spacedim = dim>
struct PreparedMesh : MeshFacts {
  Mesh<dim, spacedim> mesh;                   ///< in parts: this rank's part
  std::shared_ptr<MeshInParts<dim>> parts{};  ///< null: the mesh is whole
  std::shared_ptr<const NodeTies> ties{};     ///< constraints of the finite elements; null: none
  std::string kept_name{};  ///< of its kept file; empty: none, because it is read or a surface
  bool is_kept = false;     ///< that file is there
  /// The topology that solvers get: that of the mesh, but without midside nodes if the study's
  /// geometry is straight.
  std::shared_ptr<const Topology> of_solvers{};

  /// Returns the mesh that solvers get, with these nodes.
  Mesh<dim, spacedim> for_solvers(std::vector<Point<spacedim>> coordinates) const {
    return {of_solvers, std::move(coordinates), mesh.shared_constraints(), mesh.shared_targets()};
  }
};

/// Reads or generates one mesh, and distorts it if the study says so. mesh_dir: folder of published
/// meshes, or empty.
/// kept: if they have the mesh, it is read instead of generated or distorted. Surface meshes are
/// not, because the file lacks the initial surface. Null: no kept results.
/// Throws InputError for files and meshes that cannot be used. The returned mesh is valid. If
/// finite elements are to be solved on it, they support its cells.
template <int dim, int spacedim = dim>
PreparedMesh<dim, spacedim> prepare_mesh(const StudyMesh& description, const Study& study,
                                         const std::filesystem::path& mesh_dir,
                                         const KeptResults* kept);

/// Reads one mesh in parts. The root makes it if it is generated, distorted or untangled, and keeps
/// it in pieces, which all ranks read. So no other rank ever has the whole. The ranks refine pieces
/// if the study says so. Collective. Throws InputError on all ranks.
template <int dim>
PreparedMesh<dim> prepare_mesh_in_parts(const StudyMesh& description, const Study& study,
                                        const std::filesystem::path& mesh_dir,
                                        const KeptResults& kept, const Ranks& ranks);

/// Throws InputError if a mesh file of an earlier run has been changed since.
void require_unchanged_meshes(const EarlierRun& run, const std::filesystem::path& out);

/// Writes an initial mesh into the results folder and notes its checksum. Keeps a copy of a mesh
/// that is generated or distorted. Collective in parts.
template <int dim, int spacedim>
void write_initial_mesh(PreparedMesh<dim, spacedim>& prepared, const std::filesystem::path& out,
                        const KeptResults& kept);

}  // namespace smoothfem
