// SPDX-License-Identifier: GPL-3.0-or-later
/// Surface meshes, and volume meshes whose boundary slides, by the command line.
#include "meshes/domains/catalogue.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/surface/surface_constraints.h"
#include "smoothing/tests/methods.h"
#include "smoothing/tests/tangled_boundary.h"
#include "smoothing/tests/volume_meshes.h"
#include "studies/tests/command_line.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;

SurfaceMesh read_surface(const std::filesystem::path& path) {
  return std::get<SurfaceMesh>(read_mesh(path).mesh);
}

TEST_F(CommandLine, GeneratesDistortsAndSmoothsASurface) {
  const Outcome made =
      smoothfem({"generate", "roof", "-o", "roof.vtu", "--edge-scale", "3", "--distort-to", "0.6"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("q_mean 0.6"));
  const SurfaceMesh before = read_surface(file("roof.vtu"));
  for (const std::string method :
       {"laplace", "smart-laplace", "getme-simultaneous", "getme-sequential", "getme"})
    for (const std::string out : {"out.vtu", "out.msh", "out.vtk"}) {
      SCOPED_TRACE(method + " " + out);
      const Outcome smoothed = smoothfem({"smooth", "roof.vtu", "-m", method, "-o", out});
      ASSERT_EQ(smoothed.exit_code, 0) << smoothed.err;
      const SurfaceMesh after = read_surface(file(out));
      const auto& surface = dynamic_cast<const SurfaceConstraints&>(*before.constraints());
      EXPECT_GT(mesh_quality(after).q_mean, mesh_quality(before).q_mean);
      double farthest = 0.0;
      for (const auto& point : after.coordinates())
        farthest = std::max(farthest, surface.distance(point));
      EXPECT_LT(farthest, 1e-12);
      EXPECT_EQ(test::n_moved_fixed_nodes(before, after), 0u);
    }
  const Outcome quality = smoothfem({"quality", "out.vtu"});
  EXPECT_EQ(quality.exit_code, 0) << quality.err;
  EXPECT_THAT(quality.out, HasSubstr("corners "));
}

/// Compares the output of `list` with the behaviour of the methods.
TEST_F(CommandLine, ListsWhichMethodsTakeSurfacesAndSlidingBoundaries) {
  ASSERT_EQ(smoothfem({"generate", "roof", "-o", "roof.vtu", "--edge-scale", "3"}).exit_code, 0);
  write_mesh(file("box.vtu"), test::box_mesh(2, 2, 2, test::BoxCells::hexahedra));
  const Outcome list =
      smoothfem({"list", "--studies",
                 (std::filesystem::path(SMOOTHFEM_SOURCE_DIR) / "studies" / "catalogue").string()});
  ASSERT_EQ(list.exit_code, 0) << list.err;
  for (const auto& info : method_catalogue()) {
    SCOPED_TRACE(info.name);
    const auto method = list.out.find("\n  " + info.name + ": ");
    ASSERT_NE(method, std::string::npos);
    const auto kinds = list.out.find("Meshes: ", method);
    const std::string line = list.out.substr(kinds, list.out.find('\n', kinds) - kinds);
    const auto is_taken = [&](std::vector<std::string> words) {
      words.insert(words.end(), {"-m", info.name, "-o", "out.vtu"});
      return smoothfem(words).exit_code == 0;
    };
    EXPECT_EQ(line.find("surface") != std::string::npos, is_taken({"smooth", "roof.vtu"})) << line;
    EXPECT_EQ(line.find("sliding boundary") != std::string::npos,
              is_taken({"smooth", "box.vtu", "--boundary", "slide"}))
        << line;
  }
}

TEST_F(CommandLine, RefusesWhatSurfacesLack) {
  ASSERT_EQ(smoothfem({"generate", "roof", "-o", "roof.vtu", "--edge-scale", "3"}).exit_code, 0);
  const auto refusal = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"smooth", "roof.vtu", "-o", "out.vtu"});
    const Outcome outcome = smoothfem(options);
    EXPECT_EQ(outcome.exit_code, 2);
    return outcome.err;
  };
  EXPECT_THAT(refusal({"-m", "global-optimization"}),
              HasSubstr("does not support surface meshes; choose one of getme, getme-sequential"));
  EXPECT_THAT(refusal({"-m", "getme", "--untangle"}), HasSubstr("cannot be untangled"));
  EXPECT_THAT(refusal({"-m", "getme", "--boundary", "slide"}),
              HasSubstr("is for planar and volume meshes"));
  EXPECT_THAT(refusal({"-m", "getme", "--feature-angle", "200"}),
              HasSubstr("give one above 0, at most 180"));
}

