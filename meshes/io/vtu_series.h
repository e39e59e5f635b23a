// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// A sequence of meshes for ParaView: a collection `name.pvd` and next to it the folder `name/`
/// with `name_000000.vtu`, `name_000001.vtu`, ... The collection is rewritten after each mesh, so
/// that the series can be opened at any moment, also after a crash.
class VtuSeries {
 public:
  /// collection: path that ends with .pvd; InputError otherwise. An existing series is replaced
  /// when the first mesh is added; its files with higher numbers stay, but are not in the
  /// collection.
  explicit VtuSeries(std::filesystem::path collection);

  /// Adds a mesh. time: any finite number, for example the iteration. Throws InputError as
  /// write_mesh does.
  void add(double time, const MeshView& mesh, const MeshFields& fields = {});

  std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    double time;
    std::string file;  ///< relative to the collection
  };

  void write_collection() const;

  std::filesystem::path collection_;
  std::vector<Entry> entries_;
};

}  // namespace smoothfem
