// SPDX-License-Identifier: GPL-3.0-or-later
// Results must not depend on the number of processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mpi.h>

#include <filesystem>
#include <fstream>
#include <iostream>

#include "distributed/distributed_mesh.h"
#include "distributed/files/box.h"
#include "distributed/files/pieces.h"
#include "distributed/files/split.h"
#include "distributed/partition.h"
#include "distributed/tests/example_meshes.h"
#include "distributed/tests/folder.h"
#include "distributed/tests/scattered.h"
#include "distributed/tests/smooth_pieces.h"
#include "fem/tests/all_ranks.h"
#include "meshes/io/mesh_file.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/parts/shared_coordinates.h"
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
using test::numbered_mesh;
using test::smooth_pieces;
using test::two_materials;
using testing::HasSubstr;
using testing::ThrowsMessage;

template <int dim>
struct Smoothed {
  std::vector<Point<dim>> points;
  SmoothingResult result;
  std::size_t n_reset = 0, n_copies = 0;
};

/// Moves nodes so far that many cells become invalid. The loop resets their nodes.
template <int dim>
class Leaper final : public Smoother<dim> {
 public:
  std::string_view name() const override { return "leaper"; }
  SmootherTraits traits() const override {
    return {.result = ResultMesh::last, .works_in_parts = true};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so, .max_iterations = 2};
  }
  StepReport step(SmoothingState<dim>& state) override {
    for (const NodeIndex i : state.mesh.topology().free_nodes()) {
      Point<dim>& x = state.mesh.coordinates()[i];
      for (int d = 0; d < dim; ++d) x[d] += 0.25 * std::sin(40.0 * x[(d + 1) % dim]);
    }
    update_copies(state.mesh);
    return {};
  }
};

/// Makes a method that keeps the worst quality. at_once: elements of GETMe sequential.
template <int dim>
Method<dim> method_of(const std::string& name, const char* at_once = "0") {
  Method<dim> method;
  if (name == "leaper")
    method.stages.push_back(std::make_unique<Leaper<dim>>());
  else
    method = make_method<dim>(name);
  if (name == "getme-sequential") method.set("at_once", at_once);
  if (name.starts_with("getme") && name != "getme-simultaneous") {  // each step exchanges much
    for (const auto& parameter : method.parameters()) {
      if (parameter.name.ends_with("max_cycles") || parameter.name.ends_with("max_iterations"))
        method.set(parameter.name, "2");
      if (parameter.name.ends_with("cycle")) method.set(parameter.name, "5");
    }
  }
  method.floor = 1;
  return method;
}

/// Smooths a mesh in parts; returns all its points.
template <int dim>
Smoothed<dim> smoothed(const Ranks& ranks, const Mesh<dim>& mesh, const std::string& name,
                       bool balances, const char* at_once = "0") {
  auto spread = scattered(ranks, mesh);
  auto parts = distribute(ranks, balances ? balanced(ranks, std::move(spread)) : std::move(spread));
  EXPECT_EQ(parts.n_nodes, mesh.n_nodes());
  auto method = method_of<dim>(name, at_once);
  Smoothed<dim> smoothed;
  smoothed.result = smooth(parts.part, method, [&](const IterationRecord& record, const auto&) {
    smoothed.n_reset += record.n_reset;
  });
  store_coordinates(parts);
  std::vector<GlobalIndex> numbers(mesh.n_nodes());
  std::iota(numbers.begin(), numbers.end(), 0);
  for (const auto& entry : parts.directory.ask(numbers, [](const auto& kept) { return kept; })) {
    smoothed.points.push_back(entry.point());
    EXPECT_EQ(entry.reasons,
              mesh.topology().fixed_reasons(static_cast<NodeIndex>(smoothed.points.size() - 1)));
  }
  for (NodeIndex i = 0; i < parts.part.n_nodes(); ++i) {
    EXPECT_EQ(std::as_const(parts.part).coordinates()[i],
              smoothed.points[parts.part.topology().part()->nodes()[i]]);
    smoothed.n_copies += !parts.part.topology().part()->owns_node(i);
  }
  smoothed.n_copies = ranks.sum(smoothed.n_copies);
  return smoothed;
}

