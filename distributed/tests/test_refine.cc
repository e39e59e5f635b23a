// SPDX-License-Identifier: GPL-3.0-or-later
// The refined pieces must be those of the whole refined mesh on any number of processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mpi.h>

#include <filesystem>
#include <map>
#include <set>

#include "distributed/files/box.h"
#include "distributed/files/pieces.h"
#include "distributed/files/refine.h"
#include "distributed/files/split.h"
#include "distributed/tests/folder.h"
#include "fem/tests/all_ranks.h"
#include "meshes/io/mesh_file.h"
#include "meshes/refinement/split_cells.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;
using test::all_ranks;
using test::box_mesh;
using test::BoxCells;
using test::content_of;
using test::Folder;
using test::grid_mesh;
using test::GridCells;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::size_t n_pieces = 3;

/// Two materials, three labelled facets on the boundary, distorted cells.
template <int dim>
Mesh<dim> labelled(const Mesh<dim>& mesh) {
  MeshLabels labels;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    labels.cell_tags.push_back(mesh.coordinates()[mesh.topology().cell_nodes(c)[0]][0] < 1.5 ? 1
                                                                                             : 2);
  for (std::size_t f = 0; f < 3; ++f) {
    labels.facets.append(mesh.topology().boundary_facets()[f]);
    labels.facet_tags.push_back(7);
  }
  labels.names[{dim - 1, 7}] = "inlet";
  Mesh<dim> result(std::make_shared<const Topology>(dim, mesh.n_nodes(), mesh.topology().cells(),
                                                    std::nullopt, std::move(labels)),
                   mesh.copied_coordinates());
  test::distort(result, 0.15, 4);
  return result;
}

/// The node with the lowest number lies on the boundary and may move; one inside stays.
template <int dim>
Mesh<dim> with_marks(Mesh<dim> mesh) {
  std::vector<bool> fixed;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    fixed.push_back(i != 0 && mesh.topology().is_fixed(i));
  fixed[mesh.topology().free_nodes().front()] = true;
  return with_fixed_nodes(std::move(mesh), fixed);
}

template <int dim>
using Place = std::array<double, static_cast<std::size_t>(dim)>;

template <int dim>
Place<dim> place(const Mesh<dim>& mesh, NodeIndex node) {
  Place<dim> x{};
  for (int d = 0; d < dim; ++d) x[static_cast<std::size_t>(d)] = mesh.coordinates()[node][d];
  return x;
}

/// What a mesh says, by coordinates.
template <int dim>
struct Content {
  std::multiset<std::pair<std::vector<Place<dim>>, int>> cells, facets;  ///< corners and tags
  std::map<Place<dim>, bool> fixed;
  std::map<std::pair<int, int>, std::string> names;

  void add(const Mesh<dim>& mesh) {
    const auto& labels = mesh.topology().labels();
    const auto places = [&](std::span<const NodeIndex> nodes) {
      std::vector<Place<dim>> result;
      for (const NodeIndex node : nodes) result.push_back(place(mesh, node));
      return result;
    };
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      cells.emplace(places(mesh.topology().cell_nodes(c)),
                    labels.cell_tags.empty() ? 0 : labels.cell_tags[c]);
    for (std::size_t f = 0; f < labels.facets.size(); ++f)
      facets.emplace(places(labels.facets[f]), labels.facet_tags[f]);
    names.insert(labels.names.begin(), labels.names.end());
  }
  bool operator==(const Content&) const = default;
};

template <int dim>
Mesh<dim> piece_of(const fs::path& path, std::size_t p) {
  return std::get<Mesh<dim>>(read_mesh(piece_file(path, p), {.turns_over = false}).mesh);
}

template <int dim>
Content<dim> content_of_pieces(const fs::path& path) {
  Content<dim> content;
  for (std::size_t p = 0; p < n_pieces; ++p) content.add(piece_of<dim>(path, p));
  return content;
}

/// Expects that pieces are those of the refined mesh, whose numbers they have.
template <int dim>
void expect_pieces_of(const fs::path& path, const Mesh<dim>& whole, std::size_t n_old) {
  Content<dim> expected;
  expected.add(whole);
  EXPECT_EQ(content_of_pieces<dim>(path), expected);
  const auto mesh = std::get<ScatteredMesh<dim>>(Pieces(Ranks(), path).read());
  EXPECT_FALSE(mesh.fixes_boundary);
  ASSERT_EQ(mesh.n_cells, whole.n_cells());
  auto nodes = mesh.nodes;
  ASSERT_EQ(nodes.n(), whole.n_nodes());
  std::map<Place<dim>, bool> stays;
  for (NodeIndex i = 0; i < whole.n_nodes(); ++i)
    stays[place(whole, i)] = whole.topology().is_fixed(i);
  for (NodeIndex i = 0; i < whole.n_nodes(); ++i) {
    const auto& entry = nodes.entries()[i];
    ASSERT_TRUE(stays.contains(entry.x)) << i;
    EXPECT_EQ(has(entry.reasons, FixedReason::marked), stays[entry.x]) << i;
    if (i < n_old) {
      EXPECT_EQ(entry.x, place(whole, i)) << i;
    }
  }
  for (CellIndex c = 0; c < whole.n_cells(); ++c) {
    ASSERT_EQ(mesh.cells.numbers[c], c);
    for (std::size_t i = 0; i < mesh.cells[c].size(); ++i)
      EXPECT_EQ(nodes.entries()[mesh.cells[c][i]].x,
                place(whole, whole.topology().cell_nodes(c)[i]));
  }
}

