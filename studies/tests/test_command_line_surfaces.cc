/// Surface meshes, and volume meshes whose boundary slides, by the command line.
#include "meshes/generators/domains.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/surface/node_constraints.h"
#include "smoothing/tests/methods.h"
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
      smoothfem({"generate", "roof", "-o", "roof.vtu", "--edge-scale", "4", "--distort-to", "0.6"});
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
      EXPECT_GT(mesh_quality(after).q_mean, mesh_quality(before).q_mean);
      double farthest = 0.0;
      for (const auto& place : after.coordinates())
        farthest = std::max(farthest, before.constraints()->distance(place));
      EXPECT_LT(farthest, 1e-12);
      EXPECT_EQ(test::n_moved_fixed_nodes(before, after), 0u);
    }
  const Outcome quality = smoothfem({"quality", "out.vtu"});
  EXPECT_EQ(quality.exit_code, 0) << quality.err;
  EXPECT_THAT(quality.out, HasSubstr("corners "));
}

TEST_F(CommandLine, RefusesWhatSurfacesCannotHave) {
  ASSERT_EQ(smoothfem({"generate", "roof", "-o", "roof.vtu", "--edge-scale", "4"}).exit_code, 0);
  const auto refusal = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"smooth", "roof.vtu", "-o", "out.vtu"});
    const Outcome outcome = smoothfem(options);
    EXPECT_EQ(outcome.exit_code, 2);
    return outcome.err;
  };
  EXPECT_THAT(refusal({"-m", "global-optimization"}),
              HasSubstr("does not take surface meshes; choose one of getme, getme-sequential"));
  EXPECT_THAT(refusal({"-m", "getme", "--untangle"}), HasSubstr("cannot be untangled"));
  EXPECT_THAT(refusal({"-m", "getme", "--boundary", "slide"}), HasSubstr("is for volume meshes"));
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
    EXPECT_EQ(outcome.out.find("within") != std::string::npos, boundary == "slide");
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
  EXPECT_THAT(refused.err, HasSubstr("cannot keep boundary nodes on the boundary"));
}

}  // namespace
}  // namespace smoothfem