template <int dim>
void expect_same_for_all_ranks(const Mesh<dim>& mesh, const std::string& what,
                               std::size_t& n_reset) {
  std::vector<std::string> names{
      "laplace",          "weighted-laplace", "smart-laplace",       "getme-simultaneous",
      "getme-sequential", "getme-adaptive",   "global-optimization", "leaper"};
  if (dim == 3) names.push_back("getme-qgamma");
  for (const std::string& name : names) {
    const auto alone = smoothed(Ranks(), mesh, name, false);
    for (const bool balances : {false, true}) {
      const auto together = smoothed(all_ranks(), mesh, name, balances);
      EXPECT_EQ(together.points, alone.points) << what << ' ' << name;
      EXPECT_EQ(together.result.iterations_text(), alone.result.iterations_text());
      EXPECT_EQ(together.result.quality.q_min, alone.result.quality.q_min);
      EXPECT_EQ(together.result.quality.q_star_min, alone.result.quality.q_star_min);
      EXPECT_EQ(together.result.quality.q_mean, alone.result.quality.q_mean);
      EXPECT_EQ(together.result.n_floor_reset, alone.result.n_floor_reset);
      EXPECT_EQ(together.n_reset, alone.n_reset);
      EXPECT_EQ(together.n_copies > 0, all_ranks().size() > 1);
    }
    EXPECT_NE(alone.points, mesh.copied_coordinates());
    n_reset += alone.n_reset;
    if (name == "laplace" || name == "weighted-laplace" || name == "getme-qgamma")
      continue;  // one by one otherwise
    Mesh<dim> whole = mesh;
    auto method = method_of<dim>(name, "10");
    smooth(whole, method);
    const double bound = name == "getme-sequential"      ? 0.0
                         : name == "global-optimization" ? 1e-6
                                                         : 1e-10;
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      EXPECT_LE((std::as_const(whole).coordinates()[i] - alone.points[i]).norm(), bound)
          << what << ' ' << name;
  }
}

TEST(Parts, ResultsDoNotDependOnTheRanks) {
  std::size_t n_reset = 0;
  for (const auto kind : {GridCells::triangles, GridCells::quadrilaterals, GridCells::mixed})
    expect_same_for_all_ranks(two_materials(grid_mesh(9, kind), 0.4, 3), "planar", n_reset);
  for (const auto kind : {BoxCells::tetrahedra, BoxCells::hexahedra, BoxCells::mixed})
    expect_same_for_all_ranks(two_materials(box_mesh(5, 4, 5, kind), 0.3, 4), name_of(kind),
                              n_reset);
  EXPECT_GT(n_reset, 0u);
}

/// One element at a time, as in a whole mesh without parts.
TEST(Parts, OneElementAfterTheOtherIsTheThesisMethod) {
  const auto mesh = two_materials(box_mesh(3, 3, 3, BoxCells::tetrahedra), 0.3, 4);
  auto whole = mesh;
  auto method = method_of<3>("getme-sequential");
  smooth(whole, method);
  EXPECT_EQ(smoothed(all_ranks(), mesh, "getme-sequential", true, "1").points,
            whole.copied_coordinates());
}

TEST(Parts, SweepsFromNodeToNodeAreRefused) {
  auto parts =
      distribute(all_ranks(),
                 scattered(all_ranks(), two_materials(grid_mesh(6, GridCells::triangles), 0.2, 1)));
  auto method = make_method<2>("global-optimization");
  method.set("start_sweeps", "1");
  EXPECT_THAT([&] { smooth(parts.part, method); },
              ThrowsMessage<InputError>(HasSubstr("start_sweeps")));
}

TEST(Parts, MethodsThatNeedTheWholeMeshAreRefused) {
  const auto mesh = two_materials(grid_mesh(6, GridCells::triangles), 0.2, 1);
  EXPECT_THAT([&] { smoothed(all_ranks(), mesh, "energy-descent", true); },
              ThrowsMessage<InputError>(HasSubstr("methods for a mesh in parts are")));
}

TEST(Parts, BalancedPartsHaveEqualShares) {
  const auto mesh = two_materials(box_mesh(6, 5, 4, BoxCells::tetrahedra), 0.2, 1);
  auto all = scattered(Ranks(), mesh);  // all cells on the root at first
  auto spread = scattered(all_ranks(), mesh);
  spread.cells = all_ranks().is_root() ? std::move(all.cells) : CellTable{};
  const auto shared = balanced(all_ranks(), std::move(spread));
  EXPECT_EQ(all_ranks().sum(shared.cells.size()), mesh.n_cells());
  EXPECT_LT(all_ranks().max(static_cast<double>(shared.cells.size())) * all_ranks().size(),
            1.1 * static_cast<double>(mesh.n_cells()));
  EXPECT_TRUE(std::is_sorted(shared.cells.numbers.begin(), shared.cells.numbers.end()));
}

