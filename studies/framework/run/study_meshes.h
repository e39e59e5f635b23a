// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "studies/framework/results/mesh_facts.h"

namespace smoothfem {

/// A study's mesh, ready to be smoothed.
template <int dim, int spacedim = dim>
struct PreparedMesh : MeshFacts {
  Mesh<dim, spacedim> mesh;
};

/// Reads or generates, and distorts, one mesh. mesh_dir: folder of published meshes, or empty.
/// kept: a file where an earlier run of the same study has put the mesh, taken in place of a
/// generated or distorted one if it is there (not in that of a surface mesh, which would not know
/// its initial surface). Throws InputError for files and meshes that cannot be
/// used; the mesh returned is valid and, if finite elements are to be solved on it, of cells they
/// can have.
template <int dim, int spacedim = dim>
PreparedMesh<dim, spacedim> prepare_mesh(const StudyMesh& description, const Study& study,
                                         const std::filesystem::path& mesh_dir,
                                         const std::filesystem::path& kept);

/// Of a file's content, as hexadecimal digits; empty if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace smoothfem
