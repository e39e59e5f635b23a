#pragma once

#include <string>
#include <vector>

#include "smoothing/quality/mesh_quality.h"
#include "studies/framework/study.h"

namespace smoothfem {

/// A study's mesh, ready to be smoothed.
struct PreparedMesh {
  StudyMesh description;
  PlanarMesh mesh;
  MeshQuality quality;
  std::string origin;      ///< file path, or the domain and its distortion
  bool published = false;  ///< read by --mesh-dir: comparable with printed values digit for digit
};

/// Reads or generates, and distorts, one mesh. mesh_dir: folder of published meshes, or empty.
/// Throws InputError for files and meshes that cannot be used; the mesh returned is valid.
PreparedMesh prepare_mesh(const StudyMesh& description, double edge_scale,
                          const std::filesystem::path& mesh_dir);

}  // namespace smoothfem
