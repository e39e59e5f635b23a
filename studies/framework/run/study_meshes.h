// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fem/constraints/node_ties.h"
#include "studies/framework/results/mesh_facts.h"
#include "studies/framework/results/provenance.h"

namespace smoothfem {

/// A study's mesh, ready to be smoothed.
template <int dim, int spacedim = dim>
struct PreparedMesh : MeshFacts {
  Mesh<dim, spacedim> mesh;
  std::shared_ptr<const NodeTies> ties{};  ///< constraints of the finite elements; null: none
};

/// Reads or generates one mesh, and distorts it if the study says so. mesh_dir: folder of published
/// meshes, or empty.
/// earlier: results folder of an earlier run of the same study, or empty. If it has the mesh, the
/// mesh is read instead of generated or distorted. Surface meshes are not, because the file lacks
/// the initial surface.
/// Throws InputError for files and meshes that cannot be used. The returned mesh is valid. If
/// finite elements are to be solved on it, they support its cells.
template <int dim, int spacedim = dim>
PreparedMesh<dim, spacedim> prepare_mesh(const StudyMesh& description, const Study& study,
                                         const std::filesystem::path& mesh_dir,
                                         const std::filesystem::path& earlier);

/// Writes an initial mesh into the results folder, and notes its checksum.
template <int dim, int spacedim>
void write_initial_mesh(PreparedMesh<dim, spacedim>& prepared, const std::filesystem::path& out);

/// Throws InputError if the mesh file of an earlier run has been changed since. Writes the file if
/// that run was stopped before it had written or noted it.
template <int dim, int spacedim>
void require_same_mesh(PreparedMesh<dim, spacedim>& prepared, const EarlierRun& run,
                       const std::filesystem::path& out);

}  // namespace smoothfem