TEST(Parts, EachRankNeedsACell) {
  if (all_ranks().size() == 1) return;
  auto mesh = scattered(all_ranks(), grid_mesh(1, GridCells::quadrilaterals));
  EXPECT_THAT([&] { (void)balanced(all_ranks(), std::move(mesh)); },
              ThrowsMessage<InputError>(HasSubstr("fewer cells (1) than mpirun has started")));
}

TEST(Parts, TablesMergeInOrder) {
  CellTable table, others;
  const std::vector<GlobalIndex> triangle{1, 2, 3}, quadrilateral{4, 5, 6, 7};
  for (const GlobalIndex c : {1u, 4u, 5u, 9u})
    table.append(c, 10, c == 4 ? quadrilateral : triangle);
  for (const GlobalIndex c : {0u, 2u, 3u, 7u})
    others.append(c, 20, c == 3 ? quadrilateral : triangle);
  const auto was_there = merge_into(table, others);
  EXPECT_THAT(table.numbers, testing::ElementsAre(0, 1, 2, 3, 4, 5, 7, 9));
  EXPECT_THAT(table.materials, testing::ElementsAre(20, 10, 20, 20, 10, 10, 20, 10));
  EXPECT_THAT(was_there, testing::ElementsAre(0, 1, 0, 0, 1, 1, 0, 1));
  for (std::size_t c = 0; c < table.size(); ++c)
    EXPECT_THAT(table[c], testing::ElementsAreArray(table.numbers[c] == 3 || table.numbers[c] == 4
                                                        ? quadrilateral
                                                        : triangle));
}

TEST(Parts, NumberSetsKnowPositions) {
  NumberSet set(200);
  for (const GlobalIndex number : {0u, 63u, 64u, 130u, 199u}) set.add(number);
  set.count();
  EXPECT_THAT(set.numbers(), testing::ElementsAre(0, 63, 64, 130, 199));
  EXPECT_EQ(set.position(64), 2u);
  EXPECT_EQ(set.position(199), 4u);
}

VolumeMesh smoothed_pieces(const Ranks& ranks, const fs::path& in, const fs::path& out) {
  return smooth_pieces<3>(ranks, Pieces(ranks, in), out);
}

TEST(Parts, FilesAreTheSameForAllRanks) {
  const Folder folder;
  const BoxParameters box{.n = {4, 3, 5}, .splits = true, .displacement = 0.16};
  EXPECT_EQ(write_box<3>(all_ranks(), box, 3, folder / "box.pvtu"), 360u);
  smoothed_pieces(all_ranks(), folder / "box.pvtu", folder / "together.pvtu");
  if (!all_ranks().is_root()) return;
  write_box<3>(Ranks(), box, 3, folder / "alone_box.pvtu");
  const auto whole = smoothed_pieces(Ranks(), folder / "box.pvtu", folder / "alone.pvtu");
  for (std::size_t p = 0; p < 3; ++p) {
    const auto content = content_of(piece_file(folder / "together.pvtu", p));
    EXPECT_GT(content.size(), 1000u);
    EXPECT_EQ(content, content_of(piece_file(folder / "alone.pvtu", p)));
    EXPECT_EQ(content_of(piece_file(folder / "box.pvtu", p)),
              content_of(piece_file(folder / "alone_box.pvtu", p)));
  }
  // The pieces are those of the whole box, whose coordinates one process has.
  const auto last = std::get<VolumeMesh>(read_mesh(piece_file(folder / "together.pvtu", 2)).mesh);
  for (NodeIndex i = 0; i < last.n_nodes(); ++i)
    EXPECT_EQ(last.coordinates()[i], whole.coordinates()[whole.n_nodes() - last.n_nodes() + i]);
  EXPECT_GT(mesh_quality(whole).q_min, 0.6);
}

