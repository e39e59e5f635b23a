// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <sstream>

#include "meshes/io/mesh_file.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/tests/shared_mesh.h"

namespace smoothfem {
namespace {

/// Third-party meshes, if available, are next to the repository.
class SharedMeshes : public FileTest {
 protected:
  static std::filesystem::path shared(const std::string& name) { return test::shared_mesh(name); }

  void SetUp() override {
    for (const std::string name :
         {"gear_quad_initial.mesh", "gear_tri_initial.mesh", "hex_rockerarm_10600.mesh",
          "mixed2d_overture_tri382_quad4831.vtk", "mixed_hex_tet_pri_pyr_1622.vtk",
          "simple_mixed_planar_polygonal.mesh", "tet_sphere_24013.mesh"})
      if (shared(name).empty()) GTEST_SKIP() << test::how_to_get(name);
  }
};

TEST_F(SharedMeshes, ReproducesThePrintedMeanRatios) {
  for (const std::string name :
       {"simple_mixed_planar_polygonal.mesh", "gear_tri_initial.mesh", "gear_quad_initial.mesh"}) {
    const PlanarMesh mesh = read_planar(shared(name)).mesh;
    const std::string content = content_of(shared(name));
    std::istringstream printed(content.substr(content.find("polygon_mean_ratio")));
    std::string keyword;
    std::size_t n = 0;
    printed >> keyword >> n;
    ASSERT_EQ(n, mesh.n_cells());
    // Nearly flat cells lose digits in the differences of their coordinates, in the thesis and
    // here.
    const double tolerance = name.starts_with("simple") ? 1e-15 : 1e-13;
    for (CellIndex c = 0; c < n; ++c) {
      double expected = 0.0;
      printed >> expected;
      ASSERT_NEAR(cell_mean_ratio(mesh, c), expected, tolerance) << name << " cell " << c;
    }
  }
}

TEST_F(SharedMeshes, ThePublishedGearsHaveTheirCountsAndQuality) {
  const PlanarFile triangles = read_planar(shared("gear_tri_initial.mesh"));
  EXPECT_EQ(triangles.mesh.n_nodes(), 7660u);
  EXPECT_EQ(triangles.mesh.n_cells(), 14346u);
  EXPECT_EQ(triangles.mesh.topology().free_nodes().size(), 7660u - 982u);
  EXPECT_NEAR(mesh_quality(triangles.mesh).q_mean, 0.36992, 5e-6);
  const PlanarFile quads = read_planar(shared("gear_quad_initial.mesh"));
  EXPECT_NEAR(mesh_quality(quads.mesh).q_mean, 0.41796, 5e-6);
  EXPECT_NO_THROW(require_valid(quads.mesh));
}

TEST_F(SharedMeshes, WritesCoordinatesDigitByDigit) {
  write_mesh(file("again.mesh"), read_planar(shared("gear_tri_initial.mesh")).mesh);
  const std::string published = content_of(shared("gear_tri_initial.mesh"));
  const std::size_t end = published.find("polygon_mean_ratio_quality_numbers");
  EXPECT_EQ(content_of(file("again.mesh")).substr(0, end), published.substr(0, end));
}

TEST_F(SharedMeshes, EveryFormatKeepsTheGear) {
  for (const std::string name : {"gear_tri_initial.mesh", "gear_quad_initial.mesh",
                                 "mixed2d_overture_tri382_quad4831.vtk"}) {
    const PlanarMesh mesh = read_planar(shared(name)).mesh;
    for (const auto& format : mesh_formats()) {
      if (!format.holds_planar_meshes) continue;
      write_mesh(file("copy" + format.extension), mesh);
      expect_same_mesh(read_planar(file("copy" + format.extension)).mesh, mesh);
    }
  }
}

TEST_F(SharedMeshes, MesquitesMixedMeshIsRead) {
  const PlanarFile read = read_planar(shared("mixed2d_overture_tri382_quad4831.vtk"));
  std::size_t n_triangles = 0;
  for (CellIndex c = 0; c < read.mesh.n_cells(); ++c)
    n_triangles += read.mesh.topology().cell_type(c) == ElementType::triangle;
  EXPECT_EQ(n_triangles, 382u);
  EXPECT_EQ(read.mesh.n_cells() - n_triangles, 4831u);
  EXPECT_EQ(mesh_quality(read.mesh).n_invalid, 0u);
}

struct VolumeFile {
  std::string name;
  std::map<ElementType, int> counts;
};

TEST_F(SharedMeshes, VolumeMeshesHaveTheirCountsAndAreValid) {
  for (const auto& [name, counts] :
       {VolumeFile{"mixed_hex_tet_pri_pyr_1622.vtk",
                   {{ElementType::hexahedron, 560},
                    {ElementType::tetrahedron, 703},
                    {ElementType::prism, 323},
                    {ElementType::pyramid, 36}}},
        VolumeFile{"tet_sphere_24013.mesh", {{ElementType::tetrahedron, 24013}}},
        VolumeFile{"hex_rockerarm_10600.mesh", {{ElementType::hexahedron, 10600}}}}) {
    const MeshFile read = read_mesh(shared(name));
    const auto& mesh = std::get<VolumeMesh>(read.mesh);
    std::map<ElementType, int> found;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c) ++found[mesh.topology().cell_type(c)];
    EXPECT_EQ(found, counts) << name;
    EXPECT_NO_THROW(require_valid(mesh, name, read.cell_lines));
    if (name.starts_with("mixed")) {
      EXPECT_NEAR(mesh_quality(mesh).q_min, 0.328, 5e-4);
    }
    for (const auto& format : mesh_formats()) {
      if (!format.holds_volume_meshes) continue;
      write_mesh(file("copy" + format.extension), mesh);
      const MeshFile again = read_mesh(file("copy" + format.extension));
      const auto& copy = std::get<VolumeMesh>(again.mesh);
      EXPECT_EQ(copy.copied_coordinates(), mesh.copied_coordinates()) << name << format.name;
      EXPECT_EQ(mesh_quality(copy).q_min, mesh_quality(mesh).q_min) << name << format.name;
    }
  }
}

}  // namespace
}  // namespace smoothfem
