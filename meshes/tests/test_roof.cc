#include "meshes/generators/roof.h"

#include "meshes/tests/domain_tests.h"
#include "smoothing/surface/node_constraints.h"

namespace smoothfem {
namespace {

std::size_t n_of_kind(const SurfaceMesh& mesh, NodeCarrier::Kind kind) {
  const auto& carriers = mesh.constraints()->carriers();
  return std::count_if(carriers.begin(), carriers.end(),
                       [&](const NodeCarrier& carrier) { return carrier.kind == kind; });
}

TEST(Roof, HasTheCountsAndTheQualityOfTheThesis) {
  const SurfaceMesh mesh = generate_roof();
  EXPECT_EQ(mesh.n_nodes(), 23101u);
  EXPECT_EQ(mesh.n_cells(), 22676u);
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_EQ(quality.n_invalid, 0u);
  EXPECT_NEAR(quality.q_mean, 0.9814, 0.001);
  EXPECT_NEAR(quality.q_star_min, 0.2467, 0.001);
  // Nodes less edges plus cells: a disc with two holes.
  EXPECT_EQ(static_cast<long>(mesh.n_nodes() + mesh.n_cells()) -
                static_cast<long>(mesh.topology().n_edges()),
            -1);
  // Corners: four anchors, and four of each frame. Other boundary nodes move along cables and
  // frames.
  EXPECT_EQ(n_of_kind(mesh, NodeCarrier::corner), 12u);
  EXPECT_EQ(n_of_kind(mesh, NodeCarrier::line), 852u - 12u);
}

TEST(Roof, HasItsPeaksAtTheFrames) {
  const SurfaceMesh mesh = generate_roof(4.0);
  double highest = -1e9, top = -1e9, anchor = 1e9;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    highest = std::max(highest, mesh.coordinates()[i].z());
    if (mesh.constraints()->is_corner(i)) {
      top = std::max(top, mesh.coordinates()[i].z());
      anchor = std::min(anchor, mesh.coordinates()[i].z());
    }
  }
  EXPECT_EQ(top, highest);
  EXPECT_GT(top, anchor + 20.0) << "above 172 edges of length";
}

TEST(Roof, CanBeCoarserAndIsTheSameEveryTime) {
  std::size_t n_cells_before = 22676 / 3;
  for (const double scale : {2.0, 3.0, 4.0}) {
    SCOPED_TRACE(scale);
    const SurfaceMesh mesh = generate_roof(scale);
    EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
    EXPECT_LT(mesh.n_cells(), n_cells_before);
    n_cells_before = mesh.n_cells();
    EXPECT_EQ(generate_roof(scale).coordinates(), mesh.coordinates());
  }
  EXPECT_THROW(generate_roof(0.9), InputError);
  EXPECT_THROW(generate_roof(4.1), InputError);
}

}  // namespace
}  // namespace smoothfem