template <int dim>
void expect_refined(const Mesh<dim>& mesh) {
  const Folder folder;
  all_ranks().on_root([&] { write_in_pieces(mesh, n_pieces, folder / "in.pvtu"); });
  const Mesh<dim> whole = refined(mesh);
  const auto found = refine_pieces(all_ranks(), folder / "in.pvtu", folder / "together.pvtu");
  EXPECT_EQ(found.n_cells, whole.n_cells());
  EXPECT_EQ(found.n_pieces, n_pieces);
  EXPECT_THAT(found.losses, testing::IsEmpty());
  all_ranks().on_root([&] {
    expect_pieces_of(folder / "together.pvtu", whole, mesh.n_nodes());
    refine_pieces(Ranks(), folder / "in.pvtu", folder / "alone.pvtu");
    for (std::size_t p = 0; p < n_pieces; ++p)
      EXPECT_EQ(content_of(piece_file(folder / "together.pvtu", p)),
                content_of(piece_file(folder / "alone.pvtu", p)));
  });
}

TEST(RefinePieces, InThePlaneEqualTheWhole) {
  expect_refined(labelled(grid_mesh(5, GridCells::mixed)));
  expect_refined(with_marks(labelled(grid_mesh(5, GridCells::quadrilaterals))));
}

TEST(RefinePieces, InSpaceEqualTheWhole) {
  expect_refined(labelled(box_mesh(3, 3, 3, BoxCells::tetrahedra)));
  expect_refined(with_marks(labelled(box_mesh(3, 3, 3, BoxCells::hexahedra))));
  expect_refined(labelled(box_mesh(2, 2, 8, BoxCells::mixed)));
}

/// Writes a piece anew with its nodes in the reverse order, and without marks; with the numbers of
/// nodes and cells or without.
void turn_round(const fs::path& path, bool keeps_numbers) {
  const auto mesh = std::get<VolumeMesh>(read_mesh(path, {.turns_over = false}).mesh);
  const auto last = static_cast<NodeIndex>(mesh.n_nodes() - 1);
  CompressedRows<NodeIndex> cells;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    std::vector<NodeIndex> row;
    for (const NodeIndex node : mesh.topology().cell_nodes(c)) row.push_back(last - node);
    cells.append(row);
  }
  auto points = mesh.copied_coordinates();
  std::reverse(points.begin(), points.end());
  FileContent content;
  if (keeps_numbers) {
    content = *mesh.topology().labels().content;
    for (MeshField& field : content.node_fields)
      if (field.name == "GlobalNodeId") {
        auto& numbers = std::get<std::vector<std::int64_t>>(field.values);
        std::reverse(numbers.begin(), numbers.end());
      }
  }
  MeshLabels labels;
  labels.content = std::make_shared<const FileContent>(std::move(content));
  write_mesh(path, VolumeMesh(std::make_shared<const Topology>(3, mesh.n_nodes(), std::move(cells),
                                                               std::nullopt, std::move(labels)),
                              std::move(points)));
}

/// Means of four nodes depend on the order of their sum. Reading refuses nodes that differ.
TEST(RefinePieces, NewNodesAreTheSameInAllPieces) {
  const Folder folder;
  auto mesh = box_mesh(3, 3, 3, BoxCells::hexahedra);
  test::distort(mesh, 0.15, 4);
  const VolumeMesh whole = refined(mesh);
  for (const bool keeps_numbers : {true, false}) {
    all_ranks().on_root([&] {
      write_in_pieces(mesh, n_pieces, folder / "in.pvtu");
      turn_round(piece_file(folder / "in.pvtu", 1), keeps_numbers);
      write_piece_list(folder / "in.pvtu", n_pieces);
    });
    refine_pieces(all_ranks(), folder / "in.pvtu", folder / "together.pvtu");
    all_ranks().on_root([&] {
      refine_pieces(Ranks(), folder / "in.pvtu", folder / "alone.pvtu");
      for (std::size_t p = 0; p < n_pieces; ++p)
        EXPECT_EQ(content_of(piece_file(folder / "together.pvtu", p)),
                  content_of(piece_file(folder / "alone.pvtu", p)));
      auto read = std::get<ScatteredMesh<3>>(Pieces(Ranks(), folder / "alone.pvtu").read());
      EXPECT_EQ(read.n_cells, whole.n_cells());
      std::set<GlobalIndex> numbers(read.cells.corners.begin(), read.cells.corners.end());
      EXPECT_EQ(numbers.size(), whole.n_nodes());
      if (!keeps_numbers) return;
      Content<3> expected;
      expected.add(whole);
      EXPECT_EQ(content_of_pieces<3>(folder / "alone.pvtu"), expected);
    });
  }
}

