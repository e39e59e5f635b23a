// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include "distributed/files/file_blocks.h"
#include "meshes/io/vtk/vtu_layout.h"

namespace smoothfem {

/// A mesh in one .vtu file with binary arrays, inline or appended, compressed or not. Nodes have
/// their places in the file as numbers, and so have the cells among those of their dimension.
/// Arrays have the meaning of parts_of_grid() (vtk_grid.h). A result has points of 64 bits.
class VtuBlocks final : public FileBlocks {
 public:
  /// Finds the arrays. Collective.
  VtuBlocks(const Ranks& ranks, const std::filesystem::path& path);

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
  void check_types();
  template <int dim>
  ScatteredMesh<dim> read_as(ReadFor purpose);
  template <int dim>
  void write_as(const std::filesystem::path& out,
                const NodeDirectory<NodeEntry<dim>>& directory) const;

  Ranks ranks_;
  std::filesystem::path path_;
  VtuLayout layout_;  ///< what a copy needs, on the root only
  int dimension_ = 2;
  double plane_ = 0.0;  ///< z of a planar mesh
};

}  // namespace smoothfem
