// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/bench/volume_meshes.h"

#include <gmsh.h>

#include <iostream>

#include "meshes/distortion/distort.h"
#include "meshes/domains/catalogue.h"
#include "meshes/io/mesh_file.h"
#include "meshes/tools/gmsh_session.h"
#include "meshes/tools/sweep.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem::bench {

namespace {

void generate_bored_cube(const std::filesystem::path& path) {
  std::cerr << "generating " << path << '\n';
  GmshSession session;
  constexpr double size = 0.0192;
  session.set_option("Mesh.MeshSizeMin", size);
  session.set_option("Mesh.MeshSizeMax", size);
  session.set_option("Mesh.MshFileVersion", 4.1);
  session.set_option("Mesh.Binary", 1);
  session.run("cannot mesh the cube", [&] {
    gmsh::model::add("cube");
    const int cube = gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1);
    const int bore = gmsh::model::occ::addCylinder(0.5, 0.5, -0.5, 0, 0, 2, 0.2);
    gmsh::vectorpair result;
    std::vector<gmsh::vectorpair> map;
    gmsh::model::occ::cut({{3, cube}}, {{3, bore}}, result, map);
    gmsh::model::occ::synchronize();
    gmsh::model::mesh::generate(3);
    gmsh::write(path.string());
  });
}

/// Reads the mesh from a file; makes the file first if it is missing.
template <class Make>
VolumeMesh kept(const std::string& name, const Make& make) {
  const auto path = std::filesystem::temp_directory_path() / ("smoothfem_bench_" + name);
  if (!std::filesystem::exists(path)) make(path);
  return std::get<VolumeMesh>(read_mesh(path).mesh);
}

DistortionParameters sweeps(int n) {
  DistortionParameters parameters;
  parameters.n_candidates = 15;
  parameters.n_sweeps = n;
  return parameters;
}

}  // namespace

VolumeMesh swept_gear(bool distorted) {
  const auto gear =
      std::get<PlanarMesh>(find_domain("gear").generate({.elements = "quadrilaterals"}));
  std::vector<double> heights;
  for (int layer = 0; layer <= 11; ++layer) heights.push_back(0.2 * layer);
  const VolumeCells swept = sweep(cells_of(gear), heights);
  VolumeMesh mesh = test::make_volume_mesh(swept.coordinates, swept.cells);
  if (!distorted) return mesh;
  return kept("swept_gear_distorted.vtu", [&](const auto& path) {
    distort_within(mesh, 0.9, sweeps(1));
    write_mesh(path, mesh);
  });
}

VolumeMesh bored_cube(bool distorted) {
  VolumeMesh mesh = kept("bored_cube.msh", generate_bored_cube);
  if (!distorted) return mesh;
  return kept("bored_cube_distorted.vtu", [&](const auto& path) {
    distort_within(mesh, 0.65, sweeps(2));
    write_mesh(path, mesh);
  });
}

VolumeMesh kuhn_cube(std::uint32_t n) {
  return test::box_mesh(n, n, n, test::BoxCells::tetrahedra);
}

}  // namespace smoothfem::bench
