// SPDX-License-Identifier: GPL-3.0-or-later
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <thread>

#include "fem/solutions/manufactured_solution.h"
#include "meshes/domains/catalogue.h"
#include "smoothing/getme/element_parameters.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/preset.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/quality/dihedral_angles.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/quality/warpage.h"
#include "smoothing/tests/methods.h"
#include "smoothing/tests/volume_meshes.h"
#include "studies/tests/command_line.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;

TEST_F(CommandLine, EveryMethodSmoothsAMeshWithPentagons) {
  write_mesh(file("in.vtu"), mixed_mesh(true));
  for (const auto& info : method_catalogue()) {
    if (!supports_mesh_kind<2>(info.name)) continue;
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
      grid.copied_coordinates());
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

/// Gmsh files of version 4.0 are written as 4.1.
TEST_F(CommandLine, GmshFilesOfVersion4_0AreSmoothedAndDamagedOnesRefused) {
  const std::string content =
      "$MeshFormat\n4 0 8\n$EndMeshFormat\n$Nodes\n1 5\n1 2 0 5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 "
      "0\n"
      "5 .8 .7 0\n$EndNodes\n$Elements\n1 4\n1 2 2 4\n1 1 2 5\n2 2 3 5\n3 3 4 5\n4 4 1 5\n"
      "$EndElements\n";
  std::ofstream(file("in.msh")) << content;
  const Outcome outcome = smoothfem({"smooth", "in.msh", "-m", "laplace", "-o", "out.msh"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(content_of(file("out.msh")).starts_with("$MeshFormat\n4.1 "));
  EXPECT_EQ(read_planar(file("out.msh")).mesh.copied_coordinates()[4], Point<2>(.5, .5));
  std::ofstream(file("damaged.msh")) << content.substr(0, content.find("3 3 4 5"));
  const Outcome damaged = smoothfem({"quality", "damaged.msh"});
  EXPECT_EQ(damaged.exit_code, 2);
  EXPECT_NE(damaged.err.find("the file ends before element 3 of 4"), std::string::npos)
      << damaged.err;
}

TEST_F(CommandLine, SmoothWritesALogAndASeries) {
  write_mesh(file("in.mesh"), shaken_grid(6, 0.2));
  const Outcome outcome =
      smoothfem({"smooth", "in.mesh", "-m", "getme-simultaneous", "-o", "out.mesh", "--log",
                 "rows.csv", "--series", "frames.pvd", "--set", "lambda=0.4"});
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

/// Returns 3 x 3 x 4 cells of all types, shaken. The bottom faces are the group 5, "inlet".
VolumeMesh shaken_box(test::BoxCells kind = test::BoxCells::mixed) {
  VolumeMesh mesh = test::box_mesh(3, 3, 4, kind);
  test::distort(mesh, 0.3, 3);
  MeshLabels labels;
  for (const NodeIndex a : {0, 1, 2, 4, 5, 6, 8, 9, 10}) {
    if (kind == test::BoxCells::hexahedra) {
      labels.facets.append(std::vector<NodeIndex>{a, a + 4, a + 5, a + 1});
      labels.facet_tags.push_back(5);
    } else {
      labels.facets.append(std::vector<NodeIndex>{a, a + 5, a + 1});
      labels.facets.append(std::vector<NodeIndex>{a, a + 4, a + 5});
      labels.facet_tags.insert(labels.facet_tags.end(), 2, 5);
    }
  }
  labels.names = {{{2, 5}, "inlet"}};
  return {std::make_shared<const Topology>(3, mesh.n_nodes(), mesh.topology().cells(), std::nullopt,
                                           labels),
          mesh.copied_coordinates()};
}

VolumeMesh read_volume(const fs::path& path) {
  return std::get<VolumeMesh>(read_mesh(path).mesh);
}

TEST_F(CommandLine, SmoothsVolumeMeshesOfEveryFormat) {
  for (const auto& format : mesh_formats()) {
    if (!format.holds_volume_meshes) continue;
    const std::string in = "in" + format.extension, out = "out" + format.extension;
    write_mesh(file(in), shaken_box(test::BoxCells::hexahedra));
    const Outcome outcome = smoothfem({"smooth", in, "-m", "getme-adaptive", "-o", out});
    ASSERT_EQ(outcome.exit_code, 0) << format.name << ": " << outcome.err;
    EXPECT_NE(outcome.out.find("after"), std::string::npos) << outcome.out;
    const VolumeMesh before = read_volume(file(in)), after = read_volume(file(out));
    EXPECT_EQ(after.topology().cells(), before.topology().cells()) << format.name;
    EXPECT_GT(mesh_quality(after).q_star_min, mesh_quality(before).q_star_min) << format.name;
    EXPECT_EQ(test::n_moved_fixed_nodes(before, after), 0u) << format.name;
  }
}

TEST_F(CommandLine, EveryMethodForVolumeMeshesSmoothsOne) {
  write_mesh(file("in.vtu"), shaken_box());
  for (const auto& info : method_catalogue()) {
    if (!supports_mesh_kind<3>(info.name)) continue;
    const Outcome outcome = smoothfem({"smooth", "in.vtu", "-m", info.name, "-o", "out.vtu"});
    ASSERT_EQ(outcome.exit_code, 0) << info.name << ": " << outcome.err;
    EXPECT_GT(mesh_quality(read_volume(file("out.vtu"))).q_mean, mesh_quality(shaken_box()).q_mean);
  }
}

TEST_F(CommandLine, SettingsComeAfterThePreset) {
  write_mesh(file("in.vtu"), shaken_box());
  const auto result = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"smooth", "in.vtu", "-m", "getme", "-o", "out.vtu"});
    const Outcome outcome = smoothfem(options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return read_volume(file("out.vtu")).copied_coordinates();
  };
  const auto expected = [](const std::vector<std::pair<std::string, std::string>>& settings) {
    VolumeMesh mesh = shaken_box();
    Method<3> method = make_method<3>("getme");
    apply_preset(find_preset("thesis-5.4"), method);
    for (const auto& [name, value] : settings) method.set(name, value);
    smooth(mesh, method);
    return mesh.copied_coordinates();
  };
  const auto preset = result({"--preset", "thesis-5.4"});
  EXPECT_EQ(preset, expected({}));
  EXPECT_NE(preset, result({}));
  // The order on the command line does not matter.
  const auto both = result({"--set", "simultaneous.rho=0.2", "--preset", "thesis-5.4"});
  EXPECT_EQ(both, expected({{"simultaneous.rho", "0.2"}}));
  EXPECT_NE(both, preset);
}

TEST_F(CommandLine, TheRuleForFixedNodesDecidesWhichMove) {
  write_mesh(file("in.msh"), shaken_box());
  const VolumeMesh mesh = read_volume(file("in.msh"));
  for (const std::string rule : {"boundary", "file", "free", "group=inlet", "group=5"}) {
    const Outcome outcome = smoothfem({"smooth", "in.msh", "-m", "laplace", "-o", "out.msh",
                                       "--fix", rule, "--set", "max_iterations=1"});
    ASSERT_EQ(outcome.exit_code, 0) << rule << ": " << outcome.err;
    const auto after = read_volume(file("out.msh")).copied_coordinates();
    const auto fixed = fixed_nodes(mesh.topology(), parse_fixed_nodes_rule(rule));
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      EXPECT_EQ(after[i] == mesh.copied_coordinates()[i], fixed[i] != 0) << rule << " node " << i;
  }
}

TEST_F(CommandLine, TheNumberOfThreadsChangesNoByte) {
  write_mesh(file("in.vtk"), shaken_box());
  for (const std::string n : {"1", "3"}) {
    const Outcome outcome =
        smoothfem({"smooth", "in.vtk", "-m", "getme", "-o", n + ".vtk", "--threads", n});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("on " + n + " thread"), std::string::npos) << outcome.out;
  }
  EXPECT_EQ(content_of(file("1.vtk")), content_of(file("3.vtk")));
}

/// Returns a box with a node far beyond its neighbours, and cells with the numbers 100, 101, ...
VolumeMesh tangled_box() {
  const VolumeMesh mesh = test::box_mesh(3, 3, 3, test::BoxCells::hexahedra);
  MeshLabels labels;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) labels.cell_ids.push_back(100 + c);
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) labels.node_ids.push_back(1 + i);
  auto coordinates = mesh.copied_coordinates();
  coordinates[mesh.topology().free_nodes()[0]] += Point<3>(2.2, 2.2, 2.2);
  return {std::make_shared<const Topology>(3, mesh.n_nodes(), mesh.topology().cells(), std::nullopt,
                                           labels),
          coordinates};
}

