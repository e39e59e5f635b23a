// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace smoothfem {

/// One part of a mesh that Gmsh has split into files, one for each partition
/// (Mesh.PartitionSplitMeshFiles): NAME_1.msh, NAME_2.msh and so on.
struct MshPart {
  int number = 0;           ///< from 1
  std::uint64_t n_all = 0;  ///< parts of the mesh
};

/// Returns which part a file of version 4.1 has; nothing for other files and damaged ones. Reads
/// its beginning only.
std::optional<MshPart> msh_part(const std::filesystem::path& path);

/// Returns the name of part k of a mesh: from NAME.msh or NAME_1.msh, NAME_k.msh.
std::filesystem::path msh_part_file(const std::filesystem::path& path, int k);

/// Returns the files of all parts, of which one is given. Throws InputError if the name does not
/// end with its number. The other files need not exist.
std::vector<std::filesystem::path> files_of_msh_parts(const std::filesystem::path& path,
                                                      const MshPart& part);

/// The nodes of a file of version 4.1 as it lists them, to write the file with other coordinates.
class MshNodeFile {
 public:
  /// Reads a file. Throws InputError if it has no nodes, another version or another byte order.
  explicit MshNodeFile(const std::filesystem::path& path);

  const std::vector<std::uint64_t>& tags() const { return tags_; }

  /// Writes the file with other coordinates; all other bytes stay. point(i): the first dim
  /// coordinates of node i, or null if it stays where it is.
  void write(const std::filesystem::path& out, std::size_t dim,
             const std::function<const double*(std::size_t)>& point) const;

 private:
  bool read_nodes(std::size_t begin);

  std::filesystem::path path_;
  std::string content_;
  bool is_binary_ = false;
  std::vector<std::uint64_t> tags_;
  std::vector<std::size_t> places_;  ///< of the coordinates in the content
};

}  // namespace smoothfem
