// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "studies/framework/results/mesh_facts.h"
#include "studies/framework/results/provenance.h"

namespace smoothfem {

/// A study's mesh, ready to be smoothed.
template <int dim, int spacedim = dim>
struct PreparedMesh : MeshFacts {
  Mesh<dim, spacedim> mesh;
};

/// Reads or generates, and distorts, one mesh. mesh_dir: folder of published meshes, or empty.
/// earlier: folder of the results of an earlier run of the same study, or empty; if the mesh is
/// there, it is taken in place of a generated or distorted one (not in that of a surface mesh,
/// which would not know its initial surface). Throws InputError for files and meshes that cannot be
/// used; the mesh returned is valid and, if finite elements are to be solved on it, of cells they
/// can have.
template <int dim, int spacedim = dim>
PreparedMesh<dim, spacedim> prepare_mesh(const StudyMesh& description, const Study& study,
                                         const std::filesystem::path& mesh_dir,
                                         const std::filesystem::path& earlier);

/// Writes a mesh that smoothing starts from into the folder of results, and notes its checksum.
template <int dim, int spacedim>
void write_initial_mesh(PreparedMesh<dim, spacedim>& prepared, const std::filesystem::path& out);

/// Throws InputError if the file of an earlier run there has been changed since; writes it if that
/// run was stopped before it had, or had noted it.
template <int dim, int spacedim>
void require_same_mesh(PreparedMesh<dim, spacedim>& prepared, const EarlierRun& run,
                       const std::filesystem::path& out);

}  // namespace smoothfem
