// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/tests/planar_meshes.h"
#include "smoothing/tests/volume_meshes.h"
#include "studies/framework/definition/study.h"
#include "studies/framework/run/run_study.h"
#include "studies/tests/command_line.h"

namespace smoothfem {
namespace {

/// One smoother, optimal Delaunay triangulation, written in four ways: in tree, as a plugin, in
/// Python and as a command. odt/odt.cc is compiled into this test, and into a plugin.
class FourWays : public CommandLine {
 protected:
  static constexpr const char* first_lines =
      "set degrees = 1\nset timing runs = 1\nset meshes = m\n"
      "subsection mesh m\n set file = in.vtu\nend\n"
      "subsection finite elements\n set cg tolerance = 1e-13\nend\n";

  /// Runs the iterations of the study in tree, and in the program with the three other ways.
  void run_all(const std::string& head) {
    const std::filesystem::path sources = SMOOTHFEM_SOURCE_DIR;
    file_with("tree.prm",
              head + "set methods = odt\n" + first_lines +
                  "subsection method odt\n set max_iterations = 4\n set tolerance = -1\nend\n");
    StudyOptions options;
    options.out = file("tree");
    options.quiet = true;
    run_study(read_study(file("tree.prm")), options);
    file_with("others.prm",
              head + "set methods = odt, python, command\nset plugins = " + SMOOTHFEM_ODT_PLUGIN +
                  "\n" + first_lines +
                  "subsection method odt\n set max_iterations = 4\n set tolerance = -1\nend\n"
                  "subsection method python\n set type = python:" +
                  (sources / "python/examples/odt.py").string() +
                  ":OptimalDelaunay\n set max_iterations = 4\n set tolerance = -1\nend\n"
                  "subsection method command\n set command = " +
                  (sources / "studies/tests/odt/odt_command.py").string() +
                  " {in} {out} {iterations}\n set max_iterations = 4\n set every = 1\nend\n");
    const Outcome outcome = smoothfem({"study", "others.prm", "--out", "others", "--quiet"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  void expect_the_same() const {
    const CsvTable tree(content_of(file("tree/iterations.csv"))),
        others(content_of(file("others/iterations.csv"))),
        summary(content_of(file("others/summary.csv")));
    ASSERT_EQ(tree.rows.size(), 5u);
    for (const auto& row : tree.rows) {
      ASSERT_EQ(row.at("n_reset"), "0") << "the command knows of no invalid cells";
      for (const std::string method : {"odt", "python", "command"}) {
        const auto found = others.select({{"method", method}, {"iteration", row.at("iteration")}});
        ASSERT_EQ(found.size(), 1u) << method;
        for (const std::string column : {"q_min", "q_mean", "e_max", "e_l2", "e_h1", "h1_error"}) {
          const double value = std::stod(found[0].at(column)), wanted = std::stod(row.at(column));
          if (method == "odt")
            EXPECT_EQ(found[0].at(column), row.at(column)) << column;
          else
            EXPECT_NEAR(value, wanted, 1e-12 * std::max(1.0, std::abs(wanted)))
                << method << " " << column;
        }
      }
    }
    for (const std::string method : {"odt", "python", "command"})
      EXPECT_EQ(summary.select({{"method", method}}).at(0).at("status"), "ok") << method;
  }
};

TEST_F(FourWays, AgreeOnTriangles) {
  PlanarMesh mesh = test::grid_mesh(12, test::GridCells::triangles, true);
  test::distort(mesh, 0.15, 3);
  write_mesh(file("in.vtu"), mesh);
  ASSERT_NO_FATAL_FAILURE(run_all(""));
  expect_the_same();
}

TEST_F(FourWays, AgreeOnTetrahedra) {
  ASSERT_EQ(smoothfem({"generate", "flange", "--elements", "tetrahedra", "--edge-scale", "4",
                       "--distort-to", "0.75", "-o", "in.vtu"})
                .exit_code,
            0);
  ASSERT_NO_FATAL_FAILURE(
      run_all("set dimension = 3\nsubsection solution\n set name = volume\nend\n"));
  expect_the_same();
}

}  // namespace
}  // namespace smoothfem
