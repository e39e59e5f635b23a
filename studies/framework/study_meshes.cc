#include "studies/framework/study_meshes.h"

#include <sstream>

#include "meshes/distortion/distort.h"
#include "meshes/generators/domains.h"
#include "meshes/io/mesh_file.h"

namespace smoothfem {

namespace {

PlanarMesh read_valid_mesh(const std::filesystem::path& path) {
  const MeshFile file = read_mesh(path);
  const PlanarMesh& mesh = planar_mesh(file, path);
  require_valid(mesh, path.string(), file.cell_lines);
  return mesh;
}

PlanarMesh distorted(PlanarMesh mesh, const StudyMesh& description, std::string& origin) {
  if (description.distort_to_q_mean == 0.0) return mesh;
  DistortionParameters parameters;
  parameters.target_q_mean = description.distort_to_q_mean;
  parameters.seed = description.seed;
  distort(mesh, parameters);
  std::ostringstream text;
  text << origin << ", distorted to q_mean " << description.distort_to_q_mean << " with seed "
       << description.seed;
  origin = text.str();
  return mesh;
}

PlanarMesh make_mesh(const StudyMesh& description, double edge_scale,
                     const std::filesystem::path& mesh_dir, std::string& origin) {
  if (!mesh_dir.empty() && !description.published_file.empty()) {
    origin = (mesh_dir / description.published_file).string();
    return read_valid_mesh(origin);
  }
  if (!description.file.empty()) {
    origin = description.file.string();
    return distorted(read_valid_mesh(description.file), description, origin);
  }
  if (description.domain.empty())
    throw InputError("mesh " + description.name +
                     " has neither a file nor a domain; set one of them in its subsection");
  origin = "generated " + description.domain + " of " +
           std::string(name_of(description.element_type)) + "s";
  return distorted(std::get<PlanarMesh>(find_domain(description.domain)
                                            .generate({.element_type = description.element_type,
                                                       .edge_scale = edge_scale,
                                                       .seed = description.seed})),
                   description, origin);
}

}  // namespace

PreparedMesh prepare_mesh(const StudyMesh& description, double edge_scale,
                          const std::filesystem::path& mesh_dir) {
  std::string origin;
  PlanarMesh mesh = make_mesh(description, edge_scale, mesh_dir, origin);
  const MeshQuality quality = mesh_quality(mesh);
  return {description, std::move(mesh), quality, origin,
          !mesh_dir.empty() && !description.published_file.empty()};
}

}  // namespace smoothfem
