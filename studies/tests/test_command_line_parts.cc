// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "smoothing/quality/bad_places.h"
#include "smoothing/tests/planar_meshes.h"
#include "studies/tests/command_line.h"

namespace smoothfem {
namespace {

using testing::HasSubstr;

/// Returns a grid whose only bad cells are around node 24, the middle of 49 nodes.
PlanarMesh grid_with_bad_cells() {
  PlanarMesh mesh = test::grid_mesh(6, test::GridCells::quadrilaterals);
  mesh.coordinates()[24] += Point<2>(0.7, 0.1);
  return mesh;
}

std::size_t n_free(const std::vector<bool>& fixed) {
  return static_cast<std::size_t>(std::count(fixed.begin(), fixed.end(), false));
}

TEST(FixedAwayFromBadCells, RingsOfCellsAroundBadOnesAreFree) {
  const PlanarMesh mesh = grid_with_bad_cells();
  EXPECT_EQ(n_free(fixed_away_from_bad_cells(mesh, 0.9, 0)), 9u);
  EXPECT_FALSE(fixed_away_from_bad_cells(mesh, 0.9, 0)[24]);
  EXPECT_EQ(n_free(fixed_away_from_bad_cells(mesh, 0.9, 1)), 25u);  // all inner nodes
  EXPECT_EQ(n_free(fixed_away_from_bad_cells(mesh, 0.9, 9)), 25u);
}

TEST(FixedAwayFromBadCells, ReportsThatThereIsNothingToDo) {
  const PlanarMesh mesh = test::grid_mesh(4, test::GridCells::quadrilaterals);
  EXPECT_THAT(input_error_of([&] { (void)fixed_away_from_bad_cells(mesh, 0.5, 2); }),
              HasSubstr("raise --only-below"));
  PlanarMesh rim = test::grid_mesh(1, test::GridCells::quadrilaterals);
  rim.coordinates()[0] += Point<2>(0.6, 0.3);
  EXPECT_THAT(input_error_of([&] { (void)fixed_away_from_bad_cells(rim, 0.99, 2); }),
              HasSubstr("free nodes by --fix"));
}

TEST_F(CommandLine, OnlyBelowMovesNodesNearBadCellsOnly) {
  const PlanarMesh given = grid_with_bad_cells();
  write_mesh(file("in.mesh"), given);
  const Outcome outcome =
      smoothfem({"smooth", "in.mesh", "-m", "laplace", "--set", "tolerance=0", "--set",
                 "max_iterations=20", "--only-below", "0.9", "--rings", "0", "-o", "out.mesh"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const PlanarMesh smoothed = read_planar(file("out.mesh")).mesh;
  const auto fixed = fixed_away_from_bad_cells(given, 0.9, 0);
  for (NodeIndex i = 0; i < given.n_nodes(); ++i)
    if (fixed[i]) {
      EXPECT_EQ(smoothed.coordinates()[i], given.coordinates()[i]) << i;
    }
  EXPECT_NE(smoothed.coordinates()[24], given.coordinates()[24]);
  // The fixed nodes of the file have not changed.
  EXPECT_EQ(smoothed.topology().free_nodes(), given.topology().free_nodes());
  const Outcome refused =
      smoothfem({"smooth", "out.mesh", "-m", "laplace", "--only-below", "0.1", "-o", "none.mesh"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("no cell has a mean ratio below 0.1"));
}

/// A mesh of 9 squares, as a whole and in pieces: the refined one has 36. Its fields are named.
TEST_F(CommandLine, MeshesAreRefined) {
  const PlanarMesh grid = shaken_grid(3, 0.2);
  write_mesh(file("whole.vtu"), grid, {{}, {{"heat", std::vector<double>(16, 1.0)}}});
  ASSERT_EQ(smoothfem({"convert", "whole.vtu", "in.pvtu", "--pieces", "2"}).exit_code, 0);
  const Outcome whole = smoothfem({"convert", "whole.vtu", "finer.vtu", "--refine"});
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_THAT(whole.out, HasSubstr("49 nodes, 36 cells"));
  const Outcome pieces = smoothfem_on_ranks(2, {"convert", "in.pvtu", "finer.pvtu", "--refine"});
  EXPECT_EQ(pieces.exit_code, 0) << pieces.err;
  EXPECT_EQ(pieces.out, "finer.pvtu: 36 cells in 2 pieces\n");
  EXPECT_EQ(read_planar(file("finer.pvtu")).mesh.n_cells(), 36u);
  for (const Outcome& outcome : {whole, pieces})
    EXPECT_THAT(outcome.err, HasSubstr("refinement leaves out: the field heat\n"));
  // The inner nodes of the refined mesh are free, new ones, too.
  EXPECT_EQ(read_planar(file("finer.vtu")).mesh.topology().free_nodes().size(), 25u);
}

TEST_F(CommandLine, OneProcessDividesAMesh) {
  write_mesh(file("in.vtu"), shaken_grid(3, 0.2));
  const Outcome several = smoothfem_on_ranks(2, {"convert", "in.vtu", "out.pvtu"});
  EXPECT_EQ(several.exit_code, 2);
  EXPECT_THAT(several.err, HasSubstr("leave out mpirun"));
  EXPECT_FALSE(std::filesystem::exists(file("out.pvtu")));
  ASSERT_EQ(smoothfem({"convert", "in.vtu", "out.pvtu", "--pieces", "3"}).exit_code, 0);
  std::filesystem::copy(file("out.pvtu"), file("list.pvtu"));
  const Outcome replaced = smoothfem({"convert", "list.pvtu", "out.pvtu", "--pieces", "2"});
  EXPECT_EQ(replaced.exit_code, 2);
  EXPECT_THAT(replaced.err, HasSubstr("would replace"));
  const Outcome joined = smoothfem({"convert", "list.pvtu", "two.pvtu", "--pieces", "2"});
  EXPECT_THAT(joined.out, HasSubstr("16 nodes, 9 cells"));
  EXPECT_EQ(smoothfem({"convert", "in.vtu", "out.vtk", "--pieces", "2"}).exit_code, 2);
}

TEST_F(CommandLine, RefinementSaysWhatToDo) {
  write_mesh(file("whole.vtu"), shaken_grid(3, 0.2));
  const auto refused = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "convert");
    words.push_back("--refine");
    const Outcome outcome = smoothfem(words);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(refused({"whole.vtu", "out.pvtu"}),
              HasSubstr("make one by 'smoothfem convert whole.vtu pieces.pvtu --pieces N'"));
  EXPECT_THAT(refused({"in.pvtu", "out.pvtu", "--pieces", "3"}), HasSubstr("--pieces"));
  file_with("surface.mesh",
            "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n"
            "0 0 1 0\nTriangles\n4\n1 3 2 0\n1 2 4 0\n2 3 4 0\n1 4 3 0\nEnd\n");
  EXPECT_THAT(refused({"surface.mesh", "out.vtu"}), HasSubstr("surface meshes cannot be refined"));
  file_with(
      "hanging.mesh",
      "MeshVersionFormatted 2\nDimension 2\nVertices\n8\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n"
      "3 0 0\n3 1 0\n2 1 0\n3 2 0\nQuadrilaterals\n3\n1 2 3 4 0\n2 5 6 7 0\n7 6 8 3 0\nEnd\n");
  EXPECT_THAT(refused({"hanging.mesh", "out.vtu"}), HasSubstr("hanging"));
  EXPECT_FALSE(std::filesystem::exists(file("out.pvtu")) ||
               std::filesystem::exists(file("out.vtu")));
}

TEST_F(CommandLine, DryRunPrintsThePlanAndWritesNothing) {
  write_mesh(file("grid.vtu"), shaken_grid(6, 0.2));
  file_with("my.prm",
            "set meshes = m\nset methods = laplace, getme\nset degrees = 1, 2\n"
            "subsection mesh m\n set file = grid.vtu\nend\n");
  const Outcome outcome = smoothfem({"study", "my.prm", "--dry-run"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("49 nodes, 36 cells, 49 dofs at degree 1, 169 dofs at degree 2"));
  EXPECT_THAT(outcome.out, HasSubstr("Nothing has been written."));
  EXPECT_FALSE(std::filesystem::exists(file("results")));
  const Outcome tables = smoothfem({"study", "polygons", "--dry-run"});
  EXPECT_EQ(tables.exit_code, 0) << tables.err;
  EXPECT_THAT(tables.out, HasSubstr(".csv"));
  EXPECT_FALSE(std::filesystem::exists(file("results")));
}

TEST_F(CommandLine, LookingAtAStudyRunsNothingOfIt) {
  write_mesh(file("grid.vtu"), shaken_grid(3, 0.2));
  file_with("evil.py", "open('ran', 'w')\nclass Mine:\n    def step(self, mesh):\n        pass\n");
  file_with("evil.prm",
            "set meshes = m\nset methods = mine, other\nset degrees = 1\n"
            "subsection mesh m\n set file = grid.vtu\nend\n"
            "subsection method mine\n set type = python:evil.py:Mine\nend\n"
            "subsection method other\n set command = cp {in} {out}\n"
            " set version_command = touch " +
                file("ran").string() + "\nend\n");
  for (const std::string option : {"--dry-run", "--print-plan"}) {
    const Outcome outcome = smoothfem({"study", "evil.prm", option});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr(option == "--dry-run" ? "python:evil.py:Mine" : "ranks 1"));
    EXPECT_FALSE(std::filesystem::exists(file("ran"))) << option;
  }
}

TEST_F(CommandLine, EveryHelpHasExamples) {
  for (const std::string command :
       {"study", "smooth", "quality", "generate", "list", "new-smoother"})
    EXPECT_THAT(smoothfem({command, "--help"}).out, HasSubstr("Examples:\n  smoothfem " + command))
        << command;
}

}  // namespace
}  // namespace smoothfem
