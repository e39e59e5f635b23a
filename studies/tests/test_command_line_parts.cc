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
