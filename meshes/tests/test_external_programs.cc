// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "meshes/external/child_process.h"
#include "meshes/external/command_line.h"
#include "meshes/external/returned_mesh.h"
#include "meshes/external/text_vtk.h"
#include "meshes/io/text/medit_text.h"
#include "meshes/tests/labelled_box.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/loop/smoother.h"
#include "smoothing/second_order/raise_order.h"

namespace smoothfem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using ExternalProgram = FileTest;

TEST(CommandText, ReplacesPlaceholders) {
  EXPECT_EQ(with_placeholder("a {in} b {in}{out}", "in", "x{in}"), "a x{in} b x{in}{out}");
  EXPECT_TRUE(has_placeholder("a {iterations}", "iterations"));
  EXPECT_FALSE(has_placeholder("a {iterations}", "iteration"));
}

TEST(CommandText, FirstWordEndsAtABlankOutsideOfQuotes) {
  EXPECT_EQ(first_word("mmg3d_O3 -noinsert {in}"), "mmg3d_O3");
  EXPECT_EQ(after_first_word("mmg3d_O3 -noinsert {in}"), " -noinsert {in}");
  EXPECT_EQ(first_word("'my program' x"), "myprogram");
  EXPECT_EQ(after_first_word("'my program' x"), " x");
  EXPECT_EQ(first_word("alone"), "alone");
  EXPECT_EQ(after_first_word("alone"), "");
}

TEST(CommandText, ReadsTimesFromMatchingLines) {
  const std::string text = "start\nstep 1 time: 0.25 s\nstep 2 time: 1e-1 s\ntime: none\n\n";
  const LinePattern pattern("time_pattern", "time: ([0-9.e+-]+) s");
  EXPECT_THAT(times_in(text, pattern, 1.0), ElementsAre(0.25, 0.1));
  EXPECT_THAT(times_in(text, pattern, 2.0), ElementsAre(0.5, 0.2));
  EXPECT_THAT(times_in(text, LinePattern("time_pattern", "seconds: (.*)"), 1.0), ElementsAre());
  EXPECT_EQ(last_line(text), "time: none");
  EXPECT_EQ(last_line(""), "");
}

TEST(CommandText, RefusesTimesThatAreNone) {
  for (const std::string time : {"nan", "-5", "inf", "1e400", "abc", ""})
    EXPECT_THROW(times_in("time: " + time + "\n", LinePattern("time_pattern", "time: (.*)"), 1.0),
                 SmootherFailure)
        << time;
  EXPECT_THROW(times_in("1e308", LinePattern("time_pattern", "(.*)"), 1e6), SmootherFailure);
}

TEST(CommandText, PatternsEndOnEveryLine) {
  EXPECT_THROW(
      times_in(std::string(3000, 'a') + "\n", LinePattern("time_pattern", "((a+)+)+[bc]"), 1.0),
      SmootherFailure);
  EXPECT_THROW(LinePattern("time_pattern", "("), InputError);
  EXPECT_THROW(LinePattern("time_pattern", std::string(100000, '(')), InputError);
  EXPECT_THROW(LinePattern("time_pattern", "time"), InputError);
}

TEST(CommandText, QuotedWordsPassTheShellUnchanged) {
  const ScratchFolder folder;
  const std::string word = "it's \"all\" $HOME `one` \\ word";
  EXPECT_EQ(run_command("printf %s " + shell_quoted(word), folder.path(), 10.0).output, word);
}

TEST_F(ExternalProgram, ReportsHowAProgramEnded) {
  const auto end = run_command("pwd; echo loud >&2; exit 3", file(""), 10.0);
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_EQ(end.signal, 0);
  EXPECT_FALSE(end.timed_out);
  EXPECT_THAT(end.output, HasSubstr("loud\n"));
  EXPECT_THAT(end.output, HasSubstr(file("").filename().string()));
  EXPECT_EQ(run_command("kill -9 $$", file(""), 10.0).signal, 9);
  EXPECT_EQ(run_command("no-such-program-here", file(""), 10.0).exit_code, 127);
}

TEST_F(ExternalProgram, IsNotAnMpiRank) {
  ::setenv("OMPI_COMM_WORLD_SIZE", "2", 1);
  ::setenv("SMOOTHFEM_TEST", "here", 1);
  const auto end = run_command("echo \"$OMPI_COMM_WORLD_SIZE,$SMOOTHFEM_TEST\"", file(""), 10.0);
  ::unsetenv("OMPI_COMM_WORLD_SIZE");
  ::unsetenv("SMOOTHFEM_TEST");
  EXPECT_EQ(end.output, ",here\n");
}

