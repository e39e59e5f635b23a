// SPDX-License-Identifier: GPL-3.0-or-later
/// smooth_call MESH METHOD: the library's smooth() on one thread, as against_program.py reads it.
#include <chrono>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "meshes/io/mesh_file.h"
#include "smoothing/base/parallel.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/smooth.h"

namespace smoothfem {
namespace {

template <int dim, int spacedim>
void smooth_and_tell(Mesh<dim, spacedim>& mesh, const std::string& name) {
  const auto start = std::chrono::steady_clock::now();
  auto method = make_method<dim, spacedim>(name);
  const SmoothingResult result = smooth(mesh, method);
  const std::chrono::duration<double> call = std::chrono::steady_clock::now() - start;
  char q_mean[16];
  std::snprintf(q_mean, sizeof q_mean, "%.4f", result.quality.q_mean);
  const nlohmann::json told{{"loops", result.smoothing_seconds},
                            {"call", call.count()},
                            {"iterations", result.iterations_text()},
                            {"q_mean", q_mean}};
  std::printf("%s\n", told.dump().c_str());
}

}  // namespace
}  // namespace smoothfem

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "usage: smooth_call MESH METHOD\n");
    return 2;
  }
  auto file = smoothfem::read_mesh(argv[1]);
  smoothfem::set_n_threads(1);
  std::visit([&](auto& mesh) { smoothfem::smooth_and_tell(mesh, argv[2]); }, file.mesh);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "smooth_call: %s\n", error.what());
  return 2;
}
