// SPDX-License-Identifier: GPL-3.0-or-later
// All processes together find what one finds in the whole mesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "distributed/examine_parts.h"
#include "distributed/files/pieces.h"
#include "distributed/files/split.h"
#include "distributed/tests/folder.h"
#include "fem/tests/all_ranks.h"
#include "meshes/tests/faulty_meshes.h"

namespace smoothfem {
namespace {

using test::all_ranks;
using test::BoxCells;
using test::GridCells;
using test::octree;
using test::quadtree;
using test::sick_parts;
using test::with_seam;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Spreads the cells of a file's data over the ranks without order.
template <int dim>
ScatteredMesh<dim> spread(const MeshParts& parts, bool is_compact) {
  const auto& cells = parts.elements[dim].nodes;
  ScatteredMesh<dim> result{
      .n_cells = cells.size(),
      .nodes = NodeDirectory<NodeEntry<dim>>(all_ranks(), parts.coordinates.size()),
      .is_compact = is_compact};
  const auto n_ranks = static_cast<std::size_t>(all_ranks().size());
  for (CellIndex c = 0; c < cells.size(); ++c)
    if ((c * 7 + c / 3) % n_ranks == static_cast<std::size_t>(all_ranks().rank()))
      result.cells.append(c, 0, cells[c]);
  std::vector<GlobalIndex> numbers;
  std::vector<NodeEntry<dim>> entries;
  for (NodeIndex i = 0; i < parts.coordinates.size(); ++i) {
    numbers.push_back(i);
    entries.push_back(node_entry<dim>(parts.coordinates[i].head<dim>(), 0));
  }
  result.nodes.give(numbers, entries,
                    [](NodeEntry<dim>& kept, const NodeEntry<dim>& node, int) { kept = node; });
  return result;
}

void expect_same(const Examination& found, const Examination& expected) {
  ASSERT_EQ(found.findings.size(), expected.findings.size());
  if (!all_ranks().is_root()) return;
  EXPECT_EQ(found.mesh_kind, expected.mesh_kind);
  EXPECT_EQ(found.n_nodes, expected.n_nodes);
  EXPECT_EQ(found.n_cells, expected.n_cells);
  EXPECT_EQ(found.n_pieces, expected.n_pieces);
  for (std::size_t k = 0; k < found.findings.size(); ++k) {
    const Finding &a = found.findings[k], &b = expected.findings[k];
    EXPECT_EQ(a.sentence, b.sentence);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.count, b.count);
    EXPECT_EQ(a.at, b.at);
    EXPECT_EQ(a.cell, b.cell);
    EXPECT_EQ(a.node, b.node);
    EXPECT_EQ(a.is_repairable, b.is_repairable);
  }
  EXPECT_TRUE(found.not_looked_for.empty());
}

template <int dim>
Examination examined(const MeshParts& parts, bool is_compact = true) {
  return examine_parts<dim>(all_ranks(), spread<dim>(parts, is_compact));
}

/// The kinds of faults are those of the whole mesh, which are returned.
std::vector<FindingKind> kinds_in(const MeshParts& parts) {
  const Examination whole = examine(parts);
  for (const bool is_compact : {true, false})
    expect_same(
        dimension_of(parts) == 3 ? examined<3>(parts, is_compact) : examined<2>(parts, is_compact),
        whole);
  std::vector<FindingKind> kinds;
  for (const Finding& finding : whole.findings) kinds.push_back(finding.kind);
  return kinds;
}

TEST(ExamineParts, FindsNothingInSoundMeshes) {
  for (const auto kind : {GridCells::triangles, GridCells::quadrilaterals, GridCells::mixed})
    EXPECT_THAT(kinds_in(sick_parts(test::grid_mesh(5, kind))), testing::IsEmpty());
  for (const auto kind : {BoxCells::tetrahedra, BoxCells::hexahedra, BoxCells::mixed})
    EXPECT_THAT(kinds_in(sick_parts(test::box_mesh(3, 2, 4, kind))), testing::IsEmpty());
}

TEST(ExamineParts, FindsCellsInTheWrongDirection) {
  for (const MeshParts& sound : {sick_parts(test::grid_mesh(5, GridCells::mixed)),
                                 sick_parts(test::box_mesh(3, 2, 4, BoxCells::mixed)),
                                 sick_parts(test::box_mesh(2, 2, 2, BoxCells::tetrahedra))}) {
    std::vector<CellIndex> some, all;
    for (CellIndex c = 0; c < sound.elements[dimension_of(sound)].nodes.size(); ++c) {
      if (c % 3 == 1) some.push_back(c);
      all.push_back(c);
    }
    for (const auto& which : {some, all}) {
      MeshParts parts = sound;
      test::mirror(parts, which);
      EXPECT_THAT(kinds_in(parts), testing::ElementsAre(FindingKind::reversed_cells));
    }
  }
  // The fifth node lies outside, so that one cell is folded. Another one is mirrored.
  auto x = test::unit_square;
  x.emplace_back(0.5, 1.5, 0.0);
  EXPECT_THAT(kinds_in(sick_parts(2, x, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {0, 3, 4}})),
              testing::ElementsAre(FindingKind::reversed_cells, FindingKind::folded_cells));
  // A Moebius strip, laid flat.
  EXPECT_THAT(kinds_in(sick_parts(
                  2, {{2, 1, 0}, {3, 0, 0}, {-1, 2, 0}, {-1, 1, 0}, {-1, -2, 0}, {0, -1, 0}},
                  {{0, 1, 3, 2}, {2, 3, 5, 4}, {4, 5, 0, 1}})),
              testing::Contains(FindingKind::one_sided));
}

