// SPDX-License-Identifier: GPL-3.0-or-later
// Output of smooth and quality about their results.
#include <algorithm>

#include "smoothing/quality/mesh_quality.h"
#include "smoothing/tests/volume_meshes.h"
#include "studies/tests/command_line.h"

namespace smoothfem {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Results : public CommandLine {
 protected:
  /// Makes a grid of three quarters of an annulus, which Laplacian smoothing pulls over its inner
  /// circle.
  Results() {
    constexpr std::uint32_t n = 6;
    std::vector<Point<2>> x;
    for (std::uint32_t j = 0; j <= n; ++j)
      for (std::uint32_t i = 0; i <= n; ++i) {
        const double angle = 1.5 * std::numbers::pi * i / n, radius = 1.0 + 3.0 * j / n;
        x.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
      }
    test::Cells cells;
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < n; ++i) {
        const NodeIndex a = j * (n + 1) + i;
        cells.push_back({a, a + n + 1, a + n + 2, a + 1});
      }
    write_mesh(file("bent.vtk"), test::make_mesh(x, cells));
    write_mesh(file("good.mesh"), shaken_grid(6, 0.3));
  }
};

TEST_F(Results, SmoothSaysWhyEachStageStopped) {
  const Outcome getme = smoothfem(
      {"smooth", "good.mesh", "-m", "getme", "-o", "o.mesh", "--set", "sequential.perfect=0"});
  EXPECT_EQ(getme.exit_code, 0);
  EXPECT_THAT(getme.out,
              AllOf(HasSubstr("simultaneous stopped after "),
                    HasSubstr("sequential stopped after "), HasSubstr(": no improvement in ")));
  const Outcome laplace = smoothfem({"smooth", "good.mesh", "-m", "laplace", "-o", "o.mesh"});
  EXPECT_THAT(laplace.out, HasSubstr("no node moved farther than 0.01 mean edge lengths"));
  const Outcome cut = smoothfem(
      {"smooth", "good.mesh", "-m", "laplace", "-o", "o.mesh", "--set", "max_iterations=1"});
  EXPECT_THAT(cut.out, HasSubstr("stopped after 1: reached max_iterations"));
}

