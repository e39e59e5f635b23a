// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "distributed/scattered_mesh.h"
#include "meshes/io/gmsh/msh_layout.h"

namespace smoothfem {

/// A mesh in one binary .msh file of version 4.1, which all ranks read at once. Each rank reads a
/// range of the nodes and a range of the elements, as the file lists them, so that none needs
/// memory for the whole mesh. Numbers of nodes and cells are those of read_msh(): the order of the
/// tags, of nodes that an element uses.
class FileBlocks {
 public:
  /// Finds the blocks. Collective.
  FileBlocks(const Ranks& ranks, const std::filesystem::path& path);

  /// Returns why the file cannot be read in blocks, for example "it has periodic nodes"; empty if
  /// it can. Same on all ranks.
  const std::string& obstacle() const { return layout_.obstacle; }

  /// Reads the file, if there is no obstacle. Collective. Throws InputError on all ranks for a
  /// damaged file.
  std::variant<ScatteredMesh<2>, ScatteredMesh<3>> read(ReadFor purpose);

  /// Writes the same file with the coordinates in the directory, after read() for smoothing. All
  /// other bytes stay. Collective. Throws InputError on all ranks.
  template <int dim>
  void write(const std::filesystem::path& out,
             const NodeDirectory<NodeEntry<dim>>& directory) const;

 private:
  template <int dim>
  ScatteredMesh<dim> read_as(ReadFor purpose);

  Ranks ranks_;
  std::filesystem::path path_;
  MshLayout layout_;
  /// Numbers of the nodes of this rank's range, in the order of the file; no_number for nodes that
  /// no element uses.
  std::vector<GlobalIndex> numbers_;
};

}  // namespace smoothfem