/// Files without numbers of nodes: those with equal coordinates are the same.
TEST(Parts, NodesOfPiecesAreMatchedByCoordinates) {
  const Folder folder;
  const BoxParameters box{.n = {4, 3, 5}, .splits = true, .displacement = 0.16};
  write_box<3>(all_ranks(), box, 3, folder / "box.pvtu");
  all_ranks().on_root([&] {
    for (std::size_t p = 0; p < 3; ++p) {
      auto mesh = std::get<VolumeMesh>(read_mesh(piece_file(folder / "box.pvtu", p)).mesh);
      auto labels = mesh.topology().labels();
      labels.content = nullptr;
      write_mesh(piece_file(folder / "bare.pvtu", p),
                 VolumeMesh(std::make_shared<const Topology>(
                                3, mesh.n_nodes(), mesh.topology().cells(),
                                mesh.topology().fixed_reasons(), std::move(labels)),
                            mesh.copied_coordinates()));
    }
    write_piece_list(folder / "bare.pvtu", 3);
  });
  smoothed_pieces(all_ranks(), folder / "box.pvtu", folder / "a.pvtu");
  smoothed_pieces(all_ranks(), folder / "bare.pvtu", folder / "b.pvtu");
  all_ranks().on_root([&] {
    for (std::size_t p = 0; p < 3; ++p) {
      const auto a = read_mesh(piece_file(folder / "a.pvtu", p)).mesh,
                 b = read_mesh(piece_file(folder / "b.pvtu", p)).mesh;
      EXPECT_EQ(std::get<VolumeMesh>(a).copied_coordinates(),
                std::get<VolumeMesh>(b).copied_coordinates());
    }
  });
}

/// Pieces of a mesh keep its numbers of nodes and cells, so that results are those of the whole.
TEST(Parts, AMeshIsSplitIntoPieces) {
  const Folder folder;
  const auto mesh = two_materials(grid_mesh(9, GridCells::mixed), 0.4, 3);
  all_ranks().on_root([&] {
    write_mesh(folder / "whole.vtu", mesh);
    write_in_pieces(mesh, 5, folder / "split.pvtu");
  });
  const auto points = [&](const char* name) {
    const Pieces pieces(all_ranks(), folder / name);
    auto parts =
        distribute(all_ranks(), balanced(all_ranks(), std::get<ScatteredMesh<2>>(pieces.read())));
    EXPECT_EQ(parts.part.topology().part()->n_cells_of_whole(), mesh.n_cells());
    auto method = make_method<2>("smart-laplace");
    smooth(parts.part, method);
    store_coordinates(parts);
    std::vector<GlobalIndex> numbers(mesh.n_nodes());
    std::iota(numbers.begin(), numbers.end(), 0);
    return parts.directory.ask(numbers, [](const auto& entry) { return entry.x; });
  };
  const auto of_whole = points("whole.vtu"), of_pieces = points("split.pvtu");
  EXPECT_EQ(of_pieces, of_whole);
  if (!all_ranks().is_root()) return;
  std::size_t n_cells = 0, n_marked = 0;
  for (std::size_t p = 0; p < 5; ++p) {
    const auto piece = std::get<PlanarMesh>(read_mesh(piece_file(folder / "split.pvtu", p)).mesh);
    n_cells += piece.n_cells();
    n_marked += static_cast<std::size_t>(std::count(piece.topology().labels().cell_tags.begin(),
                                                    piece.topology().labels().cell_tags.end(), 2));
  }
  EXPECT_EQ(n_cells, mesh.n_cells());
  const auto& tags = mesh.topology().labels().cell_tags;
  EXPECT_EQ(n_marked, static_cast<std::size_t>(std::count(tags.begin(), tags.end(), 2)));
}

