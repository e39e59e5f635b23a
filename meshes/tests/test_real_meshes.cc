// SPDX-License-Identifier: GPL-3.0-or-later
/// Tests every method on third-party meshes, with its defaults and with the parameters of the
/// thesis.
#include "meshes/io/mesh_file.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/loop/preset.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/tests/methods.h"
#include "smoothing/tests/shared_mesh.h"

namespace smoothfem {
namespace {

struct RealMesh {
  std::string file;
  std::vector<std::string> presets;  ///< presets for such meshes, and none
};

const std::vector<RealMesh> real_meshes = {
    {"mixed2d_overture_tri382_quad4831.vtk", {"defaults", "thesis-5.1"}},
    {"mixed_hex_tet_pri_pyr_1622.vtk", {"defaults", "thesis-5.4", "thesis-5.5"}},
    {"tet_sphere_24013.mesh", {"defaults", "thesis-5.2", "thesis-5.5"}},
    {"hex_rockerarm_10600.mesh", {"defaults", "thesis-5.3", "thesis-5.5"}}};

struct Run {
  std::string file, preset, method;
};

std::ostream& operator<<(std::ostream& stream, const Run& run) {
  return stream << run.file << ' ' << run.preset << ' ' << run.method;
}

std::vector<Run> all_runs() {
  std::vector<Run> runs;
  for (const auto& mesh : real_meshes)
    for (const auto& preset : mesh.presets)
      for (const auto& info : method_catalogue()) runs.push_back({mesh.file, preset, info.name});
  return runs;
}

class RealMeshes : public testing::TestWithParam<Run> {
 protected:
  static std::filesystem::path path() { return test::shared_mesh(GetParam().file); }
  void SetUp() override {
    if (path().empty()) GTEST_SKIP() << test::how_to_get(GetParam().file);
    const auto& [file, preset, method] = GetParam();
    // These take seconds on the sphere; the smaller meshes have every preset and method.
    if (file.starts_with("tet_sphere") && preset == "thesis-5.2" && method.starts_with("getme") &&
        method != "getme-simultaneous") {
      SKIP_UNLESS_LONG();
    }
  }

  template <int dim, int spacedim>
  static void check(const Mesh<dim, spacedim>& mesh) {
    const auto& [file, preset, name] = GetParam();
    if (!supports_mesh_kind<dim, spacedim>(name)) GTEST_SKIP() << "not for meshes of this kind";
    auto method = make_method<dim, spacedim>(name);
    if (preset != "defaults") {
      // Captures are named because clang 14 does not support capturing structured bindings by [&].
      const auto refusal =
          input_error_of([&, &preset = preset] { apply_preset(find_preset(preset), method); });
      if (!refusal.empty()) GTEST_SKIP() << refusal;
    }
    const bool stays_valid = test::claims_validity(method);
    const MeshQuality before = mesh_quality(mesh);
    Mesh<dim, spacedim> result = mesh;
    smooth(result, method, [&](const IterationRecord& record, const Mesh<dim, spacedim>& seen) {
      if (stays_valid) {
        EXPECT_EQ(record.quality.n_invalid, 0u) << record.stage << ' ' << record.iteration;
        EXPECT_EQ(mesh_quality(seen).n_invalid, 0u) << record.stage << ' ' << record.iteration;
      }
      EXPECT_EQ(test::n_moved_fixed_nodes(mesh, seen), 0u) << record.iteration;
    });
    const MeshQuality after = mesh_quality(result);
    EXPECT_EQ(test::n_moved_fixed_nodes(mesh, result), 0u);
    const bool for_q_mean =
        stays_valid && name != "getme-sequential";  // getme-sequential keeps the best q_min instead
    if (for_q_mean) {
      EXPECT_GT(after.q_mean, before.q_mean);
    }
    if (name == "getme" || name == "getme-sequential" || name == "getme-adaptive") {
      EXPECT_GE(after.q_star_min, before.q_star_min);
    }
  }
};

TEST_P(RealMeshes, ImproveAndStayValid) {
  std::visit([](const auto& mesh) { check(mesh); }, read_mesh(path()).mesh);
}

std::string name_of_run(const testing::TestParamInfo<Run>& info) {
  const auto& [file, preset, method] = info.param;
  std::string name = file.substr(0, file.find('.')) + "_" + method + "_" + preset;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, RealMeshes, testing::ValuesIn(all_runs()), name_of_run);

}  // namespace
}  // namespace smoothfem