TEST_F(Results, SmoothSaysWhenNothingWasBetterThanTheInitialMesh) {
  write_mesh(file("regular.mesh"), test::grid_mesh(4, test::GridCells::quadrilaterals));
  const Outcome outcome =
      smoothfem({"smooth", "regular.mesh", "-m", "smart-laplace", "-o", "o.mesh"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("the result is the initial mesh"));
}

TEST_F(Results, ReportsInvalidCellsThatSmoothingMakes) {
  ASSERT_EQ(smoothfem({"quality", "bent.vtk"}).exit_code, 0);
  const Outcome warned =
      smoothfem({"smooth", "bent.vtk", "-m", "laplace", "-o", "o.vtk", "--quiet", "--allow-worse"});
  EXPECT_EQ(warned.exit_code, 0);
  EXPECT_THAT(warned.err, AllOf(HasSubstr("warning: "), HasSubstr("of 36 cells of the smoothed"),
                                HasSubstr("--fail-if-invalid")));
  EXPECT_EQ(smoothfem({"quality", "o.vtk"}).exit_code, 2);
  const Outcome refused = smoothfem({"smooth", "bent.vtk", "-m", "laplace", "-o", "new.vtk",
                                     "--fail-if-invalid", "--quiet", "--allow-worse"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("so new.vtk is not written"));
  EXPECT_FALSE(std::filesystem::exists(file("new.vtk")));
  EXPECT_EQ(smoothfem({"smooth", "bent.vtk", "-m", "smart-laplace", "-o", "o.vtk",
                       "--fail-if-invalid", "--quiet"})
                .err,
            "");
}

TEST_F(Results, NoCellBecomesWorseThanTheWorstOneUnlessAllowed) {
  const double before = mesh_quality(planar_mesh(read_mesh(file("bent.vtk")), "bent.vtk")).q_min;
  const Outcome outcome = smoothfem({"smooth", "bent.vtk", "-m", "laplace", "-o", "o.vtk"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("warning: Laplace made "),
                                 HasSubstr("of 36 cells invalid"), HasSubstr("--allow-worse")));
  EXPECT_GE(mesh_quality(planar_mesh(read_mesh(file("o.vtk")), "o.vtk")).q_min, before);
}

TEST_F(Results, QualityMarksAndListsBadCells) {
  smoothfem({"smooth", "bent.vtk", "-m", "laplace", "-o", "o.vtk", "--quiet", "--allow-worse"});
  const Outcome outcome = smoothfem({"quality", "o.vtk", "--mark", "marked.vtk"});
  EXPECT_EQ(outcome.exit_code, 2) << "it has invalid cells";
  const MeshFile marked = read_mesh(file("marked.vtk"));
  const auto quality = cell_mean_ratios(planar_mesh(marked, "marked.vtk"));
  const auto n_invalid = std::count(quality.begin(), quality.end(), 0.0);
  ASSERT_GT(n_invalid, 0);
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr(std::to_string(n_invalid) + " cells are invalid or below"),
                    HasSubstr("  cell "), HasSubstr("mean ratio 0  at ")));
  EXPECT_THAT(content_of(file("marked.vtk")), HasSubstr("bad"));

  const Outcome below =
      smoothfem({"quality", "good.mesh", "--mark", "marked.vtk", "--below", "0.9"});
  EXPECT_EQ(below.exit_code, 0);
  const auto of_good = cell_mean_ratios(planar_mesh(read_mesh(file("good.mesh")), "good.mesh"));
  const auto n_below =
      std::count_if(of_good.begin(), of_good.end(), [](double q) { return q < 0.9; });
  ASSERT_GT(n_below, 0);
  EXPECT_THAT(below.out, HasSubstr(std::to_string(n_below) + " cells are invalid or below 0.9"));
  EXPECT_THAT(smoothfem({"quality", "good.mesh", "--below", "0.9"}).err, HasSubstr("--mark"));
  EXPECT_THAT(smoothfem({"quality", "good.mesh", "--mark", "m.vtk", "--below", "2"}).err,
              HasSubstr("between 0 and 1"));
}

TEST_F(Results, AFullDeviceBehindStandardOutputIsAnError) {
  for (const std::string words :
       {"list", "quality good.mesh", "smooth good.mesh -m getme -o o.mesh"}) {
    const int status = std::system(("cd " + quoted(file("").string()) + " && " +
                                    quoted(SMOOTHFEM_PROGRAM) + " " + words + " > /dev/full 2> err")
                                       .c_str());
    EXPECT_EQ(WEXITSTATUS(status), 2) << words;
    EXPECT_THAT(content_of(file("err")), HasSubstr("cannot write to standard output: ")) << words;
  }
}

TEST_F(Results, MeshesGoThroughPipes) {
  const auto shell = [&](const std::string& command) {
    const std::string program = quoted(SMOOTHFEM_PROGRAM);
    std::string text = "cd " + quoted(file("").string()) + " && ";
    for (const char c : command) text += c == '@' ? program : std::string(1, c);
    return WEXITSTATUS(std::system((text + " 2> err").c_str()));
  };
  ASSERT_EQ(shell("@ smooth good.mesh -m laplace -o direct.vtu > /dev/null"), 0);
  EXPECT_EQ(shell("cat good.mesh | @ smooth - --from mesh -m laplace -o - --to .vtu > piped.vtu"),
            0);
  EXPECT_EQ(content_of(file("piped.vtu")), content_of(file("direct.vtu")));
  EXPECT_EQ(shell("@ quality --json direct.vtu > a; @ quality --json - --from vtu < piped.vtu > b"),
            0);
  EXPECT_EQ(content_of(file("a")), content_of(file("b")));
  EXPECT_EQ(shell("@ generate gear --edge-scale 4 -o - --to msh > g.msh && @ quality g.msh > c"),
            0);
  EXPECT_EQ(shell("@ quality - < good.mesh"), 2);
  EXPECT_THAT(content_of(file("err")), HasSubstr("--from"));
  EXPECT_EQ(shell("@ quality - --from msh < /dev/null"), 2);
  EXPECT_THAT(content_of(file("err")), HasSubstr("standard-input.msh"));
  EXPECT_EQ(shell("@ quality good.mesh --from msh"), 2);
  EXPECT_EQ(shell("@ smooth good.mesh -m laplace -o - --to vtu > /dev/full"), 2);
}

