#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "fem/manufactured_solution.h"
#include "meshes/generators/domains.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/quality/dihedral_angles.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/quality/warpage.h"
#include "smoothing/tests/volume_meshes.h"
#include "studies/tests/command_line.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;

TEST_F(CommandLine, EveryMethodSmoothsAMeshWithPentagons) {
  write_mesh(file("in.vtu"), mixed_mesh(true));
  for (const auto& info : method_catalogue()) {
    const std::string out = info.name + ".vtu";
    const Outcome smoothed = smoothfem({"smooth", "in.vtu", "-m", info.name, "-o", out});
    EXPECT_EQ(smoothed.exit_code, 0) << info.name << ": " << smoothed.err;
    EXPECT_NE(smoothed.out.find(out), std::string::npos) << smoothed.out;
    const Outcome quality = smoothfem({"quality", out, "--json"});
    EXPECT_EQ(quality.exit_code, 0) << info.name << ": " << quality.err;
    EXPECT_EQ(read_planar(file(out)).mesh.topology().cells(), mixed_mesh(true).topology().cells());
  }
}

TEST_F(CommandLine, FormatsAreConvertedWithoutALossOfDigits) {
  // No iteration moves anything when no node is free.
  const PlanarMesh grid = shaken_grid(3, 0.2);
  const PlanarMesh mesh(
      std::make_shared<const Topology>(2, grid.n_nodes(), grid.topology().cells(),
                                       std::vector<bool>(grid.n_nodes(), true), MeshLabels{}),
      grid.coordinates());
  write_mesh(file("a.mesh"), mesh);
  std::string last = "a.mesh";
  for (const std::string next : {"b.vtu", "c.vtk", "d.mesh"}) {
    const Outcome outcome =
        smoothfem({"smooth", last, "-m", "smart-laplace", "-o", next, "--quiet"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.out + outcome.err, "") << "--quiet prints nothing";
    last = next;
  }
  EXPECT_EQ(content_of(file("d.mesh")), content_of(file("a.mesh")));
}

TEST_F(CommandLine, SmoothWritesALogAndASeries) {
  write_mesh(file("in.mesh"), shaken_grid(6, 0.2));
  const Outcome outcome =
      smoothfem({"smooth", "in.mesh", "-m", "getme", "-o", "out.mesh", "--log", "rows.csv",
                 "--series", "frames.pvd", "--set", "simultaneous.lambda=0.4"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const CsvTable log(content_of(file("rows.csv")));
  ASSERT_GT(log.rows.size(), 2u);
  EXPECT_EQ(log.rows.front().at("stage"), "initial");
  EXPECT_EQ(log.rows.front().at("mesh"), "in");
  EXPECT_EQ(std::stod(log.rows.front().at("q_mean")), mesh_quality(shaken_grid(6, 0.2)).q_mean);
  std::size_t n_frames = 0;
  for (const auto& entry : fs::directory_iterator(file("frames")))
    n_frames += entry.path().extension() == ".vtu";
  EXPECT_EQ(n_frames, log.rows.size());
  EXPECT_TRUE(fs::exists(file("frames.pvd")));
}

TEST_F(CommandLine, SettingsChangeTheResult) {
  write_mesh(file("in.mesh"), shaken_grid(6, 0.2));
  for (const std::string lambda : {"0.4", "0.6"})
    ASSERT_EQ(smoothfem({"smooth", "in.mesh", "-m", "getme-simultaneous", "-o",
                         "out" + lambda + ".mesh", "--set", "lambda=" + lambda})
                  .exit_code,
              0);
  EXPECT_NE(content_of(file("out0.4.mesh")), content_of(file("out0.6.mesh")));
}

TEST_F(CommandLine, QualityAsTextAndAsJson) {
  write_mesh(file("in.mesh"), mixed_mesh(true));
  const MeshQuality expected = mesh_quality(mixed_mesh(true));
  const Outcome text = smoothfem({"quality", "in.mesh"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  char q_mean[16];
  std::snprintf(q_mean, sizeof q_mean, "%.6f", expected.q_mean);
  EXPECT_NE(text.out.find(q_mean), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("1 5-gon"), std::string::npos) << text.out;
  const auto json = nlohmann::json::parse(smoothfem({"quality", "in.mesh", "--json"}).out);
  EXPECT_EQ(json.at("n_nodes"), 10);
  EXPECT_EQ(json.at("n_cells"), 5);
  EXPECT_EQ(json.at("n_invalid"), 0);
  EXPECT_EQ(json.at("q_min"), expected.q_min);
  EXPECT_EQ(json.at("q_star_min"), expected.q_star_min);
  EXPECT_EQ(json.at("q_mean"), expected.q_mean);
  EXPECT_EQ(json.at("angle_min"), angle_range(mixed_mesh(true)).min);
  EXPECT_EQ(json.at("angle_max"), angle_range(mixed_mesh(true)).max);
}

TEST_F(CommandLine, QualityOfAVolumeMeshHasWarpageAndDihedralAngles) {
  VolumeMesh mesh = test::box_mesh(2, 1, 1, test::BoxCells::hexahedra);
  mesh.coordinates()[1].x() += 0.5;
  write_mesh(file("in.vtu"), mesh);
  const Outcome outcome = smoothfem({"quality", "in.vtu", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("cells").at("hexahedron"), 2);
  EXPECT_EQ(json.at("n_fixed_nodes"), 12);
  EXPECT_EQ(json.at("q_min"), mesh_quality(mesh).q_min);
  EXPECT_EQ(json.at("warpage_max"), mesh_warpage(mesh).max);
  EXPECT_EQ(json.at("warpage_mean"), mesh_warpage(mesh).mean);
  EXPECT_EQ(json.at("dihedral_min"), angle_range(mesh).min);
  EXPECT_EQ(json.at("dihedral_max"), angle_range(mesh).max);
  const Outcome text = smoothfem({"quality", "in.vtu"});
  EXPECT_NE(text.out.find("2 hexahedra"), std::string::npos) << text.out;
}

TEST_F(CommandLine, QualityDrawsAHistogram) {
  write_mesh(file("in.vtu"), test::box_mesh(2, 2, 4, test::BoxCells::mixed));
  for (const auto& [name, head] : {std::pair{"a.png", "\x89PNG"}, {"new/a.pdf", "%PDF"}}) {
    const Outcome outcome = smoothfem({"quality", "in.vtu", "--histogram", name});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(content_of(file(name)).starts_with(head));
  }
  const Outcome other = smoothfem({"quality", "in.vtu", "--histogram", "a.bmp"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("must end with .png, .pdf or .svg"), std::string::npos) << other.err;
  ::setenv("SMOOTHFEM_PYTHON", "/nowhere/python3", 1);
  const Outcome no_python = smoothfem({"quality", "in.vtu", "--histogram", "b.png"});
  ::unsetenv("SMOOTHFEM_PYTHON");
  EXPECT_EQ(no_python.exit_code, 2);
  EXPECT_NE(no_python.err.find("there is no Python at /nowhere/python3; set SMOOTHFEM_PYTHON"),
            std::string::npos)
      << no_python.err;
  EXPECT_FALSE(fs::exists(file("b.png")));
}

TEST_F(CommandLine, QualityOfAnInvalidMeshIsShownBeforeItIsRefused) {
  PlanarMesh inverted = shaken_grid(4, 0.0);
  inverted.coordinates()[6] = {3.5, 3.5};
  write_mesh(file("in.vtu"), inverted);
  const Outcome outcome = smoothfem({"quality", "in.vtu", "--json"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_GT(nlohmann::json::parse(outcome.out).at("n_invalid").get<int>(), 0);
}

TEST_F(CommandLine, ListNamesEverythingThereIs) {
  const Outcome list =
      smoothfem({"list", "--studies", (fs::path(SMOOTHFEM_SOURCE_DIR) / "studies").string()});
  ASSERT_EQ(list.exit_code, 0) << list.err;
  const auto expect_listed = [&](const std::string& name) {
    EXPECT_NE(list.out.find(" " + name), std::string::npos) << name;
  };
  for (const auto& info : method_catalogue()) {
    expect_listed(info.name);
    Method<2> method = make_method<2>(info.name);
    for (const auto& parameter : method.parameters()) expect_listed(parameter.name);
  }
  for (const auto& format : mesh_formats()) expect_listed(format.extension);
  for (const auto& domain : domains()) expect_listed(domain.name);
  for (const auto& solution : manufactured_solutions()) expect_listed(solution.name);
  expect_listed("gear             Involute gear");  // the study, by its title
}

TEST_F(CommandLine, ListOfStudyKeysIsAStudyFile) {
  const Outcome keys = smoothfem({"list", "--study-keys"});
  EXPECT_EQ(keys.exit_code, 0);
  for (const std::string key : {"set meshes", "set record every", "subsection finite elements"})
    EXPECT_NE(keys.out.find(key), std::string::npos) << key;
}

TEST_F(CommandLine, GeneratesAndDistorts) {
  for (const std::string elements : {"triangles", "quadrilaterals"}) {
    const std::string out = elements + ".msh";
    const Outcome outcome = smoothfem({"generate", "gear", "-o", out, "--elements", elements,
                                       "--edge-scale", "3", "--distort-to", "0.5", "--seed", "3"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto json = nlohmann::json::parse(smoothfem({"quality", out, "--json"}).out);
    EXPECT_NEAR(json.at("q_mean").get<double>(), 0.5, 1e-4);
    EXPECT_EQ(json.at("n_invalid"), 0);
    EXPECT_EQ(json.at("cells").size(), 1u) << "all of one type";
  }
}

const std::string own_study = R"(
set title   = My square
set meshes  = mine
set methods = smart-laplace, gentle
set timing runs = 1
subsection mesh mine
  set file = meshes/mine.vtk
end
subsection method gentle
  set type   = getme-simultaneous
  set lambda = 0.3
end
subsection solution
  set name     = expression
  set value    = x^2*y
  set gradient = 2*x*y ; x^2
  set load     = -2*y
end
)";

TEST_F(CommandLine, RunsAStudyOfOnesOwn) {
  write_mesh(file("meshes/mine.vtk"), shaken_grid(5, 0.2));
  file_with("my.prm", own_study);
  const Outcome outcome = smoothfem({"study", "my.prm"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const CsvTable summary(content_of(file("results/my/summary.csv")));
  EXPECT_EQ(summary.select({{"study", "my"}, {"mesh", "mine"}, {"status", "ok"}}).size(), 6u);
  EXPECT_EQ(summary.select({{"method", "gentle"}}).size(), 2u);
  for (const auto& row : summary.rows) EXPECT_LT(std::stod(row.at("e_max")), 1.0);
}

TEST_F(CommandLine, QuietStudiesPrintNothing) {
  write_mesh(file("meshes/mine.vtk"), shaken_grid(3, 0.2));
  file_with("my.prm", own_study + "set degrees = 1\n");
  const Outcome outcome =
      smoothfem({"study", "my.prm", "--out", "here", "--quiet", "--threads", "1", "--quick"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  const auto json = nlohmann::json::parse(content_of(file("here/provenance.json")));
  EXPECT_EQ(json.at("quick"), true);
  EXPECT_EQ(json.at("machine").at("finite_element_threads"), 1);
}

TEST_F(CommandLine, AnInterruptedStudyLeavesTheRowsItHas) {
  // GETMe's hundreds of iterations take far longer on one thread than the first rows.
  write_mesh(file("fine.vtu"), shaken_grid(70, 0.2));
  file_with("long.prm",
            "set meshes = m\nset methods = laplace, getme\nset degrees = 2\n"
            "set timing runs = 1\nsubsection mesh m\n set file = fine.vtu\nend\n");
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::execl(SMOOTHFEM_PROGRAM, "smoothfem", "study", file("long.prm").c_str(), "--out",
            file("out").c_str(), "--quiet", "--threads", "1", nullptr);
    ::_exit(127);
  }
  const fs::path rows = file("out") / "iterations.csv";
  int status = 0;
  const auto has_rows = [&] {
    const std::string text = content_of(rows);
    return std::count(text.begin(), text.end(), '\n') > 1;
  };
  for (int tenth = 0; tenth < 1200 && !has_rows(); ++tenth) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ASSERT_EQ(::waitpid(child, &status, WNOHANG), 0) << "the study ended too early";
  }
  ::kill(child, SIGINT);
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  const CsvTable table(content_of(rows));  // checks that every line is whole
  EXPECT_GE(table.rows.size(), 1u);
  for (const auto& row : table.rows) EXPECT_EQ(row.at("status"), "ok");
  EXPECT_EQ(nlohmann::json::parse(content_of(file("out") / "provenance.json")).at("status"),
            "interrupted");
  EXPECT_FALSE(fs::exists(file("out") / "summary.csv"));
}

}  // namespace
}  // namespace smoothfem
