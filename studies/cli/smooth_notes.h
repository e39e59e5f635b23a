// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "meshes/io/mesh_file.h"
#include "smoothing/mesh/mesh.h"
#include "studies/cli/mesh_notes.h"
#include "studies/cli/smooth_arguments.h"

namespace smoothfem {

/// Prints one note that names what a file of this name cannot hold, if anything.
void print_losses(const std::filesystem::path& path, const MeshView& mesh,
                  const MeshWriteOptions& options);
void print_losses(const std::filesystem::path& path, const std::vector<std::string>& lost);

/// Prints one note that names what a refined mesh does not have, if anything.
void print_left_out(const std::filesystem::path& path, const std::vector<std::string>& losses);

/// Returns a sentence on the fields of the file that pass through; empty if there are none.
std::string fields_text(const FileContent* content);

/// Sizes (areas or volumes) of the cells of a mesh, without signs.
template <int dim, int spacedim>
std::vector<double> cell_sizes(const Mesh<dim, spacedim>& mesh);

/// Returns, for example, "cell sizes: 0.31 to 28 times the initial ones, half of them 0.8 to 1.4";
/// empty if they are the same.
std::string size_changes(const std::vector<double>& before, const std::vector<double>& after);

/// Returns by how much the size of the domain has changed, if by more than 1e-9 of it: "the area
/// has changed from 1 to 1.2 (by 20 %)". kind: "area" or "volume".
std::string domain_change(const std::string& kind, const std::vector<double>& before,
                          const std::vector<double>& after);

}  // namespace smoothfem