/// Without marks the nodes of the boundary stay: a 2 x 2 x 2 box has a free node in the middle, and
/// the refined one 27.
TEST(RefinePieces, BoundariesOfFilesWithoutMarksStay) {
  const Folder folder;
  all_ranks().on_root([&] {
    write_in_pieces(box_mesh(2, 2, 2, BoxCells::hexahedra), 2, folder / "in.pvtu");
    for (std::size_t p = 0; p < 2; ++p) {  // a name that says nothing
      std::string text = content_of(piece_file(folder / "in.pvtu", p));
      const std::size_t at = text.find("Name=\"fixed\"");
      ASSERT_NE(at, std::string::npos);
      std::ofstream(piece_file(folder / "in.pvtu", p), std::ios::binary)
          << text.replace(at, 12, "Name=\"other\"");
    }
  });
  const auto found = refine_pieces(all_ranks(), folder / "in.pvtu", folder / "out.pvtu");
  EXPECT_THAT(found.losses, testing::ElementsAre("the field other"));
  all_ranks().on_root([&] {
    auto mesh = std::get<ScatteredMesh<3>>(Pieces(Ranks(), folder / "out.pvtu").read());
    ASSERT_EQ(mesh.nodes.n(), 125u);
    std::size_t n_free = 0;
    for (const auto& entry : mesh.nodes.entries()) n_free += entry.reasons == 0;
    EXPECT_EQ(n_free, 27u);
  });
}

/// A square next to two of half its size: both sides of the seam would become a boundary.
TEST(RefinePieces, HangingNodesAreRefused) {
  const Folder folder;
  const auto mesh =
      test::make_mesh({{0, 0}, {1, 0}, {1.5, 0}, {1, 0.5}, {1.5, 0.5}, {0, 1}, {1, 1}, {1.5, 1}},
                      {{0, 1, 6, 5}, {1, 2, 4, 3}, {3, 4, 7, 6}});
  all_ranks().on_root([&] { write_in_pieces(mesh, 3, folder / "in.pvtu"); });
  std::string error;
  try {
    refine_pieces(all_ranks(), folder / "in.pvtu", folder / "out.pvtu");
  } catch (const InputError& refused) {
    error = refused.what();
  }
  EXPECT_FALSE(fs::exists(folder / "out.pvtu"));
  EXPECT_FALSE(fs::exists(piece_file(folder / "out.pvtu", 0)));
  EXPECT_THAT(error, HasSubstr("in.pvtu: the mesh does not conform: 1 hanging node lies inside"));
  EXPECT_THAT(error, HasSubstr("(1, 0.5"));
  EXPECT_THAT(error, HasSubstr("divide the larger cells"));
}

TEST(RefinePieces, OthersAreRefusedOnAllRanks) {
  const Folder folder;
  const auto refine = [&](const char* in, const char* out) {
    refine_pieces(all_ranks(), folder / in, folder / out);
  };
  EXPECT_THAT([&] { refine("in.msh", "out.pvtu"); },
              ThrowsMessage<InputError>(HasSubstr("in.msh pieces.pvtu --pieces N")));
  write_box<2>(all_ranks(), {.n = {4, 4, 1}}, 2, folder / "box.pvtu");
  EXPECT_THAT([&] { refine("box.pvtu", "box.pvtu"); },
              ThrowsMessage<InputError>(HasSubstr("would replace")));
  EXPECT_THAT([&] { refine("box.pvtu", "out.vtu"); },
              ThrowsMessage<InputError>(HasSubstr("is a .pvtu file")));
  all_ranks().on_root([&] {
    write_in_pieces(test::pentagon_mesh(), 2, folder / "pentagons.pvtu");
    fs::copy(folder / "box.pvtu", folder / "copy.pvtu");
  });
  EXPECT_THAT([&] { refine("copy.pvtu", "box.pvtu"); },
              ThrowsMessage<InputError>(HasSubstr("would replace")));
  EXPECT_THAT([&] { refine("pentagons.pvtu", "out.pvtu"); },
              ThrowsMessage<InputError>(HasSubstr("has 5 nodes")));
  EXPECT_FALSE(fs::exists(folder / "out.pvtu"));
}

}  // namespace
}  // namespace smoothfem
