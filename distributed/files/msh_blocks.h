// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "distributed/files/file_blocks.h"
#include "meshes/io/gmsh/msh_layout.h"

namespace smoothfem {

/// A mesh in one binary .msh file of version 4.1, which all ranks read at once. Each rank reads a
/// range of the nodes and a range of the elements, as the file lists them, so that none needs
/// memory for the whole mesh. Numbers of nodes and cells are those of read_msh(): the order of the
/// tags, of nodes that an element uses.
class MshBlocks final : public FileBlocks {
 public:
  /// Finds the blocks. Collective.
  MshBlocks(const Ranks& ranks, const std::filesystem::path& path);

  const std::string& obstacle() const override { return layout_.obstacle; }
  std::variant<ScatteredMesh<2>, ScatteredMesh<3>> read(ReadFor purpose) override;
  void write(const std::filesystem::path& out,
             const NodeDirectory<NodeEntry<2>>& directory) const override {
    write_as(out, directory);
  }
  void write(const std::filesystem::path& out,
             const NodeDirectory<NodeEntry<3>>& directory) const override {
    write_as(out, directory);
  }

 private:
  template <int dim>
  ScatteredMesh<dim> read_as(ReadFor purpose);
  template <int dim>
  void write_as(const std::filesystem::path& out,
                const NodeDirectory<NodeEntry<dim>>& directory) const;

  Ranks ranks_;
  std::filesystem::path path_;
  MshLayout layout_;
  /// Numbers of the nodes of this rank's range, in the order of the file; no_number for nodes that
  /// no element uses.
  std::vector<GlobalIndex> numbers_;
};

}  // namespace smoothfem