/// Each piece also has the cells of the other one, marked as ParaView does.
TEST(Parts, CopiedCellsOfPiecesCountOnce) {
  const Folder folder;
  const auto mesh = two_materials(grid_mesh(6, GridCells::triangles), 0.3, 3);
  all_ranks().on_root([&] {
    for (std::size_t p = 0; p < 2; ++p) {
      std::vector<std::int64_t> types, numbers(mesh.n_nodes());
      std::iota(numbers.begin(), numbers.end(), 0);
      for (CellIndex c = 0; c < mesh.n_cells(); ++c) types.push_back(c % 2 == p ? 0 : 1);
      FileContent content;
      content.element_fields.push_back(
          {.name = "vtkGhostType", .type = NumberType::uint8, .values = std::move(types)});
      content.node_fields.push_back(
          {.name = "GlobalNodeId", .type = NumberType::int64, .values = std::move(numbers)});
      content.node_roles["GlobalIds"] = "GlobalNodeId";
      MeshLabels labels;
      labels.content = std::make_shared<const FileContent>(std::move(content));
      write_mesh(piece_file(folder / "copies.pvtu", p),
                 PlanarMesh(std::make_shared<const Topology>(
                                2, mesh.n_nodes(), mesh.topology().cells(),
                                mesh.topology().fixed_reasons(), std::move(labels)),
                            mesh.copied_coordinates()));
    }
    write_piece_list(folder / "copies.pvtu", 2);
  });
  auto read = std::get<ScatteredMesh<2>>(Pieces(all_ranks(), folder / "copies.pvtu").read());
  const auto parts = distribute(all_ranks(), balanced(all_ranks(), std::move(read)));
  EXPECT_EQ(parts.part.topology().part()->n_cells_of_whole(), mesh.n_cells());
  EXPECT_EQ(parts.n_nodes, mesh.n_nodes());
  EXPECT_EQ(mesh_quality(parts.part).q_min, mesh_quality(mesh).q_min);
}

/// The first rank reads text; all read blocks of the binary file.
TEST(Parts, BlocksOfAFileAreTheMesh) {
  const Folder folder;
  const auto mesh = numbered_mesh();
  all_ranks().on_root([&] {
    write_mesh(folder / "text.msh", mesh, {}, {.binary = false});
    write_mesh(folder / "blocks.msh", mesh, {}, {.binary = true});
  });
  const Pieces text(all_ranks(), folder / "text.msh"), blocks(all_ranks(), folder / "blocks.msh");
  const auto expected = std::get<ScatteredMesh<3>>(text.read()),
             found = std::get<ScatteredMesh<3>>(blocks.read());
  EXPECT_EQ(text.notes().empty(), all_ranks().size() == 1);
  EXPECT_TRUE(blocks.notes().empty());
  EXPECT_EQ(found.n_cells, mesh.n_cells());
  EXPECT_LT(all_ranks().max(static_cast<double>(found.cells.size())) * all_ranks().size(),
            static_cast<double>(mesh.n_cells() + 3) + all_ranks().size());
  EXPECT_EQ(all_cells(all_ranks(), found), all_cells(all_ranks(), expected));
  ASSERT_EQ(found.nodes.n(), mesh.n_nodes() - 1);
  ASSERT_EQ(expected.nodes.n(), mesh.n_nodes() - 1);
  std::vector<GlobalIndex> numbers(found.nodes.n());
  std::iota(numbers.begin(), numbers.end(), 0);
  const auto place = [](const NodeEntry<3>& entry) { return entry.x; };
  const auto reasons = [](const NodeEntry<3>& entry) { return entry.reasons; };
  EXPECT_EQ(found.nodes.ask(numbers, place), expected.nodes.ask(numbers, place));
  const auto labelled = found.nodes.ask(numbers, reasons);
  EXPECT_EQ(labelled, expected.nodes.ask(numbers, reasons));
  EXPECT_GT(std::count(labelled.begin(), labelled.end(), bit(FixedReason::interface)), 3);
}

TEST(Parts, FilesReadInBlocksAreWrittenWithTheSameNodes) {
  const Folder folder;
  const auto mesh = numbered_mesh();
  all_ranks().on_root([&] {
    write_mesh(folder / "text.msh", mesh, {}, {.binary = false});
    write_mesh(folder / "blocks.msh", mesh, {}, {.binary = true});
  });
  smoothed_pieces(all_ranks(), folder / "text.msh", folder / "text_out.msh");
  smoothed_pieces(all_ranks(), folder / "blocks.msh", folder / "blocks_out.msh");
  smoothed_pieces(all_ranks(), folder / "blocks.msh", folder / "blocks_out.vtu");
  all_ranks().on_root([&] {
    const auto read = [&](const char* name) {
      return std::get<VolumeMesh>(read_mesh(folder / name, {.turns_over = false}).mesh);
    };
    const auto text = read("text_out.msh"), blocks = read("blocks_out.msh");
    EXPECT_EQ(blocks.copied_coordinates(), text.copied_coordinates());
    EXPECT_EQ(read("blocks_out.vtu").copied_coordinates(), text.copied_coordinates());
    EXPECT_NE(blocks.copied_coordinates(), read("blocks.msh").copied_coordinates());
    EXPECT_EQ(blocks.topology().labels(), read("blocks.msh").topology().labels());
    EXPECT_EQ(content_of(folder / "blocks_out.msh").size(),
              content_of(folder / "blocks.msh").size());
  });
}

