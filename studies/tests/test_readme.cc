// SPDX-License-Identifier: GPL-3.0-or-later
#include <regex>

#include "smoothing/loop/smooth.h"
#include "smoothing/tests/volume_meshes.h"
#include "studies/tests/command_line.h"

// What README.md shows has to work (its command lines: launcher/tests/test_readme_commands.py). Its
// smoother is compiled into this executable, and a second one.

namespace smoothfem {
namespace {

namespace fs = std::filesystem;

const fs::path root = SMOOTHFEM_SOURCE_DIR;

class Readme : public CommandLine {};

TEST_F(Readme, OptionsInItsTextExist) {
  std::string help = content_of(root / "run");
  for (const std::string command : {"study", "smooth", "quality", "generate", "list"})
    help += smoothfem({command, "--help"}).out;
  help += content_of(root / "plots/command_line.py");  // the launcher's command plot
  const std::string text = content_of(root / "README.md") + content_of(root / "results/README.md");
  const std::regex option("[ `]--[a-z][a-z-]*");
  std::size_t n_found = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), option), end; at != end; ++at, ++n_found)
    EXPECT_NE(help.find(at->str().substr(1)), std::string::npos) << at->str();
  EXPECT_GT(n_found, 3u);
}

TEST_F(Readme, ItsSmootherIsAMethod) {
  Method<2> method = make_method<2>("half-laplace");
  PlanarMesh mesh = shaken_grid(8, 0.2);
  const double before = mesh_quality(mesh).q_mean;
  const SmoothingResult result = smooth(mesh, method);
  EXPECT_GT(result.quality.q_mean, before);
  EXPECT_EQ(result.quality.n_invalid, 0u);
}

TEST_F(Readme, ASecondSmootherHasParametersOfItsOwn) {
  Method<3> method = make_method<3>("short-edge-laplace");
  method.set("exponent", "1.5");
  EXPECT_NE(input_error_of([&] { method.set("exponent", "-1"); }), "");
  VolumeMesh mesh = test::box_mesh(5, 5, 5, test::BoxCells::tetrahedra);
  test::distort(mesh, 0.3, 1);
  const double before = mesh_quality(mesh).q_mean;
  EXPECT_GT(smooth(mesh, method).quality.q_mean, before);
}

}  // namespace
}  // namespace smoothfem
