// SPDX-License-Identifier: GPL-3.0-or-later
// Distortion and every method give bitwise identical meshes whatever vector registers the smoothing
// library is compiled for: this program runs itself once more with a library for processors without
// AVX.
#include <cstdlib>
#include <iomanip>
#include <map>

#include "meshes/distortion/distort.h"
#include "meshes/domains/catalogue.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/simd/registers.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

struct DistortedDomain {
  const char *domain, *elements;
  double edge_scale, q_mean;  ///< q_mean 0: not distorted
};

/// One of each kind of mesh and element.
constexpr DistortedDomain distorted_domains[]{
    {"gear", "triangles", 6, 0.4},          {"gear", "quadrilaterals", 3, 0.45},
    {"roof", "quadrilaterals", 3, 0.6},     {"sphere", "tetrahedra", 1, 0.5},
    {"nonuniform-grid", "hexahedra", 1, 0}, {"random-planar", "mixed", 1, 0.5}};

constexpr const char* variable_of_copy =
    "SMOOTHFEM_HASHES";  ///< names the file that the copy writes

/// FNV-1a over the bytes of all coordinates.
template <int dim, int spacedim>
std::string hash_of(const Mesh<dim, spacedim>& mesh) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const auto& point : mesh.coordinates())
    for (const double coordinate : point) {
      std::uint64_t bits;
      std::memcpy(&bits, &coordinate, sizeof bits);
      for (int byte = 0; byte < 8; ++byte)
        hash = (hash ^ (bits >> 8 * byte & 0xff)) * 1099511628211ULL;
    }
  return std::to_string(hash);
}

/// Adds "mesh" and "mesh/method" to the hashes.
template <int dim, int spacedim>
void add_hashes(Mesh<dim, spacedim> mesh, const std::string& name, double q_mean,
                std::map<std::string, std::string>& hashes) {
  if (q_mean > 0.0)
    distort(mesh, {.target_q_mean = q_mean, .n_candidates = default_candidates(dim)});
  hashes[name] = hash_of(mesh);
  const auto catalogue = method_catalogue();
  for (const std::string& method : methods_supporting<dim, spacedim>()) {
    const bool runs_alone =
        std::any_of(catalogue.begin(), catalogue.end(),
                    [&](const MethodInfo& info) { return info.name == method; });
    if (!runs_alone) continue;
    auto smoothed = mesh;
    auto made = make_method<dim, spacedim>(method);
    smooth(smoothed, made);
    hashes[name + "/" + method] = hash_of(smoothed);
  }
}

std::map<std::string, std::string> all_hashes() {
  std::map<std::string, std::string> hashes;
  for (const auto& [domain, elements, edge_scale, q_mean] : distorted_domains)
    std::visit([&, name = std::string(domain) + "." + elements,
                target = q_mean](auto mesh) { add_hashes(std::move(mesh), name, target, hashes); },
               find_domain(domain).generate({.elements = elements, .edge_scale = edge_scale}));
  add_hashes(test::box_mesh(4, 4, 6, test::BoxCells::mixed), "box.mixed", 0.6, hashes);
  return hashes;
}

class Registers : public FileTest {};

TEST_F(Registers, DoNotChangeABitOfAnyMesh) {
  auto hashes = all_hashes();
  EXPECT_GE(hashes.size(), 40u);
  hashes["registers"] = registers();
  if (const char* file = std::getenv(variable_of_copy)) {
    std::ofstream stream(file);
    for (const auto& [name, hash] : hashes) stream << name << ' ' << hash << '\n';
    return;
  }
  const std::string written = file("hashes").string();
  const std::string command = std::string("LD_LIBRARY_PATH='" SMOOTHFEM_OTHER_REGISTERS "' ") +
                              variable_of_copy + "='" + written + "' " +
                              std::filesystem::read_symlink("/proc/self/exe").string() +
                              " --gtest_filter=Registers.* --gtest_brief=1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::map<std::string, std::string> others;
  std::ifstream stream(written);
  for (std::string name, hash; stream >> name >> hash;) others[name] = hash;
  ASSERT_EQ(others["registers"], "SSE2")
      << "the library in " SMOOTHFEM_OTHER_REGISTERS " was not used";
  if (hashes["registers"] == "SSE2")
    GTEST_SKIP() << "SKIPPED: this machine has no wider registers than SSE2: nothing to compare";
  hashes.erase("registers");
  others.erase("registers");
  EXPECT_EQ(hashes, others);
}

}  // namespace
}  // namespace smoothfem
