// SPDX-License-Identifier: GPL-3.0-or-later
/// Tests the findings in meshes, and their repair.
#include "meshes/doctor/examine.h"
#include "meshes/doctor/examine_boundary.h"
#include "meshes/doctor/repair.h"
#include "meshes/io/mesh_view.h"
#include "meshes/tests/faulty_meshes.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using test::mirror;
using test::octree;
using test::quadtree;
using test::sick_parts;
using test::unit_square;
using test::with_seam;
using ::testing::HasSubstr;

std::vector<FindingKind> kinds_in(const MeshParts& parts) {
  std::vector<FindingKind> kinds;
  for (const auto& finding : examine(parts).findings) kinds.push_back(finding.kind);
  return kinds;
}

/// Returns the only finding; fails if there are others.
Finding only_finding(const MeshParts& parts) {
  const auto findings = examine(parts).findings;
  EXPECT_EQ(findings.size(), 1u);
  return findings.empty() ? Finding{} : findings.front();
}

std::vector<std::pair<std::string, AnyMesh>> small_meshes() {
  std::vector<std::pair<std::string, AnyMesh>> all;
  for (auto& [name, mesh] : test::regular_topologies<2>()) all.emplace_back(name, mesh);
  for (auto& [name, mesh] : test::regular_topologies<3>()) all.emplace_back(name, mesh);
  return all;
}

TEST(Doctor, FindsNothingInSoundMeshesOfEveryElementType) {
  for (const auto& [name, mesh] : small_meshes()) {
    SCOPED_TRACE(name);
    const MeshParts parts = sick_parts(mesh);
    EXPECT_THAT(kinds_in(parts), ::testing::IsEmpty());
    EXPECT_EQ(examine(parts).n_pieces, 1u);
    const MeshFile file = assemble_mesh("m", parts);
    EXPECT_THAT(file.notes, ::testing::IsEmpty());
    EXPECT_EQ(MeshView(file.mesh).topology().cells(), MeshView(mesh).topology().cells());
  }
}

TEST(Doctor, ReadingTurnsOverMirroredCellsOfEveryElementType) {
  for (const auto& [name, mesh] : small_meshes()) {
    SCOPED_TRACE(name);
    const std::size_t n = MeshView(mesh).n_cells();
    std::vector<CellIndex> some, all;
    for (CellIndex c = 0; c < n; ++c) {
      if (c % 3 == 1) some.push_back(c);
      all.push_back(c);
    }
    for (const auto& which : {some, all}) {
      MeshParts parts = sick_parts(mesh);
      mirror(parts, which);
      const Finding finding = only_finding(parts);
      EXPECT_EQ(finding.kind, FindingKind::reversed_cells);
      EXPECT_EQ(finding.count, which.size());
      EXPECT_EQ(finding.cell, which.front());
      const MeshFile file = assemble_mesh("m", parts);
      ASSERT_EQ(file.notes.size(), 1u);
      EXPECT_THAT(file.notes[0], HasSubstr("turned over " + std::to_string(which.size()) + " of"));
      std::visit([](const auto& m) { EXPECT_EQ(mesh_quality(m).n_invalid, 0u); }, file.mesh);
      const MeshFile kept = assemble_mesh("m", parts, {.turns_over = false});
      EXPECT_EQ(MeshView(kept.mesh).topology().cells(), parts.elements[dimension_of(parts)].nodes);
    }
  }
}

TEST(Doctor, LabelsStayWithCellsThatAreTurnedOver) {
  MeshParts parts = sick_parts(2, unit_square, {{0, 1, 2}, {0, 3, 2}});
  parts.elements[2].tags = {5, 6};
  parts.elements[2].ids = {10, 20};
  parts.elements[2].lines = {7, 8};
  parts.elements[1].nodes = test::rows_of({{2, 3}});
  parts.elements[1].tags = {9};
  const MeshFile file = assemble_mesh("m", parts);
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_THAT(file.notes[0], HasSubstr("cell 20 (line 8) at (0, 0)"));
  const auto& labels = MeshView(file.mesh).topology().labels();
  EXPECT_EQ(labels.cell_tags, (std::vector<int>{5, 6}));
  EXPECT_EQ(labels.facet_tags, std::vector<int>{9});
}

TEST(Doctor, FoldedCellsAreNotTurnedOver) {
  // The fifth node lies outside, so that one cell is folded. Another one is mirrored.
  auto x = unit_square;
  x.emplace_back(0.5, 1.5, 0.0);
  MeshParts parts = sick_parts(2, x, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {0, 3, 4}});
  const auto findings = examine(parts).findings;
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].kind, FindingKind::reversed_cells);
  EXPECT_EQ(findings[0].cell, 3u);
  EXPECT_EQ(findings[1].kind, FindingKind::folded_cells);
  EXPECT_EQ(findings[1].count, 1u);
  EXPECT_EQ(findings[1].cell, 2u);
  EXPECT_FALSE(findings[1].is_repairable);
}