/// Gmsh's partitions and lists of ghost elements stay in the file.
TEST(Parts, PartitionsStayInFilesReadInBlocks) {
  const Folder folder;
  const auto mesh = numbered_mesh();
  const std::string partitions = "$PartitionedEntities\n" + std::string(1, '\2') +
                                 std::string(47, '\0') + "\n$EndPartitionedEntities\n",
                    ghosts = "$GhostElements\n" + std::string(8, '\0') + "\n$EndGhostElements\n";
  all_ranks().on_root([&] {
    write_mesh(folder / "whole.msh", mesh, {}, {.binary = true});
    std::string bytes = content_of(folder / "whole.msh");
    bytes.insert(bytes.find("$Nodes\n"), partitions);
    std::ofstream(folder / "divided.msh", std::ios::binary) << bytes << ghosts;
  });
  smoothed_pieces(all_ranks(), folder / "whole.msh", folder / "whole_out.msh");
  smoothed_pieces(all_ranks(), folder / "divided.msh", folder / "divided_out.msh");
  all_ranks().on_root([&] {
    std::string expected = content_of(folder / "whole_out.msh");
    expected.insert(expected.find("$Nodes\n"), partitions);
    EXPECT_EQ(content_of(folder / "divided_out.msh"), expected + ghosts);
  });
}

/// Also by the ranks that do not read it: they would wait for the one that does.
TEST(Parts, CoordinatesThatAreNoNumbersAreRefusedOnAllRanks) {
  const Folder folder;
  auto mesh = box_mesh(4, 3, 2, BoxCells::tetrahedra);
  mesh.coordinates()[7].y() = std::numeric_limits<double>::quiet_NaN();
  all_ranks().on_root([&] {
    write_mesh(piece_file(folder / "pieces.pvtu", 0), mesh);
    write_piece_list(folder / "pieces.pvtu", 1);
    write_mesh(folder / "blocks.msh", mesh, {}, {.binary = true});
    write_mesh(folder / "blocks.vtu", mesh);
  });
  for (const auto& [name, node] :
       {std::pair("pieces.pvtu", "7"), {"blocks.msh", "8"}, {"blocks.vtu", "7"}}) {
    const auto read = [file = folder / name] { Pieces(all_ranks(), file).read(); };
    EXPECT_THAT(read, ThrowsMessage<InputError>(HasSubstr("node " + std::string(node) +
                                                          " has a coordinate that is not")));
  }
}

/// A number that is none differs from itself. The examination names the coordinate.
TEST(Parts, PiecesWithTheSameNodeThatIsNowhereAreNotTorn) {
  const Folder folder;
  const BoxParameters parameters{.n = {2, 2, 2}};
  all_ranks().on_root([&] {
    const fs::path list = folder / "pieces.pvtu";
    auto low = box_layers<3>(parameters, 0, 1), high = box_layers<3>(parameters, 1, 2);
    low.coordinates()[17].x() = high.coordinates()[8].x() =
        std::numeric_limits<double>::quiet_NaN();
    write_mesh(piece_file(list, 0), low);
    write_mesh(piece_file(list, 1), high);
    write_piece_list(list, 2);
  });
  const Pieces pieces(all_ranks(), folder / "pieces.pvtu");
  EXPECT_NO_THROW(pieces.read(ReadFor::examination));
}

TEST(Parts, AnEarlierMeshIsReplacedOnlyWhenAllPiecesAreComplete) {
  const Folder folder;
  const fs::path list = folder / "pieces.pvtu", piece = piece_file(list, 0);
  all_ranks().on_root([&] {
    const auto files = [&] {
      const fs::directory_iterator in_folder(piece.parent_path());
      return std::distance(begin(in_folder), end(in_folder));
    };
    write_in_pieces(box_mesh(4, 3, 2, BoxCells::tetrahedra), 2, list);
    const std::string old = content_of(piece);
    for (const bool is_finished : {false, true}) {
      {
        const NewPieces pieces(list);
        for (const std::size_t p : {0, 1})
          write_mesh(pieces.file(p), box_mesh(2, 2, 2, BoxCells::tetrahedra));
        EXPECT_EQ(content_of(piece), old);
        if (is_finished) pieces.finish(2);
      }
      EXPECT_EQ(content_of(piece) == old, !is_finished);
      EXPECT_TRUE(fs::exists(list));
      EXPECT_EQ(files(), 2);
    }
    { const NewPieces stopped(folder / "none.pvtu"); }
    EXPECT_FALSE(fs::exists(folder / "none"));
  });
}

