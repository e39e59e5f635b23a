// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "studies/framework/definition/study.h"

namespace smoothfem {

/// A combination of one initial mesh and one solution. It is an ordinary study of smoothing methods
/// with its own results folder.
struct Member {
  std::string name;          ///< in tables, and of its folder; a label
  std::string family;        ///< the domain; of a file its folder, its own label, or as published
  StudyMesh mesh;            ///< all members with the same initial mesh share its name
  std::string solution;      ///< one of Collection::solutions
  std::string size{};        ///< edge scale of a generated mesh, as the study file writes it
  std::string distortion{};  ///< mean quality after distortion; empty: not distorted

  /// True if another seed gives another mesh, or if the mesh is generated.
  bool has_seed() const { return !mesh.domain.empty() || is_distorted(mesh); }
};

/// The part of a collection's members that runs here: part k of n.
struct Shard {
  unsigned int k = 1, n = 1;

  /// Reads for example "3/10". Throws InputError for anything else.
  static Shard parse(const std::string& text);
  /// True if the member is in this part. Members of one mesh are in one part, the same on every
  /// machine.
  bool holds(const Member& member) const;
};

/// A study of many meshes: its members, and the settings that they share.
struct Collection {
  StudyHeader header;
  /// Methods, finite elements and records, by the dimension of the cells (2, 3), without meshes.
  /// Only dimensions that occur have an entry.
  std::map<int, Study> common;
  /// Why studies cannot be read, for a dimension that only mesh files could have.
  std::map<int, std::string> refusals;
  /// Solutions. Formulas may use X, Y and Z: coordinates in the mesh's bounding box, from 0 to 1
  /// along its longest side.
  std::map<std::string, StudySolution> solutions;
  std::vector<Member> members;           ///< sorted by name
  std::vector<std::string> notes{};      ///< sentences about keys that change nothing
  std::vector<std::string> published{};  ///< sets of published meshes
  /// Seconds that a member may take for each phase of run_collection; 0: no limit.
  double time_limit = 0.0;
};

/// Reads a study file of the kind `collection`. Throws InputError as read_study does, for patterns
/// that no file matches, and for names that two members would have.
Collection read_collection(const std::filesystem::path& file, const std::string& scale = {});

/// Returns the collection with the paths of published meshes, whose files are below the folder.
/// Throws InputError if it is empty or lacks one of them.
Collection with_published_files(Collection collection, const std::filesystem::path& mesh_dir);

/// Returns a commented study file with every key of collections alone and its default.
std::string collection_template();

}  // namespace smoothfem