TEST_F(CommandLine, SlidesTheBoundaryOfAVolumeMesh) {
  VolumeMesh box = test::box_mesh(4, 4, 4, test::BoxCells::tetrahedra);
  for (auto& p : box.coordinates()) p.x() += 0.3 * p.x() * (4.0 - p.x()) / 4.0;  // uneven layers
  write_mesh(file("in.msh"), box);
  const auto smoothed = [&](const std::string& boundary) {
    const Outcome outcome =
        smoothfem({"smooth", "in.msh", "-m", "getme", "-o", "out.msh", "--boundary", boundary});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.out.find("distance from the initial boundary") != std::string::npos,
              boundary == "slide");
    return std::get<VolumeMesh>(read_mesh(file("out.msh")).mesh);
  };
  const VolumeMesh fixed = smoothed("fixed"), sliding = smoothed("slide");
  EXPECT_EQ(test::n_moved_fixed_nodes(box, fixed), 0u);
  EXPECT_EQ(sliding.topology().free_nodes(), box.topology().free_nodes());
  EXPECT_GT(test::n_moved_fixed_nodes(box, sliding), 0u);
  EXPECT_EQ(mesh_quality(sliding).n_invalid, 0u);
  EXPECT_GT(mesh_quality(sliding).q_mean, mesh_quality(fixed).q_mean);
  const Outcome refused =
      smoothfem({"smooth", "in.msh", "-m", "getme-adaptive", "-o", "x.msh", "--boundary", "slide"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("cannot keep nodes on the boundary or on interfaces"));
}

TEST_F(CommandLine, BoundsHowFarASlidingBoundaryComesOffACurvedOne) {
  VolumeMesh bent = test::box_mesh(6, 4, 4, test::BoxCells::hexahedra);
  for (auto& p : bent.coordinates()) {
    const double angle = 0.3 * p.x() + 0.02 * p.x() * (6.0 - p.x()), radius = 6.0 + p.y();
    p = {radius * std::sin(angle), radius * std::cos(angle), p.z()};
  }
  write_mesh(file("in.vtu"), bent);
  const auto distance_and_bound = [&](const std::string& fraction) {
    const Outcome outcome = smoothfem({"smooth", "in.vtu", "-m", "getme", "-o", "out.vtu",
                                       "--boundary", "slide", "--slide-distance", fraction});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto number_after = [&](const std::string& words) {
      const auto position = outcome.out.find(words);
      return position == std::string::npos ? -1.0
                                           : std::stod(outcome.out.substr(position + words.size()));
    };
    return std::pair(number_after("initial boundary: "), number_after("limit: "));
  };
  const auto [free, infinite] = distance_and_bound("inf");
  const auto [bounded, bound] = distance_and_bound("0.005");
  EXPECT_TRUE(std::isinf(infinite));
  EXPECT_GT(free, bound) << "what the bound keeps from happening";
  EXPECT_GT(bounded, 0.0);
  EXPECT_LE(bounded, bound);
  const auto refusal = [&](const std::vector<std::string>& options) {
    std::vector<std::string> line{"smooth", "in.vtu", "-m", "getme", "-o", "x.vtu"};
    line.insert(line.end(), options.begin(), options.end());
    const Outcome outcome = smoothfem(line);
    EXPECT_EQ(outcome.exit_code, 2);
    return outcome.err;
  };
  EXPECT_THAT(refusal({"--slide-distance", "0.1"}), HasSubstr("is for '--boundary slide'"));
  EXPECT_THAT(refusal({"--boundary", "slide", "--slide-distance", "0"}),
              HasSubstr("mean edge length above 0"));
}