TEST_F(Results, ListShowsRangesAndWhichMeshesAParameterIsFor) {
  const std::string list = smoothfem({"list"}).out;
  EXPECT_THAT(list, AllOf(HasSubstr("subdivision ratio of the polygon sides (Section 2.3); (0, 1); "
                                    "default: printed, Section 6.2 [planar meshes]"),
                          HasSubstr("; opposite-face-normals or dual-element; default: "),
                          HasSubstr("(Eq. 3.12); (0, 1]; default: printed, Chapter 6\n")));
  EXPECT_THAT(smoothfem({"list", "--study-keys"}).out, HasSubstr("subsection method LABEL"));
}

TEST_F(Results, ListHasParts) {
  const std::string method = smoothfem({"list", "laplace"}).out;
  EXPECT_TRUE(method.starts_with("  laplace: Laplace\n")) << method;
  EXPECT_THAT(method, HasSubstr("max_iterations"));
  EXPECT_EQ(method.find("smart-laplace"), std::string::npos);
  const std::string methods = smoothfem({"list", "methods"}).out;
  EXPECT_THAT(methods, HasSubstr("  getme "));
  EXPECT_EQ(methods.find("max_iterations"), std::string::npos) << "one line each";
  std::string all;
  for (const std::string part :
       {"presets", "studies", "domains", "solutions", "solvers", "metrics", "transformations"})
    all += smoothfem({"list", part}).out + "\n";
  EXPECT_THAT(smoothfem({"list"}).out, HasSubstr(all + smoothfem({"list", "formats"}).out));
}

TEST_F(Results, ListLoadsOnlyTheLibrariesOfItsPart) {
  const auto loaded = [&](const std::string& part) {
    const std::string command = "LD_DEBUG=files " + quoted(SMOOTHFEM_PROGRAM) + " list " + part;
    EXPECT_EQ(std::system((command + " > " + quoted(file("loaded").string()) + " 2>&1").c_str()),
              0);
    return content_of(file("loaded"));
  };
  EXPECT_THAT(loaded("methods"), AllOf(HasSubstr("libsmoothfem"), Not(HasSubstr("libgmsh")),
                                       Not(HasSubstr("libdeal"))));
  EXPECT_THAT(loaded("domains"), AllOf(HasSubstr("libgmsh"), Not(HasSubstr("libdeal"))));
}

TEST_F(Results, StudyKeysBeginWithWhatMostStudiesSet) {
  const std::string all = smoothfem({"list", "--study-keys"}).out;
  EXPECT_TRUE(all.starts_with("# Keys of studies of the kind smoothing\n"));
  std::vector<std::size_t> places;
  for (const std::string key :
       {"set kind", "set title", "set meshes", "set methods", "set degrees", "set preset",
        "subsection mesh LABEL", "subsection solution", " set u ", " set value "})
    places.push_back(all.find(key));
  EXPECT_TRUE(std::is_sorted(places.begin(), places.end()));
  EXPECT_NE(places.back(), std::string::npos);
  EXPECT_TRUE(smoothfem({"list", "--study-keys", "collection"})
                  .out.starts_with("# Keys of studies of the kind collection\n"));
}

}  // namespace
}  // namespace smoothfem