TEST_F(CommandLine, UntanglesIfAsked) {
  write_mesh(file("in.msh"), tangled_box());
  const std::size_t n_invalid = mesh_quality(tangled_box()).n_invalid;
  ASSERT_GT(n_invalid, 3u);
  const Outcome outcome = smoothfem(
      {"smooth", "in.msh", "-m", "getme", "-o", "out.msh", "--untangle", "--log", "rows.csv"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("untangled " + std::to_string(n_invalid) + " invalid cells"),
            std::string::npos)
      << outcome.out;
  const VolumeMesh after = read_volume(file("out.msh"));
  EXPECT_EQ(mesh_quality(after).n_invalid, 0u);
  EXPECT_EQ(test::n_moved_fixed_nodes(tangled_box(), after), 0u);
  EXPECT_EQ(after.topology().labels().cell_ids, tangled_box().topology().labels().cell_ids);
  const CsvTable log(content_of(file("rows.csv")));
  ASSERT_GT(log.rows.size(), 2u);
  for (const auto& row : log.rows) {
    EXPECT_EQ(row.at("n_invalid"), "0");
    EXPECT_EQ(row.at("method"), "getme");
  }
  const auto seconds = [&](std::size_t i) {
    return std::stod(log.rows[i].at("smoothing_seconds"));
  };
  for (std::size_t i = 1; i < log.rows.size(); ++i) EXPECT_GE(seconds(i), seconds(i - 1)) << i;
  for (const std::string stage : {"initial", "simultaneous", "sequential"})
    EXPECT_FALSE(log.select({{"stage", stage}}).empty()) << stage;
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

TEST_F(CommandLine, QualityWritesAHistogramOfEachCellType) {
  const auto mesh = test::box_mesh(2, 2, 4, test::BoxCells::mixed);
  write_mesh(file("in.vtu"), mesh);
  const Outcome outcome = smoothfem({"quality", "in.vtu", "--histogram", "new/a.csv", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const CsvTable table(content_of(file("new/a.csv")));
  EXPECT_EQ(table.columns, (std::vector<std::string>{"lower", "upper", "count", "cell_type"}));
  const auto json = nlohmann::json::parse(outcome.out);
  ASSERT_GT(json.at("cells").size(), 1u);
  for (const auto& [type, n_cells] : json.at("cells").items()) {
    std::size_t sum = 0;
    double end = 0.0;  // bins without gaps from 0 to 1
    for (const auto& row : table.select({{"cell_type", type}})) {
      EXPECT_EQ(std::stod(row.at("lower")), end);
      end = std::stod(row.at("upper"));
      const std::size_t count = std::stoul(row.at("count"));
      sum += count;
      std::size_t expected = 0;
      const auto quality = cell_mean_ratios(mesh);
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        expected += name_of(mesh.topology().cell_type(c)) == type &&
                    quality[c] >= std::stod(row.at("lower")) &&
                    (quality[c] < end || (end == 1.0 && quality[c] <= 1.0));
      EXPECT_EQ(count, expected) << type << " below " << end;
    }
    EXPECT_EQ(end, 1.0);
    EXPECT_EQ(sum, n_cells.get<std::size_t>()) << type;
  }
}

TEST_F(CommandLine, QualityDrawsItsHistogramAndRefusesUnknownEndings) {
  write_mesh(file("in.vtu"), shaken_grid(4, 0.1));
  const Outcome drawn = smoothfem({"quality", "in.vtu", "--histogram=a.svg"});
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_NE(content_of(file("a.svg")).find("<svg"), std::string::npos);
  for (const std::string name : {"a.bmp", "a"}) {
    const Outcome outcome = smoothfem({"quality", "in.vtu", "--histogram", name});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find("the histogram " + name + " must end with .csv"), std::string::npos)
        << outcome.err;
    EXPECT_FALSE(fs::exists(file(name)));
  }
}

TEST_F(CommandLine, SmoothsByGetmeIntoAFileNextToTheMeshByDefault) {
  write_mesh(file("part.vtu"), shaken_grid(4, 0.3));
  const Outcome outcome = smoothfem({"smooth", "part.vtu"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("GETMe: "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("written to part_smoothed.vtu"), std::string::npos) << outcome.out;
  ASSERT_EQ(smoothfem({"smooth", "part.vtu", "-m", "getme", "-o", "same.vtu"}).exit_code, 0);
  EXPECT_EQ(content_of(file("part_smoothed.vtu")), content_of(file("same.vtu")));
}

TEST_F(CommandLine, QualityOfAnInvalidMeshIsShownBeforeItIsRefused) {
  PlanarMesh inverted = shaken_grid(4, 0.0);
  inverted.coordinates()[6] = {3.5, 3.5};
  write_mesh(file("in.vtu"), inverted);
  const Outcome outcome = smoothfem({"quality", "in.vtu", "--json"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_GT(nlohmann::json::parse(outcome.out).at("n_invalid").get<int>(), 0);
}

TEST_F(CommandLine, ListNamesEverything) {
  const Outcome list = smoothfem(
      {"list", "--studies", (fs::path(SMOOTHFEM_SOURCE_DIR) / "studies" / "catalogue").string()});
  ASSERT_EQ(list.exit_code, 0) << list.err;
  const auto expect_listed = [&](const std::string& name) {
    EXPECT_NE(list.out.find(" " + name), std::string::npos) << name;
  };
  for (const auto& info : method_catalogue()) {
    expect_listed(info.name);
    const auto expect_parameters_listed = [&]<int dim>() {
      if (!supports_mesh_kind<dim>(info.name)) return;
      Method<dim> method = make_method<dim>(info.name);
      for (const auto& parameter : method.parameters()) expect_listed(parameter.name);
    };
    expect_parameters_listed.template operator()<2>();
    expect_parameters_listed.template operator()<3>();
  }
  for (const auto& preset : presets()) expect_listed(preset.name);
  for (const auto& format : mesh_formats()) expect_listed(format.extension);
  for (const auto& domain : domains()) expect_listed(domain.name);
  for (const auto& solution : manufactured_solutions<2>()) expect_listed(solution.formula);
  for (const auto& solution : manufactured_solutions<3>()) expect_listed(solution.formula);
  expect_listed("gear             Involute gear");  // the study, by its title
}

TEST_F(CommandLine, ListsTheTransformationsThatParametersTake) {
  const std::string list = smoothfem({"list", "transformations"}).out;
  ElementParameters<3> element;
  const Parameters all = element.parameters();
  const auto parameter = std::find_if(all.begin(), all.end(), [](const Parameter& p) {
    return p.name == "tetrahedron_transformation";
  });
  ASSERT_NE(parameter, all.end());
  for (const auto& name : std::get<Choice>(parameter->value).names)
    EXPECT_NE(list.find("\n  " + name + " "), std::string::npos) << name;
}

TEST_F(CommandLine, GeneratesQuietly) {
  const Outcome outcome =
      smoothfem({"generate", "gear", "-o", "g.vtu", "--edge-scale", "4", "--quiet"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(fs::exists(file("g.vtu")));
}

TEST_F(CommandLine, ListSaysWhereValuesComeFrom) {
  const Outcome preset = smoothfem({"list", "thesis-5.4"});
  EXPECT_EQ(preset.exit_code, 0) << preset.err;
  for (const std::string origin : {"own choice, Section 5.4 does not say which",
                                   "inferred, Section 5.4, printed with the other sign"})
    EXPECT_NE(preset.out.find(origin), std::string::npos) << origin;
  const Outcome method = smoothfem({"list", "laplace"});
  EXPECT_NE(method.out.find("default: printed, Section 1.3.2"), std::string::npos);
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

TEST_F(CommandLine, GeneratesAndDistortsVolumeMeshes) {
  for (const std::string elements : {"tetrahedra", "hexahedra"}) {
    const Outcome outcome = smoothfem({"generate", "flange", "-o", "out.vtu", "--elements",
                                       elements, "--edge-scale", "3", "--distort-to", "0.6"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find(elements), std::string::npos);
    const auto json = nlohmann::json::parse(smoothfem({"quality", "out.vtu", "--json"}).out);
    EXPECT_NEAR(json.at("q_mean").get<double>(), 0.6, 1e-4);
    EXPECT_EQ(json.at("n_invalid"), 0);
    EXPECT_EQ(json.at("cells").size(), 1u) << "all of one type";
  }
  const Outcome by_default =
      smoothfem({"generate", "flange", "-o", "out.vtu", "--edge-scale", "4"});
  EXPECT_NE(by_default.out.find("tetrahedra"), std::string::npos) << "the domain's first type";
  const Outcome planar =
      smoothfem({"generate", "flange", "-o", "no.vtu", "--elements", "triangles"});
  EXPECT_EQ(planar.exit_code, 2);
  EXPECT_NE(planar.err.find("tetrahedra, hexahedra"), std::string::npos) << planar.err;
}

TEST_F(CommandLine, GeneratesMeshesOfSecondOrderAlsoDistorted) {
  const Outcome generated =
      smoothfem({"generate", "disc", "-o", "disc.vtu", "--order", "2", "--elements",
                 "quadrilaterals", "--edge-scale", "16", "--distort-to", "0.7"});
  EXPECT_EQ(generated.exit_code, 0) << generated.err;
  EXPECT_THAT(generated.out, ::testing::HasSubstr("(quadrilaterals of second order)"));
  const auto json = nlohmann::json::parse(smoothfem({"quality", "disc.vtu", "--json"}).out);
  EXPECT_EQ(json.at("n_invalid"), 0);
  EXPECT_LT(json.at("q_mean").get<double>(), 0.75);
  EXPECT_NEAR(json.at("area").get<double>(), std::numbers::pi, 1e-4);
  const Outcome refused = smoothfem({"generate", "roof", "-o", "roof.vtu", "--order", "2"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, ::testing::HasSubstr("'roof' has no meshes of second order"));
}

TEST_F(CommandLine, GeneratesMeshesDistortedByRandomSteps) {
  const auto q_min_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"generate", "gear", "-o", "g.vtu", "--distort-to", "0.5"};
    words.insert(words.end(), {"--elements", "quadrilaterals", "--edge-scale", "3"});
    words.insert(words.end(), {"--distortion-sweeps", "10"});
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = smoothfem(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("q_mean 0.50"), std::string::npos) << outcome.out;
    return mesh_quality(std::get<PlanarMesh>(read_mesh(file("g.vtu")).mesh)).q_min;
  };
  EXPECT_LT(q_min_of({"--distortion", "random-steps"}), 0.1);
  EXPECT_GE(q_min_of({"--distortion", "random-steps", "--distortion-least-quality", "0.1"}), 0.1);
  const Outcome outcome = smoothfem({"generate", "gear", "-o", "g.vtu", "--distortion", "walk"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("random-steps"), std::string::npos) << outcome.err;
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

TEST_F(CommandLine, RunsAStudyOfTheUser) {
  write_mesh(file("meshes/mine.vtk"), shaken_grid(5, 0.2));
  file_with("my.prm", own_study);
  const Outcome outcome = smoothfem({"study", "my.prm"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const CsvTable summary(content_of(file("results/my/summary.csv")));
  EXPECT_EQ(summary.select({{"study", "my"}, {"mesh", "mine"}, {"status", "ok"}}).size(), 6u);
  EXPECT_EQ(summary.select({{"method", "gentle"}}).size(), 2u);
  for (const auto& row : summary.rows) EXPECT_LT(std::stod(row.at("e_max")), 1.0);
}

TEST_F(CommandLine, MultigridTakesPartInThePlane) {
  write_mesh(file("meshes/mine.vtk"), shaken_grid(20, 0.2));
  file_with("my.prm", own_study + "subsection finite elements\n set multigrid cg = always\nend\n");
  const Outcome outcome = smoothfem({"study", "my.prm", "--threads", "2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const CsvTable summary(content_of(file("results/my/summary.csv")));
  ASSERT_EQ(summary.rows.size(), 6u);
  for (const auto& row : summary.rows)
    EXPECT_LT(std::stoi(row.at("amg_cg_iterations")), std::stoi(row.at("cg_iterations")) / 2);
}

TEST_F(CommandLine, AStudyOfSeveralSeedsHasEachOfThem) {
  file_with("my.prm",
            "set dimension = 3\nset meshes = grid\nset methods = laplace, getme\nset degrees = 1\n"
            "set timing runs = 1\n"
            "set seeds = 1, 2\nset record seeds = results\n"
            "subsection mesh grid\n set domain = nonuniform-grid\n set distort to = 0.08\nend\n"
            "subsection solution\n set name = quadratic\nend\n"
            "subsection thresholds\n set reference = laplace\nend\n");
  const Outcome outcome = smoothfem({"study", "my.prm"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const CsvTable summary(content_of(file("results/my/summary.csv")));
  const auto of = [&](const std::string& mesh, const std::string& method) {
    return summary.select({{"mesh", mesh}, {"method", method}}).at(0).at("q_mean");
  };
  EXPECT_NE(of("grid", "initial"), of("grid.seed-2", "initial"));
  EXPECT_NE(of("grid", "getme"), of("grid.seed-2", "getme"));
  const CsvTable iterations(content_of(file("results/my/iterations.csv")));
  EXPECT_GT(iterations.select({{"mesh", "grid"}, {"method", "getme"}}).size(), 4u);
  EXPECT_LE(iterations.select({{"mesh", "grid.seed-2"}, {"method", "getme"}}).size(), 3u);
  const CsvTable thresholds(content_of(file("results/my/thresholds.csv")));
  EXPECT_FALSE(thresholds.select({{"mesh", "grid"}}).empty());
  EXPECT_TRUE(thresholds.select({{"mesh", "grid.seed-2"}}).empty());
  EXPECT_NE(content_of(file("results/my/provenance.json")).find("\"repeats\": \"grid\""),
            std::string::npos);
}

TEST_F(CommandLine, QuietStudiesPrintNothing) {
  write_mesh(file("meshes/mine.vtk"), shaken_grid(3, 0.2));
  file_with("my.prm",
            own_study + "set degrees = 1\nset scales = quick\nsubsection scale quick\nend\n");
  const Outcome outcome =
      smoothfem({"study", "my.prm", "--out", "here", "--quiet", "--threads", "1", "--quick"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  const auto json = nlohmann::json::parse(content_of(file("here/provenance.json")));
  EXPECT_EQ(json.at("scale"), "quick");
  EXPECT_EQ(json.at("machine").at("finite_element_threads"), 1);
}

/// A study that is interrupted while it runs, as by Ctrl-C.
class InterruptedStudy : public CommandLine {
 protected:
  /// Starts the study of this file with the results in `out`, and interrupts it when has_come() is
  /// true. Expects that it ends as an interrupted study.
  void interrupt_when(const std::string& study, const std::vector<const char*>& options,
                      const std::function<bool()>& has_come) {
    const std::string path = file(study), out = file("out");
    std::vector<const char*> words{"smoothfem", "study",     path.c_str(),
                                   "--out",     out.c_str(), "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    words.push_back(nullptr);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      ::execv(SMOOTHFEM_PROGRAM, const_cast<char* const*>(words.data()));
      ::_exit(127);
    }
    int status = 0;
    for (int tenth = 0; tenth < 1200 && !has_come(); ++tenth) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      ASSERT_EQ(::waitpid(child, &status, WNOHANG), 0) << "the study ended too early";
    }
    ::kill(child, SIGINT);
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    EXPECT_EQ(nlohmann::json::parse(content_of(file("out") / "provenance.json")).at("status"),
              "interrupted");
  }
};

TEST_F(InterruptedStudy, LeavesTheRowsItHas) {
  // The solves take far longer than the 5 s after which the first rows are written.
  write_mesh(file("grid.vtu"), shaken_grid(50, 0.2));
  file_with("long.prm",
            "set meshes = m\nset methods = laplace\nset degrees = 2\n"
            "set timing runs = 1\nsubsection mesh m\n set file = grid.vtu\nend\n"
            "subsection method laplace\n set tolerance = 0\n set max_iterations = 300\nend\n");
  const fs::path rows = file("out") / "iterations.csv";
  const auto has_rows = [&] {
    const std::string text = content_of(rows);
    return std::count(text.begin(), text.end(), '\n') > 1;
  };
  ASSERT_NO_FATAL_FAILURE(interrupt_when("long.prm", {"--threads", "1"}, has_rows));
  const CsvTable table(content_of(rows));  // checks that every line is whole
  EXPECT_GE(table.rows.size(), 1u);
  for (const auto& row : table.rows) EXPECT_EQ(row.at("status"), "ok");
  EXPECT_FALSE(fs::exists(file("out") / "summary.csv"));
}

TEST_F(InterruptedStudy, EndsBetweenTwoIterationsToo) {
  write_mesh(file("grid.vtu"), shaken_grid(30, 0.2));
  file_with("endless.prm",
            "set meshes = m\nset methods = laplace\nset degrees =\nset timing runs = 1\n"
            "subsection mesh m\n set file = grid.vtu\nend\n"
            "subsection method laplace\n set tolerance = 0\n"
            " set max_iterations = 1000000000\nend\n");
  interrupt_when("endless.prm", {}, [&] { return fs::exists(file("out") / "provenance.json"); });
}

}  // namespace
}  // namespace smoothfem