TEST(ExamineParts, FindsWhatDoesNotFitTogether) {
  for (const int n : {2, 3})
    EXPECT_THAT(kinds_in(quadtree(n)), testing::ElementsAre(FindingKind::hanging_nodes));
  for (const auto kind : {BoxCells::tetrahedra, BoxCells::hexahedra})
    EXPECT_THAT(kinds_in(octree(3, kind)), testing::ElementsAre(FindingKind::hanging_nodes));
  EXPECT_THAT(kinds_in(with_seam(test::grid_mesh(4, GridCells::triangles), 4.0)),
              testing::ElementsAre(FindingKind::coincident_nodes));
  EXPECT_THAT(kinds_in(with_seam(test::box_mesh(3, 3, 3, BoxCells::tetrahedra), 3.0)),
              testing::ElementsAre(FindingKind::coincident_nodes));
  EXPECT_THAT(
      kinds_in(sick_parts(2, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {9, 9, 0}},
                          {{0, 1, 2}, {0, 3, 4}})),
      testing::ElementsAre(FindingKind::unused_nodes, FindingKind::touching_nodes));
  MeshParts touching = sick_parts(test::box_mesh(3, 3, 3, BoxCells::hexahedra));
  test::Cells two;
  for (const CellIndex c : {0u, 4u, 13u, 26u}) {
    const auto nodes = touching.elements[3].nodes[c];
    two.emplace_back(nodes.begin(), nodes.end());
  }
  touching.elements[3].nodes = test::rows_of(two);
  EXPECT_THAT(kinds_in(touching),
              testing::IsSupersetOf({FindingKind::unused_nodes, FindingKind::touching_edges,
                                     FindingKind::touching_nodes}));
}

TEST(ExamineParts, FindsCellsOfWhichNoMeshIsMade) {
  auto x = test::unit_square;
  x.insert(x.end(), {{0.5, -1.0, 0.0}, {7.0, 7.0, 0.0}, {0.4, 2.0, 0.0}});
  EXPECT_THAT(
      kinds_in(sick_parts(2, x, {{0, 1, 2}, {0, 2, 3}, {2, 0, 1}, {0, 2, 6}, {0, 4, 4, 1}})),
      testing::ElementsAre(FindingKind::collapsed_cells, FindingKind::doubled_cells,
                           FindingKind::unused_nodes, FindingKind::crowded_facets));
  EXPECT_THAT(
      kinds_in(sick_parts(3, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 1, 2}},
                          {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}})),
      testing::ElementsAre(FindingKind::crowded_facets));
  // Cells appear again far away in the file.
  MeshParts parts = sick_parts(test::box_mesh(3, 3, 3, BoxCells::tetrahedra));
  const auto cells = parts.elements[3].nodes;
  for (std::size_t c = 3; c < cells.size(); c += 5) {
    std::vector<NodeIndex> turned(cells[c].begin(), cells[c].end());
    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    parts.elements[3].nodes.append(turned);
  }
  EXPECT_THAT(kinds_in(parts), testing::ElementsAre(FindingKind::doubled_cells));
}

