// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include "smoothing/quality/mesh_quality.h"
#include "studies/framework/definition/study.h"

namespace smoothfem {

/// The facts about one of a study's meshes that results report.
struct MeshFacts {
  StudyMesh description;
  std::size_t n_nodes = 0, n_cells = 0;
  MeshQuality quality;
  std::string origin;      ///< file path, or the domain and its distortion
  std::string setting{};   ///< origin without the file's folder, which may have several names
  std::string file{};      ///< of the mesh that smoothing starts from, in the folder of results
  bool published = false;  ///< read by --mesh-dir: comparable with printed values digit by digit
  std::vector<std::string> changes{};  ///< made in reading the file, one sentence each
  std::string source_sha256;           ///< of the file it was read from; empty if it was generated
  /// Gauss points per direction, by degree, of the hexahedron that needed the largest number; empty
  /// if the user fixed the number.
  std::map<int, int> max_points{};
  std::string sha256;  ///< of its text form in the results; empty until that is written
};

}  // namespace smoothfem
