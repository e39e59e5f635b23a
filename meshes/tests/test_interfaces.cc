// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tests/mesh_tests.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/mesh/interfaces.h"
#include "smoothing/surface/sliding_boundary.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;

/// The mesh with cells of tag 1 left of the middle and of tag 2 right of it.
template <int dim>
Mesh<dim> with_two_materials(const Mesh<dim>& mesh, double middle, MeshLabels labels = {}) {
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    double x = 0.0;
    for (const NodeIndex i : mesh.topology().cell_nodes(c)) x += mesh.coordinates()[i].x();
    const auto n = static_cast<double>(mesh.topology().cell_nodes(c).size());
    labels.cell_tags.push_back(x / n < middle ? 1 : 2);
  }
  auto topology = std::make_shared<const Topology>(dim, mesh.n_nodes(), mesh.topology().cells(),
                                                   std::nullopt, labels);
  std::vector<FixedReasons> reasons = topology->fixed_reasons();
  add_implied_reasons(*topology, reasons);
  return with_fixed_nodes(Mesh<dim>(topology, mesh.copied_coordinates()), reasons);
}

TEST(Interfaces, NodesBetweenMaterialsStayInEveryKindOfCells) {
  for (const auto kind : {test::BoxCells::tetrahedra, test::BoxCells::pyramids,
                          test::BoxCells::prisms, test::BoxCells::hexahedra}) {
    SCOPED_TRACE(test::name_of(kind));
    const VolumeMesh mesh = with_two_materials(test::box_mesh(4, 2, 2, kind), 2.0);
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      EXPECT_EQ(has(mesh.topology().fixed_reasons(i), FixedReason::interface),
                mesh.coordinates()[i].x() == 2.0)
          << i;
  }
}

TEST(Interfaces, FacetsHaveTheDirectionOfTheLowerMaterial) {
  for (const auto kind :
       {test::BoxCells::tetrahedra, test::BoxCells::prisms, test::BoxCells::hexahedra}) {
    SCOPED_TRACE(test::name_of(kind));
    const VolumeMesh mesh = with_two_materials(test::box_mesh(4, 2, 2, kind), 2.0);
    const Interfaces found = inner_interfaces(mesh.topology());
    EXPECT_EQ(found.facets.size(), kind == test::BoxCells::tetrahedra ? 8u : 4u);
    for (std::size_t f = 0; f < found.facets.size(); ++f) {
      Point<3> area = Point<3>::Zero();
      const auto nodes = found.facets[f];
      for (std::size_t k = 2; k < nodes.size(); ++k)
        area += (mesh.coordinates()[nodes[k - 1]] - mesh.coordinates()[nodes[0]])
                    .cross(mesh.coordinates()[nodes[k]] - mesh.coordinates()[nodes[0]]);
      EXPECT_GT(area.x(), 0.0);
    }
  }
}

TEST(Interfaces, CellsThatShareANodeOnlyMeetThere) {
  // Four squares around the middle, two materials as on a chessboard.
  PlanarMesh mesh = test::grid_mesh(2, test::GridCells::quadrilaterals);
  MeshLabels labels;
  labels.cell_tags = {1, 2, 2, 1};
  const Topology topology(2, mesh.n_nodes(), mesh.topology().cells(), std::nullopt, labels);
  EXPECT_EQ(interface_nodes(topology),
            (std::vector<bool>{false, true, false, true, true, true, false, true, false}));
}

TEST(Interfaces, OfSurfacesStayOrSlideOrAreNone) {
  const PlanarMesh flat = test::grid_mesh(4, test::GridCells::triangles);
  std::vector<Point<3>> points;
  for (const auto& p : flat.coordinates()) points.emplace_back(p.x(), p.y(), 0.1 * p.x() * p.y());
  MeshLabels labels = with_two_materials(flat, 2.0).topology().labels();
  const SurfaceMesh mesh = make_surface_mesh(flat.topology().cells(), points, labels);
  constexpr NodeIndex inner = 12;  // at (2, 2)
  ASSERT_EQ(flat.coordinates()[inner], Point<2>(2, 2));
  const auto reasons = [](const SurfaceMesh& m) { return m.topology().fixed_reasons(inner); };
  const auto kind = [](const SurfaceMesh& m) {
    return m.constraints()->classifications()[inner].kind;
  };
  EXPECT_EQ(reasons(mesh), bit(FixedReason::interface));
  EXPECT_EQ(reasons(with_interface_rule(mesh, InterfaceRule::fixed)), reasons(mesh));
  const SurfaceMesh sliding = with_interface_rule(mesh, InterfaceRule::slide);
  EXPECT_EQ(reasons(sliding), 0);
  EXPECT_EQ(kind(sliding), GeometricClassification::line);
  const SurfaceMesh free = with_interface_rule(mesh, InterfaceRule::free);
  EXPECT_EQ(reasons(free), 0);
  EXPECT_EQ(kind(free), GeometricClassification::patch);
  EXPECT_NE(free.topology().fixed_reasons(0), 0);  // a corner of the boundary
}