TEST(Parts, FilesOfTheMeshAreNotReplaced) {
  const Folder folder;
  all_ranks().on_root([&] {
    write_in_pieces(box_mesh(4, 3, 2, BoxCells::tetrahedra), 2, folder / "pieces.pvtu");
    fs::copy(folder / "pieces.pvtu", folder / "list.pvtu");  // of the same pieces
  });
  const Pieces pieces(all_ranks(), folder / "list.pvtu");
  for (const char* name : {"pieces.pvtu", "list.pvtu"})
    EXPECT_THAT([&] { pieces.require_output(folder / name); },
                ThrowsMessage<InputError>(HasSubstr("would replace")));
  pieces.require_output(folder / "other.pvtu");
}

TEST(Parts, DamagedBlocksAreRefusedOnAllRanks) {
  const Folder folder;
  const auto mesh = numbered_mesh();
  all_ranks().on_root([&] { write_mesh(folder / "whole.msh", mesh, {}, {.binary = true}); });
  // The first tag of an element's node, behind the four totals, the block's head and the element's
  // tag, becomes one that no node has.
  all_ranks().on_root([&] {
    std::string bytes = content_of(folder / "whole.msh");
    const std::size_t at = bytes.find("$Elements\n") + 10 + 32 + 20 + 8;
    bytes[at] = 2;
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at) + 1, 7, '\0');
    std::ofstream(folder / "damaged.msh", std::ios::binary) << bytes;
  });
  EXPECT_THAT([&] { Pieces(all_ranks(), folder / "damaged.msh").read(); },
              ThrowsMessage<InputError>(HasSubstr("names a node that the file does not have")));
}

/// Pieces are written without the tables of a mesh. The bytes are those of write_mesh().
template <int dim>
void expect_pieces_as_meshes(const Mesh<dim>& mesh, const fs::path& path) {
  const fs::path out = path.parent_path() / "moved.pvtu", again = path.parent_path() / "again.vtu";
  all_ranks().on_root([&] { write_in_pieces(mesh, 3, path); });
  smooth_pieces<dim>(all_ranks(), Pieces(all_ranks(), path), out);
  all_ranks().on_root([&] {
    for (std::size_t p = 0; p < 3; ++p) {
      write_mesh(again, read_mesh(piece_file(out, p), {.turns_over = false}).mesh);
      EXPECT_EQ(content_of(again), content_of(piece_file(out, p)));
      EXPECT_NE(content_of(again), content_of(piece_file(path, p)));
    }
  });
}

TEST(Parts, PiecesAreWrittenAsMeshes) {
  const Folder folder;
  expect_pieces_as_meshes(numbered_mesh(), folder / "volume.pvtu");
  expect_pieces_as_meshes(two_materials(grid_mesh(9, GridCells::mixed), 0.4, 3),
                          folder / "planar.pvtu");
}

TEST(Parts, BadPiecesAreRefusedOnAllRanks) {
  const Folder folder;
  write_box<2>(all_ranks(), {.n = {4, 4, 1}}, 3, folder / "box.pvtu");
  const auto read = [&] { Pieces(all_ranks(), folder / "box.pvtu").read(); };
  EXPECT_NO_THROW(read());
  (void)all_ranks().any(false);
  all_ranks().on_root([&] { fs::resize_file(piece_file(folder / "box.pvtu", 2), 700); });
  EXPECT_THAT(read, ThrowsMessage<InputError>(HasSubstr("box_0002.vtu")));
  (void)all_ranks().any(false);
  all_ranks().on_root([&] { std::ofstream(folder / "box.pvtu") << "<VTKFile></VTKFile>"; });
  EXPECT_THAT(read, ThrowsMessage<InputError>(HasSubstr("lists no pieces")));
}

}  // namespace
}  // namespace smoothfem