TEST(Doctor, FindsCellsThatMidsideNodesBendTooMuch) {
  // Two triangles TRI6 of the unit square; the diagonal's midside node moves along its normal.
  const auto with_diagonal_at = [](double t) {
    auto x = unit_square;
    x.insert(x.end(), {{0.5, 0, 0}, {1, 0.5, 0}, {0.5 + t, 0.5 - t, 0}, {0.5, 1, 0}, {0, 0.5, 0}});
    MeshParts parts = sick_parts(2, x, {{0, 1, 2}, {0, 2, 3}});
    parts.elements[2].midside = test::rows_of({{4, 5, 6}, {6, 7, 8}});
    return parts;
  };
  EXPECT_TRUE(examine(with_diagonal_at(0.1)).findings.empty());
  const Finding finding = only_finding(with_diagonal_at(0.3));
  EXPECT_EQ(finding.kind, FindingKind::bent_cells);
  EXPECT_EQ(finding.count, 1u);
  EXPECT_EQ(finding.cell, 0u);
  // A linear neighbour does not follow.
  MeshParts mixed = with_diagonal_at(0.1);
  mixed.elements[2].midside = test::rows_of({{4, 5, 6}, {}});
  mixed.coordinates.resize(7);
  EXPECT_EQ(only_finding(mixed).kind, FindingKind::straight_sides);
  EXPECT_EQ(only_finding(mixed).cell, 1u);
  mixed.coordinates[6] = {0.5, 0.5, 0};
  EXPECT_TRUE(examine(mixed).findings.empty());
}

TEST(Doctor, TheSmallerPartOfASurfaceIsTurnedOver) {
  auto x = unit_square;
  x.emplace_back(0.5, 0.5, 1.0);
  const MeshParts parts = sick_parts(2, x, {{0, 1, 4}, {2, 1, 4}, {2, 3, 4}, {3, 0, 4}});
  EXPECT_EQ(only_finding(parts).cell, 1u);
  const MeshFile file = assemble_mesh("m", parts);
  EXPECT_EQ(file.notes.size(), 1u);
  EXPECT_TRUE(std::ranges::equal(MeshView(file.mesh).topology().cell_nodes(1),
                                 std::vector<NodeIndex>{2, 4, 1}));
}

TEST(Doctor, AMoebiusStripHasOneSide) {
  const MeshParts parts =
      sick_parts(2, {{2, 0, 1}, {2, 0, -1}, {-1, 2, 1}, {-1, 1, -1}, {-1, -2, 1}, {-1, -1, -1}},
                 {{0, 1, 3, 2}, {2, 3, 5, 4}, {4, 5, 0, 1}});
  EXPECT_THAT(kinds_in(parts), ::testing::Contains(FindingKind::one_sided));
}

TEST(Doctor, FindsHangingNodesInThePlane) {
  for (const int n : {2, 3}) {
    SCOPED_TRACE(n);
    const Finding finding = only_finding(quadtree(n));
    EXPECT_EQ(finding.kind, FindingKind::hanging_nodes);
    EXPECT_EQ(finding.count, static_cast<std::size_t>(n - 1));
    EXPECT_EQ(finding.node, 5u);
    EXPECT_EQ(finding.cell, 0u);
    EXPECT_EQ(finding.at, Point<3>(1.0, 1.0 / n, 0.0));
  }
  // Triangles; the coordinates have six digits only.
  const MeshParts triangles = sick_parts(
      2, {{0, 0, 0}, {0.7, 0.1, 0}, {0.333333, 0.9, 0}, {0.233333, 0.033333, 0}, {0.3, -0.8, 0}},
      {{0, 1, 2}, {4, 3, 0}, {4, 1, 3}});
  EXPECT_EQ(only_finding(triangles).kind, FindingKind::hanging_nodes);
}

TEST(Doctor, FindsHangingNodesInSpace) {
  for (const auto kind : {test::BoxCells::tetrahedra, test::BoxCells::pyramids,
                          test::BoxCells::prisms, test::BoxCells::hexahedra}) {
    SCOPED_TRACE(test::name_of(kind));
    const Finding two = only_finding(octree(2, kind));
    EXPECT_EQ(two.kind, FindingKind::hanging_nodes);
    EXPECT_EQ(two.count, 5u);
    EXPECT_EQ(only_finding(octree(3, kind)).count, 12u);
  }
}