TEST(Interfaces, MarksOfAllTheirNodesSayNoMore) {
  const FixedReasons boundary = bit(FixedReason::boundary), interface = bit(FixedReason::interface),
                     marked = bit(FixedReason::marked);
  const std::vector<FixedReasons> of_mesh{boundary, boundary, interface, interface, 0, 0};
  auto reasons = of_mesh;
  add_marks({true, true, true, true, false, true}, reasons);
  EXPECT_EQ(reasons,
            (std::vector<FixedReasons>{boundary, boundary, interface, interface, 0, marked}));
  reasons = of_mesh;
  add_marks({true, true, true, false, false, false}, reasons);
  EXPECT_EQ(reasons, (std::vector<FixedReasons>{boundary, boundary,
                                                static_cast<FixedReasons>(interface | marked),
                                                interface, 0, 0}));
}

TEST(Interfaces, NothingIsImpliedWithoutLabels) {
  const PlanarMesh mesh = test::grid_mesh(2, test::GridCells::quadrilaterals);
  MeshLabels labels;
  labels.cell_tags = {7, 7, 7, 7};
  labels.facets.append(std::vector<NodeIndex>{0, 1});  // of the boundary
  labels.facet_tags = {3};
  const Topology topology(2, mesh.n_nodes(), mesh.topology().cells(), std::nullopt, labels);
  EXPECT_TRUE(interface_nodes(topology).empty());
  EXPECT_TRUE(cell_materials(topology).empty());
}

TEST(Interfaces, LabelledInnerFacetsAndPointsStay) {
  const PlanarMesh mesh = test::grid_mesh(4, test::GridCells::quadrilaterals);
  MeshLabels labels;
  labels.facets.append(std::vector<NodeIndex>{6, 7});  // inside
  labels.facet_tags = {3};
  FileContent content;
  content.others[0].nodes.append(std::vector<NodeIndex>{18});
  content.others[0].nodes.append(std::vector<NodeIndex>{17});
  content.others[0].tags = {9, 0};
  labels.content = std::make_shared<const FileContent>(content);
  const Topology topology(2, mesh.n_nodes(), mesh.topology().cells(), std::nullopt, labels);
  const auto flags = interface_nodes(topology);
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    EXPECT_EQ(flags[i], i == 6 || i == 7 || i == 18) << i;
}

TEST(Interfaces, FurtherGroupsOfAnEntityAreMaterials) {
  const PlanarMesh mesh = test::grid_mesh(2, test::GridCells::quadrilaterals);
  MeshLabels labels;
  labels.cell_tags = {3, 3, 3, 3};
  FileContent content;
  content.cell_entities = {1, 2, 2, 1};
  content.entities[{2, 1}].groups = {3};
  content.entities[{2, 2}].groups = {3, 4};
  labels.content = std::make_shared<const FileContent>(content);
  const Topology topology(2, mesh.n_nodes(), mesh.topology().cells(), std::nullopt, labels);
  EXPECT_EQ(cell_materials(topology), (std::vector<int>{0, 1, 1, 0}));
}

TEST(Interfaces, NodesSlideOnAPlaneAndStayAtItsRim) {
  const VolumeMesh mesh =
      with_two_materials(test::box_mesh(4, 3, 3, test::BoxCells::hexahedra), 2.0);
  const VolumeMesh sliding = with_sliding_boundary(mesh, {}, default_slide_distance,
                                                   {.boundary = false, .interfaces = true});
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    EXPECT_EQ(sliding.topology().is_fixed(i), mesh.topology().on_boundary()[i]) << i;
  NodeIndex inner = 0;
  while (mesh.coordinates()[inner] != Point<3>(2.0, 1.0, 1.0)) ++inner;
  const Point<3> to = sliding.constraints()->project(inner, {2.0, 1.0, 1.0}, {2.3, 1.2, 0.9});
  EXPECT_LT((to - Point<3>(2.0, 1.2, 0.9)).norm(), 1e-12);
}

TEST(Interfaces, ReasonsAreCountedAndSaid) {
  const VolumeMesh mesh =
      with_two_materials(test::box_mesh(4, 2, 2, test::BoxCells::hexahedra), 2.0);
  EXPECT_EQ(fixed_reasons_text(mesh.topology()),
            "43 nodes stay: 42 on the boundary, 9 on interfaces between groups");
  const auto freed = without(mesh.topology().fixed_reasons(), bit(FixedReason::interface));
  EXPECT_THAT(fixed_reasons_text(with_fixed_nodes(mesh, freed).topology()),
              HasSubstr("42 nodes stay: 42 on the boundary"));
}

}  // namespace
}  // namespace smoothfem
