// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "distributed/distributed_mesh.h"
#include "distributed/files/file_blocks.h"

namespace smoothfem {

struct MeshParts;  // meshes/io/mesh_assembly.h

/// Returns the first of the pieces that a rank handles, or the end if rank is the number of ranks.
/// Shares are rounded up, so that the first rank has a piece.
std::size_t first_piece_of(const Ranks& ranks, int rank, std::size_t n_pieces);

/// A mesh in several files: VTK's .pvtu and the pieces that it names, or the files NAME_1.msh,
/// NAME_2.msh, ... into which Gmsh has split a mesh, of which one is given. Any other file is a
/// mesh of one piece. All ranks read it in blocks if they can (file_blocks.h), otherwise the first
/// rank.
///
/// Each cell is in one piece; nodes between pieces are in all of these. In VTK's files, cells have
/// the numbers of the array with the role GlobalIds, if all pieces have one, otherwise those of
/// their order. Nodes have the numbers of the array with the role GlobalIds or of `node_id`, from 0
/// or above, if all pieces have one of these. Otherwise nodes with equal coordinates are the same,
/// and are numbered as they first appear. In Gmsh's files, the tags are the numbers.
///
/// Each rank reads its pieces (first_piece_of()) one after the other. Each file is read by one
/// rank.
class Pieces {
 public:
  /// Finds the files; pieces without cells are left out. Collective. Throws InputError
  /// "path:line: ..." on all ranks, also if a file of Gmsh is missing.
  Pieces(const Ranks& ranks, const std::filesystem::path& path);

  static bool is_list(const std::filesystem::path& path) { return path.extension() == ".pvtu"; }

  /// Reads all pieces. The variant is that of their cells' dimension. Only a mesh that is read for
  /// smoothing can be written. Collective. Throws InputError.
  std::variant<ScatteredMesh<2>, ScatteredMesh<3>> read(ReadFor purpose = ReadFor::smoothing) const;

  /// Returns a path for the result, if the user gives none.
  std::filesystem::path default_output() const;
  /// Throws InputError if `out` cannot be the result or would replace a file of the mesh.
  void require_output(const std::filesystem::path& out) const;
  /// All files of the mesh, and the files that write() makes.
  std::vector<std::filesystem::path> input_files() const;
  std::vector<std::filesystem::path> output_files(const std::filesystem::path& out) const;
  /// Names the files that write() makes, for example "out_1.msh to out_3.msh".
  std::string output_text(const std::filesystem::path& out) const;

  /// Returns which files are read, why the first rank alone reads one, what it has left out, and
  /// which pieces lack an array that others have, one sentence each, on the root.
  const std::vector<std::string>& notes() const { return notes_; }

  /// Returns what a file that the first rank wrote cannot hold, on the root, since write().
  const std::vector<std::string>& losses() const { return losses_; }

  const std::vector<std::filesystem::path>& files() const { return files_; }
  /// This rank's pieces are first_piece() .. last_piece() - 1.
  std::size_t first_piece() const { return first_piece_of(ranks_, ranks_.rank(), files_.size()); }
  std::size_t last_piece() const {
    return first_piece_of(ranks_, ranks_.rank() + 1, files_.size());
  }
  /// Calls visit(p) for the pieces of this rank, and visit(nothing) when others have more, so that
  /// all ranks make the same number of calls.
  template <class Visit>
  void in_rounds(const Visit& visit) const {
    const auto n =
        static_cast<std::size_t>(ranks_.max(static_cast<double>(last_piece() - first_piece())));
    for (std::size_t k = 0; k < n; ++k)
      visit(first_piece() + k < last_piece() ? std::optional(first_piece() + k) : std::nullopt);
  }
  /// Reads a piece of this rank once more, after read(). Throws InputError if it has other nodes.
  MeshParts parts(std::size_t piece) const;
  /// Returns the numbers of its nodes in the whole mesh, after read().
  std::span<const GlobalIndex> nodes(std::size_t piece) const {
    return nodes_[piece - first_piece()];
  }

  /// Writes pieces with new coordinates, and all else as it is in the files: out.pvtu, and the
  /// pieces as out/out_NNNN.vtu; Gmsh's files from out.msh or out_1.msh as out_1.msh, out_2.msh,
  /// ...; the only piece of another file as `out`. directory: with coordinates and reasons to stay
  /// (store_coordinates). Collective. Throws InputError.
  template <int dim>
  void write(const std::filesystem::path& out,
             const NodeDirectory<NodeEntry<dim>>& directory) const;

 private:
  /// Kinds of files, by what their pieces are.
  enum class Kind { whole, vtk, gmsh };

  void leave_out_empty_pieces();
  template <int dim>
  void write_gmsh_parts(const std::filesystem::path& out,
                        const NodeDirectory<NodeEntry<dim>>& directory) const;

  Ranks ranks_;
  std::filesystem::path path_;
  Kind kind_ = Kind::whole;
  std::vector<std::filesystem::path> files_;
  /// Numbers of the nodes of each piece of this rank, since read().
  mutable std::vector<std::vector<GlobalIndex>> nodes_;
  mutable std::shared_ptr<FileBlocks> blocks_;  ///< of a file that is read in blocks
  mutable std::vector<std::string> notes_, losses_;
};

/// Returns the numbers of a piece's cells in the whole mesh; empty if the file has none.
std::vector<std::int64_t> cell_numbers(const MeshParts& parts);

/// Writes the file that lists the pieces at piece_file(), and the arrays of the first one.
void write_piece_list(const std::filesystem::path& out, std::size_t n_pieces);

/// A mesh in pieces while it is written. Pieces replace those of an earlier result only when all
/// are complete; until then they lie in a folder of their own, which the destructor removes.
class NewPieces {
 public:
  /// is_root: this rank removes the folder. The others must not write any more then.
  explicit NewPieces(std::filesystem::path out, bool is_root = true);
  ~NewPieces();
  NewPieces(const NewPieces&) = delete;
  NewPieces& operator=(const NewPieces&) = delete;

  /// Returns where to write a piece.
  std::filesystem::path file(std::size_t piece) const;
  /// Moves all pieces to their places and writes the file that lists them, on one rank. Throws
  /// InputError.
  void finish(std::size_t n_pieces) const;

 private:
  std::filesystem::path out_, folder_;
  bool has_parent_, is_root_;
};

/// Adds the numbers of nodes or elements in the whole mesh as a field with the role GlobalIds.
/// A field of the same name is replaced.
void add_global_ids(const char* name, std::vector<std::int64_t> numbers,
                    std::vector<MeshField>& fields, std::map<std::string, std::string>& roles);

/// Returns where a piece of out.pvtu lies: out/out_0007.vtu.
std::filesystem::path piece_file(const std::filesystem::path& out, std::size_t piece);
/// Returns out.pvtu and its pieces.
std::vector<std::filesystem::path> files_of_list(const std::filesystem::path& out,
                                                 std::size_t n_pieces);
/// Throws InputError if a file would be written that the mesh has. what: is written.
void require_other_files(const std::vector<std::filesystem::path>& of_mesh,
                         const std::vector<std::filesystem::path>& written,
                         const std::string& what = "the result");

}  // namespace smoothfem