TEST_F(ExternalProgram, MeasuresWallClockTime) {
  const auto end = run_command("sleep 0.3", file(""), 10.0);
  EXPECT_GE(end.wall_seconds, 0.3);
}

TEST_F(ExternalProgram, EndsHangingProgramsWithAllTheirChildren) {
  const auto start = std::chrono::steady_clock::now();
  const auto end =
      run_command("(sleep 2; touch " + shell_quoted(file("late")) + ") & sleep 100", file(""), 0.2);
  EXPECT_TRUE(end.timed_out);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
  std::this_thread::sleep_for(std::chrono::seconds(3));
  EXPECT_FALSE(std::filesystem::exists(file("late")));
}

TEST_F(ExternalProgram, RemovesTheScratchFolderWithItsContent) {
  std::filesystem::path path;
  {
    const ScratchFolder folder;
    path = folder.path();
    std::ofstream(path / "file") << "x";
    EXPECT_TRUE(std::filesystem::exists(path / "file"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(FindProgram, SearchesThePathOfTheShell) {
  EXPECT_EQ(find_program("sh").filename(), "sh");
  EXPECT_EQ(find_program("no-such-program-here"), "");
  EXPECT_EQ(find_program("/bin/sh"), "/bin/sh");
  EXPECT_EQ(find_program("/bin"), "");
}

/// Returns the reason why a returned mesh is refused; empty if it is accepted.
template <int dim>
std::string refusal(const std::filesystem::path& path, const Mesh<dim>& given) {
  try {
    (void)returned_coordinates<dim>(path, given);
  } catch (const SmootherFailure& failure) {
    return failure.what();
  }
  return "";
}

TEST_F(ExternalProgram, VtkTextIsReadBackBitwiseIdentical) {
  const PlanarMesh planar = mixed_mesh(true);
  write_text_vtk(file("planar.vtk"), planar);
  EXPECT_EQ(read_planar(file("planar.vtk")).mesh.copied_coordinates(), planar.copied_coordinates());
  EXPECT_EQ(read_planar(file("planar.vtk")).mesh.topology().cells(), planar.topology().cells());
  EXPECT_EQ(read_planar(file("planar.vtk")).mesh.topology().free_nodes(),
            planar.topology().free_nodes());
  for (const auto kind : {test::BoxCells::tetrahedra, test::BoxCells::hexahedra,
                          test::BoxCells::prisms, test::BoxCells::pyramids}) {
    const VolumeMesh box = test::box_mesh(2, 2, 2, kind);
    write_text_vtk(file("box.vtk"), box);
    EXPECT_EQ(read_volume(file("box.vtk")).copied_coordinates(), box.copied_coordinates());
    EXPECT_EQ(read_volume(file("box.vtk")).topology().cells(), box.topology().cells());
  }
}

/// Returns the entries of a section of a Medit file.
std::size_t section_size(const std::filesystem::path& path, const std::string& section) {
  const std::string text = content_of(path);
  const auto at = text.find("\n" + section + "\n");
  return at == std::string::npos ? 0 : std::stoul(text.substr(at + section.size() + 2));
}

TEST_F(ExternalProgram, MeditForProgramsHasTheWholeBoundary) {
  const PlanarMesh planar = mixed_mesh(false);
  write_medit_with_boundary(file("planar.mesh"), planar);
  const PlanarMesh read = read_planar(file("planar.mesh")).mesh;
  EXPECT_EQ(read.copied_coordinates(), planar.copied_coordinates());
  EXPECT_EQ(read.topology().n_cells(), planar.n_cells());
  EXPECT_EQ(read.topology().free_nodes(), planar.topology().free_nodes());
  EXPECT_EQ(section_size(file("planar.mesh"), "Edges"), planar.topology().boundary_facets().size());

  EXPECT_THAT(input_error_of([&] { write_medit_with_boundary(file("a.mesh"), mixed_mesh(true)); }),
              HasSubstr("has 5 nodes"));

  const VolumeMesh bare = test::box_mesh(2, 2, 4, test::BoxCells::hexahedra);
  write_medit_with_boundary(file("bare.mesh"), bare);
  EXPECT_EQ(section_size(file("bare.mesh"), "Quadrilaterals"), 40u);

  // Labelled facets keep their label; every tenth has two.
  const VolumeMesh box = labelled_box(test::BoxCells::hexahedra);
  write_medit_with_boundary(file("box.mesh"), box);
  EXPECT_EQ(section_size(file("box.mesh"), "Quadrilaterals"), 40u + 4u);
  EXPECT_EQ(read_volume(file("box.mesh")).topology().labels().facet_tags,
            box.topology().labels().facet_tags);
}

PlanarMesh with_cells(const PlanarMesh& mesh, CompressedRows<NodeIndex> cells) {
  return {std::make_shared<const Topology>(2, mesh.n_nodes(), std::move(cells)),
          mesh.copied_coordinates()};
}

TEST_F(ExternalProgram, ReadsMovedNodesInAnyOrderOfCells) {
  const PlanarMesh given = mixed_mesh(false);
  CompressedRows<NodeIndex> cells;
  for (std::size_t c = given.n_cells(); c-- > 0;) {
    const auto nodes = given.topology().cell_nodes(c);
    std::vector<NodeIndex> rotated(nodes.begin() + 1, nodes.end());
    rotated.push_back(nodes.front());
    cells.append(rotated);
  }
  PlanarMesh moved = with_cells(given, cells);
  moved.coordinates()[4] += Point<2>(0.01, -0.02);
  write_mesh(file("out.vtk"), moved);
  const auto points = returned_coordinates<2>(file("out.vtk"), given);
  for (NodeIndex i = 0; i < given.n_nodes(); ++i) EXPECT_EQ(points[i], moved.coordinates()[i]) << i;
}

TEST_F(ExternalProgram, MatchesNodesByTheNumbersOfTheFile) {
  const VolumeMesh given = labelled_box(test::BoxCells::tetrahedra);  // numbers 2, 5, 8, ...
  write_mesh(file("out.msh"), given);
  const auto points = returned_coordinates<3>(file("out.msh"), given);
  for (NodeIndex i = 0; i < given.n_nodes(); ++i) EXPECT_EQ(points[i], given.coordinates()[i]);
  MeshLabels other = given.topology().labels();
  other.node_ids[3] = 1000;
  write_mesh(file("other.msh"),
             VolumeMesh(std::make_shared<const Topology>(
                            3, given.n_nodes(), given.topology().cells(), std::nullopt, other),
                        given.copied_coordinates()));
  EXPECT_THAT(refusal(file("other.msh"), given), HasSubstr("a node with the number 1000"));
}

TEST_F(ExternalProgram, FixedNodesStayBitwiseIdenticalWithFewDigits) {
  const PlanarMesh given = mixed_mesh(false);
  PlanarMesh rounded = given;
  for (auto& p : rounded.coordinates()) p = (p * 1e7).array().round() / 1e7;
  write_mesh(file("out.vtk"), rounded);
  const auto points = returned_coordinates<2>(file("out.vtk"), given);
  for (NodeIndex i = 0; i < given.n_nodes(); ++i)
    EXPECT_EQ(points[i],
              given.topology().is_fixed(i) ? given.coordinates()[i] : rounded.coordinates()[i]);
}

TEST_F(ExternalProgram, RefusesMovedFixedNodes) {
  const PlanarMesh given = mixed_mesh(false);
  PlanarMesh moved = given;
  moved.coordinates()[0] += Point<2>(1e-3, 0.0);
  write_mesh(file("out.vtk"), moved);
  EXPECT_THAT(refusal(file("out.vtk"), given),
              HasSubstr("it has moved 1 fixed node, by up to 0.001"));
}

TEST_F(ExternalProgram, RefusesOtherCells) {
  const PlanarMesh given = mixed_mesh(false);
  CompressedRows<NodeIndex> fewer, swapped;
  for (std::size_t c = 0; c < given.n_cells(); ++c) {
    const auto nodes = given.topology().cell_nodes(c);
    if (c > 0) fewer.append(nodes);
  }
  write_mesh(file("fewer.vtk"), with_cells(given, fewer));
  EXPECT_THAT(refusal(file("fewer.vtk"), given), HasSubstr("5 cells in place of 6"));
  // A square's other diagonal.
  const std::vector<Point<2>> x = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const auto square = [&](std::vector<std::vector<NodeIndex>> triangles) {
    CompressedRows<NodeIndex> cells;
    for (const auto& t : triangles) cells.append(t);
    return PlanarMesh(std::make_shared<const Topology>(2, x.size(), std::move(cells)), x);
  };
  write_mesh(file("swapped.vtk"), square({{0, 1, 3}, {1, 2, 3}}));
  EXPECT_THAT(refusal(file("swapped.vtk"), square({{0, 1, 2}, {0, 2, 3}})),
              HasSubstr("other cells (2 cells changed)"));
}

TEST_F(ExternalProgram, RefusesOtherNodes) {
  const PlanarMesh given = mixed_mesh(false);
  auto points = given.copied_coordinates();
  points.emplace_back(7.0, 7.0);
  write_mesh(file("out.mesh"), PlanarMesh(std::make_shared<const Topology>(
                                              2, points.size(), given.topology().cells()),
                                          points));
  EXPECT_THAT(refusal(file("out.mesh"), given), HasSubstr("nodes in place of"));
}

/// Four triangles TRI6 around the middle (1, 1) of a square.
PlanarMesh square_of_second_order() {
  CompressedRows<NodeIndex> cells;
  for (NodeIndex k = 0; k < 4; ++k) cells.append(std::array<NodeIndex, 3>{k, (k + 1) % 4, 4});
  return with_midside_nodes(
      PlanarMesh(std::make_shared<const Topology>(2, 5, cells),
                 std::vector<Point<2>>{{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}}));
}

TEST_F(ExternalProgram, MidsideNodesInsideMayMoveAsLongAsCellsAreProvenValid) {
  const PlanarMesh given = square_of_second_order();
  const NodeIndex on_boundary = given.topology().midside_nodes(0)[0],
                  inside = given.topology().midside_nodes(0)[1];
  const auto returned = [&](NodeIndex node, const Point<2>& shift) {
    PlanarMesh moved = given;
    moved.coordinates()[node] += shift;
    write_mesh(file("out.msh"), moved);
    return moved.copied_coordinates();
  };
  const auto points = returned(inside, {0.05, 0.1});
  EXPECT_EQ(returned_coordinates<2>(file("out.msh"), given), points);
  returned(inside, {0.9, 0.0});
  EXPECT_THAT(refusal(file("out.msh"), given),
              HasSubstr("1 curved cell of 4 without a proof that det J is positive"));
  returned(on_boundary, {0.0, 0.1});
  EXPECT_THAT(refusal(file("out.msh"), given), HasSubstr("it has moved 1 fixed node"));
}

TEST_F(ExternalProgram, RefusesOtherMidsideNodesAndLinearCells) {
  const PlanarMesh given = square_of_second_order();
  MeshLabels labels = given.topology().labels();
  auto midside = std::make_shared<MidsideNodes>(*labels.midside);
  midside->of_cells = {};
  for (CellIndex c = 0; c < 4; ++c) {  // nodes of two edges inside change places
    const auto old = given.topology().midside_nodes(c);
    std::vector<NodeIndex> row(old.begin(), old.end());
    const NodeIndex a = given.topology().midside_nodes(0)[1],
                    b = given.topology().midside_nodes(0)[2];
    for (NodeIndex& node : row) node = node == a ? b : node == b ? a : node;
    midside->of_cells.append(row);
  }
  labels.midside = midside;
  auto points = given.copied_coordinates();
  std::swap(points[given.topology().midside_nodes(0)[1]],
            points[given.topology().midside_nodes(0)[2]]);
  write_mesh(file("swapped.msh"),
             PlanarMesh(std::make_shared<const Topology>(
                            2, given.n_nodes(), given.topology().cells(), std::nullopt, labels),
                        points));
  EXPECT_THAT(refusal(file("swapped.msh"), given), HasSubstr("other midside nodes in its cells"));
  // A .vtk file keeps nodes without cells, too.
  write_mesh(file("linear.vtk"), with_linear_cells(given));
  EXPECT_THAT(refusal(file("linear.vtk"), given),
              HasSubstr("linear cells in place of cells of second order"));
}

TEST_F(ExternalProgram, RefusesNonsenseWithoutNamingTheTemporaryFolder) {
  const PlanarMesh given = mixed_mesh(false);
  write_mesh(file("out.mesh"), given);
  std::string text = content_of(file("out.mesh"));
  text.replace(text.find('\n', text.find("nodes")) + 1, 1, "nan");
  file_with("nan.mesh", text);
  EXPECT_THAT(refusal(file("nan.mesh"), given),
              testing::StartsWith("its mesh cannot be read: nan.mesh"));
  write_mesh(file("volume.vtk"), labelled_box(test::BoxCells::tetrahedra));
  EXPECT_THAT(refusal(file("volume.vtk"), given),
              HasSubstr("is a volume mesh, but was given as a planar mesh"));
}

}  // namespace
}  // namespace smoothfem
