// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "distributed/files/pieces.h"
#include "studies/framework/run/kept/kept_results.h"

namespace smoothfem {

/// A study's mesh of which each rank holds a part. All functions are collective, and all ranks
/// throw the same InputError.
template <int dim>
class MeshInParts {
 public:
  /// Reads a mesh (pieces.h).
  MeshInParts(const Ranks& ranks, const std::filesystem::path& file);

  /// The part as it was read, until save() or write().
  const Mesh<dim>& part() const { return mesh_.part; }
  std::size_t n_nodes() const { return mesh_.n_nodes; }  ///< of the whole mesh
  std::size_t n_cells() const { return mesh_.part.topology().part()->n_cells_of_whole(); }
  /// Sentences about what was left out in reading.
  const std::vector<std::string>& notes() const { return pieces_.notes(); }
  /// A digest of the mesh's files; does not depend on the number of ranks.
  const std::string& content() const { return content_; }
  /// Extension of files that write() can make.
  std::string extension() const { return file_.extension().string(); }

  /// Keeps the coordinates of a record, in files of n_nodes_a_file nodes each, so that any number
  /// of ranks can load them. coordinates: of all nodes of the part. Returns a digest of them.
  std::string save(const KeptResults& kept, const std::string& name, std::size_t record,
                   std::span<const Point<dim>> coordinates);
  /// Returns the coordinates of all nodes of the part.
  std::vector<Point<dim>> load(const KeptResults& kept, const std::string& name,
                               std::size_t record);

  /// Writes the mesh with other coordinates, in as many files as it was read from.
  void write(const std::filesystem::path& path, std::span<const Point<dim>> coordinates);

  static constexpr std::size_t n_nodes_a_file = std::size_t{1} << 18;

 private:
  std::size_t n_files() const {
    return (mesh_.directory.n() + n_nodes_a_file - 1) / n_nodes_a_file;
  }
  /// Calls visit(file, first node, last node) for the kept files of this rank. Nodes are those of
  /// the whole mesh, without the last one.
  template <class Visit>
  void for_each_file(const Visit& visit) const;
  /// Numbers of the nodes in the kept files of this rank.
  std::vector<GlobalIndex> nodes_of_files() const;
  void store(std::span<const Point<dim>> coordinates);

  Ranks ranks_;
  std::filesystem::path file_;
  Pieces pieces_;
  DistributedMesh<dim> mesh_;
  std::string content_;
};

/// Returns a digest of all files of a mesh, which the ranks share. Collective.
std::string content_of_pieces(const Ranks& ranks, const Pieces& pieces);

/// Throws InputError if the sides of cells do not fit, by hanging or coincident nodes. Returns
/// sentences about what was not looked for, on all ranks. Collective.
std::vector<std::string> require_conforming_parts(const Ranks& ranks,
                                                  const std::filesystem::path& file);

}  // namespace smoothfem