TEST(Doctor, FindsHangingNodesOnWarpedFaces) {
  MeshParts parts = octree(4, test::BoxCells::hexahedra);
  for (auto& p : parts.coordinates) p.z() += 0.2 * p.x() * p.y();
  EXPECT_EQ(only_finding(parts).count, 21u);
}

TEST(Doctor, FindsAndMergesCoincidentNodes) {
  const MeshParts planar = with_seam(test::grid_mesh(2, test::GridCells::triangles), 2.0);
  const Finding in_plane = only_finding(planar);
  EXPECT_EQ(in_plane.kind, FindingKind::coincident_nodes);
  EXPECT_EQ(in_plane.count, 3u);
  EXPECT_THAT(in_plane.sentence, HasSubstr("2 pairs of edges form a seam"));
  const MeshParts boxes = with_seam(test::box_mesh(1, 1, 1, test::BoxCells::hexahedra), 1.0);
  const Finding in_space = only_finding(boxes);
  EXPECT_EQ(in_space.count, 4u);
  EXPECT_THAT(in_space.sentence, HasSubstr("1 pair of faces form a seam"));
  for (MeshParts parts : {planar, boxes}) {
    EXPECT_EQ(examine(parts).n_pieces, 2u);
    const MeshFile merged = assemble_mesh("m", parts, {.merges = true});
    EXPECT_EQ(merged.notes.size(), 1u);
    const std::size_t n_before = parts.coordinates.size();
    EXPECT_EQ(repair(parts).size(), 1u);
    EXPECT_LT(parts.coordinates.size(), n_before);
    EXPECT_EQ(MeshView(merged.mesh).n_nodes(), parts.coordinates.size());
    EXPECT_THAT(kinds_in(parts), ::testing::IsEmpty());
    EXPECT_EQ(examine(parts).n_pieces, 1u);
  }
}

TEST(Doctor, FlatCellsAndNearNodesOfOneCellDoNotCoincide) {
  const double tiny = 1e-11;  // a layer of cells that are so thin
  MeshParts parts =
      sick_parts(2, {{0, 0, 0}, {1, 0, 0}, {1, tiny, 0}, {0, tiny, 0}, {1, 1, 0}, {0, 1, 0}},
                 {{0, 1, 2, 3}, {3, 2, 4, 5}});
  EXPECT_THAT(kinds_in(parts), ::testing::IsEmpty());
}

TEST(Doctor, FindsPiecesThatTouch) {
  const MeshParts planar = sick_parts(2, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                                      {{0, 1, 2}, {0, 3, 4}});
  EXPECT_EQ(only_finding(planar).kind, FindingKind::touching_nodes);
  EXPECT_EQ(only_finding(planar).node, 0u);
  // Two cubes with an edge in common, and two with a node.
  for (const bool edge : {true, false}) {
    const Point<3> shift(1.0, 1.0, edge ? 0.0 : 1.0);
    MeshParts parts = sick_parts(test::box_mesh(1, 1, 1, test::BoxCells::hexahedra));
    std::vector<NodeIndex> cell;
    const auto nodes = parts.elements[3].nodes[0];
    for (const NodeIndex i : nodes) {
      const Point<3> p = parts.coordinates[i] + shift;
      const auto same = std::find(parts.coordinates.begin(), parts.coordinates.end(), p);
      cell.push_back(static_cast<NodeIndex>(same - parts.coordinates.begin()));
      if (same == parts.coordinates.end()) parts.coordinates.push_back(p);
    }
    parts.elements[3].nodes.append(cell);
    const Finding finding = only_finding(parts);
    EXPECT_EQ(finding.kind, edge ? FindingKind::touching_edges : FindingKind::touching_nodes);
    EXPECT_EQ(finding.count, 1u);
  }
}

TEST(Doctor, FindsCellsAndNodesOfWhichNoMeshIsMade) {
  auto x = unit_square;
  x.emplace_back(0.5, -1.0, 0.0);
  x.emplace_back(7.0, 7.0, 0.0);
  x.emplace_back(0.4, 2.0, 0.0);
  MeshParts parts = sick_parts(2, x, {{0, 1, 2}, {0, 2, 3}, {2, 0, 1}, {0, 2, 6}, {0, 4, 4, 1}});
  EXPECT_THAT(kinds_in(parts),
              ::testing::ElementsAre(FindingKind::collapsed_cells, FindingKind::doubled_cells,
                                     FindingKind::unused_nodes, FindingKind::crowded_facets));
  EXPECT_EQ(examine(parts).findings[2].node, 5u);
  EXPECT_THAT(input_error_of([&] { assemble_mesh("m", parts); }), HasSubstr("more than once"));
  const MeshParts faces =
      sick_parts(3, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 1, 2}},
                 {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}});
  EXPECT_EQ(only_finding(faces).kind, FindingKind::crowded_facets);
}

