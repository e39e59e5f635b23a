// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "studies/framework/definition/study.h"

namespace smoothfem {

/// One initial mesh and one solution: an ordinary study of smoothing methods, with a results folder
/// of its own.
struct Member {
  std::string name;          ///< of its folder and in tables; a label
  std::string family;        ///< the domain, or the folder of the file
  StudyMesh mesh;            ///< its name is that of all members with the same initial mesh
  std::string solution;      ///< one of Collection::solutions
  std::string size{};        ///< edge scale of a generated mesh, as the study file writes it
  std::string distortion{};  ///< mean quality that it is distorted to; empty: as it is
};

/// Which members of a collection are run here: those of the k-th of n parts.
struct Shard {
  unsigned int k = 1, n = 1;

  /// "3/10"; throws InputError for anything else.
  static Shard parse(const std::string& text);
  /// Members of one mesh are in one part, the same on every machine.
  bool holds(const Member& member) const;
};

/// A study of many meshes: what its members have in common, and the members.
struct Collection {
  StudyHeader header;
  /// Methods, finite elements and records, by the dimension of the cells (2, 3) as far as it
  /// occurs; without meshes.
  std::map<int, Study> common;
  /// Of a dimension that only files could have: why its studies cannot be read.
  std::map<int, std::string> refusals;
  /// Formulas may be in X, Y and Z: coordinates in the mesh's bounding box, from 0 to 1 along its
  /// longest side.
  std::map<std::string, StudySolution> solutions;
  std::vector<Member> members;  ///< sorted by name
};

/// Reads a study file of the kind `collection`; throws InputError as read_study does, for patterns
/// that no file matches, and for names that two members would have.
Collection read_collection(const std::filesystem::path& file, const std::string& scale = {});

/// A commented study file with every key of its own and its default.
std::string collection_template();

}  // namespace smoothfem