/// Random cells have all faults at once, in all places.
TEST(ExamineParts, FindsTheFaultsOfRandomCells) {
  std::mt19937 random(7);
  const auto below = [&](std::size_t n) { return static_cast<NodeIndex>(random() % n); };
  std::set<FindingKind> found;
  for (int k = 0; k < 60; ++k) {
    const int dim = 2 + k % 2;
    const std::size_t n_nodes = 8 + below(40), n_cells = 1 + below(40);
    std::vector<Point<3>> x;
    for (std::size_t i = 0; i < n_nodes; ++i)
      x.emplace_back(below(5), below(5), dim == 3 ? below(5) : 0);
    test::Cells cells;
    for (std::size_t c = 0; c < n_cells; ++c) {
      const std::size_t n = dim == 2 ? 3 + below(3) : std::array{4u, 5u, 6u, 8u}[below(4)];
      auto& cell = cells.emplace_back();
      for (std::size_t i = 0; i < n; ++i) cell.push_back(below(n_nodes));
      if (c > 0 && below(6) == 0) cell = cells[below(c)];
    }
    SCOPED_TRACE(k);
    for (const FindingKind kind : kinds_in(sick_parts(dim, x, cells))) found.insert(kind);
  }
  EXPECT_EQ(found.size(), 10u);  // all but those of second order and of surfaces
}

TEST(ExamineParts, RefusesCoordinatesAndCellsOfNoMesh) {
  MeshParts parts = sick_parts(2, test::unit_square, {{0, 1, 2}, {0, 2, 3}});
  parts.coordinates[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { examined<2>(parts); },
              ThrowsMessage<InputError>(HasSubstr("node 3 has the coordinate nan")));
  const MeshParts line = sick_parts(2, test::unit_square, {{0, 1, 2}, {0, 2}});
  EXPECT_THAT([&] { examined<2>(line); },
              ThrowsMessage<InputError>(HasSubstr("cell 1 has 2 nodes, which no cell can have")));
  auto twice = spread<2>(sick_parts(2, test::unit_square, {{0, 1, 2}, {0, 2, 3}}), true);
  for (GlobalIndex& number : twice.cells.numbers) number = 4;
  EXPECT_THAT([&] { examine_parts(all_ranks(), std::move(twice)); },
              ThrowsMessage<InputError>(HasSubstr("1 cell has the number of another cell")));
}

Examination examined_file(const std::filesystem::path& path) {
  auto read = Pieces(all_ranks(), path).read(ReadFor::examination);
  return std::visit([](auto& mesh) { return examine_parts(all_ranks(), std::move(mesh)); }, read);
}

/// Numbers are those of the file, as for one process, also of a node that no element has.
TEST(ExamineParts, NamesTheNumbersOfTheFile) {
  const test::Folder folder;
  const auto box = test::box_mesh(3, 2, 4, BoxCells::tetrahedra);
  MeshParts parts = sick_parts(box);
  parts.coordinates.emplace_back(9, 9, 9);
  parts.coordinates[box.n_nodes() / 2] += Point<3>(2, 0, 0);
  MeshLabels labels;
  for (std::size_t i = 0; i < parts.coordinates.size(); ++i)
    labels.node_ids.push_back(3 + 2 * i + i % 2 * 5);
  for (std::size_t c = 0; c < box.n_cells(); ++c)
    labels.cell_ids.push_back(2 * ((c * 7) % box.n_cells()) + 10);
  const VolumeMesh mesh(
      std::make_shared<const Topology>(3, parts.coordinates.size(), box.topology().cells(),
                                       std::nullopt, std::move(labels)),
      parts.coordinates);
  all_ranks().on_root([&] {
    write_mesh(folder / "text.msh", mesh, {}, {.binary = false});
    write_mesh(folder / "blocks.msh", mesh, {}, {.binary = true});
    write_mesh(folder / "whole.vtu", mesh);
    VolumeMesh bare(std::make_shared<const Topology>(3, box.n_nodes(), box.topology().cells()),
                    {parts.coordinates.begin(), parts.coordinates.end() - 1});
    write_mesh(folder / "bare.vtu", bare);
    write_in_pieces(bare, 3, folder / "pieces.pvtu");
  });
  for (const char* name : {"text.msh", "blocks.msh", "whole.vtu", "bare.vtu", "pieces.pvtu"}) {
    SCOPED_TRACE(name);
    const auto whole = std::string(name) == "pieces.pvtu" ? "bare.vtu" : name;
    const Examination expected = examine(read_mesh_parts(folder / whole));
    EXPECT_FALSE(expected.findings.empty());
    expect_same(examined_file(folder / name), expected);
  }
}

}  // namespace
}  // namespace smoothfem