TEST(Doctor, RefusesDataThatNoCellsHave) {
  MeshParts parts = sick_parts(2, unit_square, {{0, 1, 4}});
  EXPECT_THAT(input_error_of([&] { examine(parts); }), HasSubstr("names node 4"));
  EXPECT_THAT(input_error_of([&] { examine(MeshParts{}); }), HasSubstr("no cells"));
  parts.coordinates[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(input_error_of([&] { repair(parts); }), HasSubstr("not a finite number"));
}

TEST(Doctor, TakesPlanarMeshesInAnyPlane) {
  MeshParts parts = sick_parts(test::grid_mesh(3, test::GridCells::quadrilaterals));
  for (auto& p : parts.coordinates) p = Point<3>(p.x(), 0.3 * p.x() + 2.0, p.y());
  parts.coordinates.emplace_back(1, 2.3, 9);  // belongs to no cell
  lay_into_plane(parts);
  EXPECT_EQ(examine(parts).mesh_kind, "planar");
  const Finding unused = only_finding(parts);
  EXPECT_EQ(unused.kind, FindingKind::unused_nodes);
  EXPECT_LT((unused.at - Point<3>(1, 2.3, 9)).norm(), 1e-14);
  EXPECT_THAT(unused.sentence, HasSubstr("at (1, 2.3, 9)"));
  parts.coordinates[5].z() += 0.1;
  EXPECT_EQ(examine(parts).mesh_kind, "surface");
}

TEST(Doctor, SaysIfADoubledCellHasAnotherTag) {
  MeshParts parts = sick_parts(2, unit_square, {{0, 1, 2}, {0, 2, 3}, {1, 2, 0}, {3, 0, 2}});
  parts.elements[2].tags = {1, 1, 1, 7};
  EXPECT_THAT(repair(parts),
              ::testing::ElementsAre(HasSubstr("removed 2 cells"),
                                     HasSubstr("1 of the removed cells has another tag")));
}

TEST(Doctor, RepairsAllAtOnceAndKeepsWhatTheFileSays) {
  auto x = unit_square;
  x.insert(x.end(), {{9, 9, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}});
  MeshParts parts = sick_parts(2, x, {{0, 1, 2, 3}, {1, 2, 3, 0}, {5, 8, 7, 6}});
  parts.node_ids = {10, 11, 12, 13, 14, 15, 16, 17, 18};
  parts.elements[2].tags = {1, 2, 3};
  parts.elements[2].ids = {21, 22, 23};
  parts.elements[1].nodes = test::rows_of({{1, 2}, {8, 5}, {6, 7}});
  parts.elements[1].tags = {4, 4, 5};
  parts.fixed = std::vector<bool>{true, false, false, false, false, true, false, false, false};
  EXPECT_EQ(repair(parts).size(), 5u);
  EXPECT_EQ(parts.node_ids, (std::vector<std::size_t>{10, 11, 12, 13, 16, 17}));
  EXPECT_EQ(*parts.fixed, (std::vector<bool>{true, true, false, false, false, false}));
  EXPECT_EQ(parts.elements[2].tags, (std::vector<int>{1, 3}));
  EXPECT_EQ(parts.elements[2].ids, (std::vector<std::size_t>{21, 23}));
  EXPECT_EQ(parts.elements[2].nodes, test::rows_of({{0, 1, 2, 3}, {1, 4, 5, 2}}));
  EXPECT_EQ(parts.elements[1].tags, (std::vector<int>{4, 5}));
  EXPECT_THAT(kinds_in(parts), ::testing::IsEmpty());
}

TEST(Doctor, NodesOfSeamsAreMarked) {
  const MeshFile file = assemble_mesh("m", quadtree(2));
  const auto seen = examine_boundary(std::get<PlanarMesh>(file.mesh));
  ASSERT_EQ(seen.findings.size(), 1u);
  EXPECT_THAT(seen.findings[0].sentence, HasSubstr("1 hanging node lies inside an edge"));
  EXPECT_EQ(seen.seam_nodes,
            (std::vector<bool>{false, true, true, false, false, true, false, false}));
  EXPECT_THROW(require_conforming(std::get<PlanarMesh>(file.mesh), "m", false), InputError);
  EXPECT_EQ(require_conforming(std::get<PlanarMesh>(file.mesh), "m", true), seen.seam_nodes);
  const auto octree_mesh = assemble_mesh("m", octree(2, test::BoxCells::tetrahedra)).mesh;
  EXPECT_EQ(examine_boundary(std::get<VolumeMesh>(octree_mesh)).findings.size(), 1u);
}

}  // namespace
}  // namespace smoothfem
