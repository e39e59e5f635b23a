// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <variant>

#include "distributed/scattered_mesh.h"

namespace smoothfem {

/// A mesh in one file, which all ranks read at once. Each rank reads a range of the nodes and a
/// range of the elements, as the file lists them, so that none needs memory for the whole mesh.
/// Nodes and cells have the numbers that one reader gives them.
class FileBlocks {
 public:
  virtual ~FileBlocks() = default;

  /// Returns why the file cannot be read in blocks, for example "it has periodic nodes"; empty if
  /// it can. Same on all ranks.
  virtual const std::string& obstacle() const = 0;

  /// Reads the file, if there is no obstacle. Collective. Throws InputError on all ranks for a
  /// damaged file.
  virtual std::variant<ScatteredMesh<2>, ScatteredMesh<3>> read(ReadFor purpose) = 0;

  /// Writes the same file with the coordinates in the directory, after read() for smoothing. All
  /// else stays. Collective. Throws InputError on all ranks.
  virtual void write(const std::filesystem::path& out,
                     const NodeDirectory<NodeEntry<2>>& directory) const = 0;
  virtual void write(const std::filesystem::path& out,
                     const NodeDirectory<NodeEntry<3>>& directory) const = 0;
};

/// Finds what a file holds. Collective.
std::shared_ptr<FileBlocks> file_blocks(const Ranks& ranks, const std::filesystem::path& path);

}  // namespace smoothfem