/// Tens of inverted cells, all of which have nodes of the boundary only.
TEST_F(CommandLine, UntanglesCellsThatHaveNodesOfASlidingBoundaryOnly) {
  const VolumeMesh tangled = test::tangled_along_boundary(test::shell(test::BoxCells::hexahedra));
  write_mesh(file("in.vtu"), tangled);
  const std::string n_invalid = std::to_string(mesh_quality(tangled).n_invalid);
  const std::vector<std::string> line{"smooth", "in.vtu",  "-m",        "getme",
                                      "-o",     "out.vtu", "--untangle"};
  const auto with = [&](std::vector<std::string> options) {
    options.insert(options.begin(), line.begin(), line.end());
    return smoothfem(options);
  };
  const Outcome fixed = with({});
  EXPECT_EQ(fixed.exit_code, 2);
  EXPECT_THAT(fixed.err,
              HasSubstr(n_invalid + " of " + n_invalid + " invalid cells have only fixed nodes"));
  EXPECT_THAT(fixed.err,
              HasSubstr("let boundary nodes move along the boundary with --boundary slide"));
  EXPECT_FALSE(std::filesystem::exists(file("out.vtu")));
  const Outcome outcome = with({"--boundary", "slide"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("untangled " + n_invalid + " invalid cells"));
  EXPECT_THAT(outcome.out, HasSubstr("distance from the initial boundary: "));
  const auto mesh = std::get<VolumeMesh>(read_mesh(file("out.vtu")).mesh);
  EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
  const Outcome hindered = with({"--boundary", "slide", "--slide-distance", "1e-6"});
  EXPECT_EQ(hindered.exit_code, 2);
  EXPECT_THAT(hindered.err, HasSubstr("are left after untangling"));
  EXPECT_THAT(hindered.err, HasSubstr("larger --slide-distance"));
}

TEST_F(CommandLine, UntanglesPlanarCellsThatHaveNodesOfASlidingBoundaryOnly) {
  write_mesh(file("in.vtu"), test::strip(false, 0.45));
  const auto with = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"smooth", "in.vtu", "-m", "smart-laplace", "-o", "out.vtu"});
    return smoothfem(options);
  };
  EXPECT_THAT(with({"--untangle"}).err, HasSubstr("--boundary slide"));
  EXPECT_THAT(with({"--boundary", "slide"}).err, HasSubstr("untangle the mesh first (--untangle)"));
  const Outcome outcome = with({"--untangle", "--boundary", "slide"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("distance from the initial boundary: "));
  EXPECT_EQ(mesh_quality(read_planar(file("out.vtu")).mesh).n_invalid, 0u);
  EXPECT_EQ(with({"--untangle", "--boundary", "slide", "--fix", "boundary"}).exit_code, 2);
  const Outcome then_fixed = smoothfem({"smooth", "in.vtu", "-m", "global-optimization", "-o",
                                        "out.vtu", "--untangle", "--boundary", "slide"});
  EXPECT_EQ(then_fixed.exit_code, 0) << then_fixed.err;
  EXPECT_THAT(then_fixed.out, HasSubstr("from here on the nodes that slide stay"));
}

TEST_F(CommandLine, KeepsSizesThatAreTargets) {
  PlanarMesh mesh = test::grid_mesh(4, test::GridCells::triangles);
  for (auto& x : mesh.coordinates()) x.x() *= 0.2 + 0.2 * x.x();
  write_mesh(file("in.vtu"), mesh);
  const auto with = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"smooth", "in.vtu", "-o", "out.vtu"});
    return smoothfem(options);
  };
  const Outcome kept = with({"-m", "getme", "--target", "initial-size"});
  EXPECT_EQ(kept.exit_code, 0) << kept.err;
  EXPECT_THAT(kept.out, HasSubstr("\nto target "));
  const PlanarMesh result = read_planar(file("out.vtu")).mesh;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const double factor = signed_cell_size(result, c) / signed_cell_size(mesh, c);
    EXPECT_TRUE(factor > 0.5 && factor < 2.0) << c << ' ' << factor;
  }
  EXPECT_EQ(with({"-m", "getme", "--target", "in.vtu"}).exit_code, 0);
  const Outcome no_layers = smoothfem({"smooth", "-o", "out.vtu", "--keep-layers", "in.vtu"});
  EXPECT_EQ(no_layers.exit_code, 0);  // the option does not take the mesh for its value
  EXPECT_THAT(no_layers.err, HasSubstr("--keep-layers holds no cell"));
  EXPECT_THAT(with({"-m", "laplace", "--target", "initial"}).err, HasSubstr("use one of getme, "));
  EXPECT_THAT(with({"-m", "getme", "--target", "none.vtu"}).err, HasSubstr("which is no file"));
  EXPECT_THAT(with({"-m", "getme", "--periodic", "smooth"}).err,
              HasSubstr("has no periodic partners"));
  write_mesh(file("other.vtu"), test::grid_mesh(3, test::GridCells::triangles));
  EXPECT_THAT(with({"-m", "getme", "--target", "other.vtu"}).err,
              HasSubstr("has other cells than"));
}

}  // namespace
}  // namespace smoothfem
