// SPDX-License-Identifier: GPL-3.0-or-later
/// Measures the smoothers: whole runs and single kernels, for each element and as multiples of a
/// plain Laplace sweep over the same mesh, the cheapest smoother. Meshes: a generated distorted
/// grid and, if available, the published gears (shared_mesh.h).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>

#include "meshes/io/mesh_file.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/tests/planar_meshes.h"
#include "smoothing/tests/shared_mesh.h"

namespace smoothfem {
namespace {

struct NamedMesh {
  std::string name;
  PlanarMesh mesh;
  double laplace_sweep_seconds = 0.0;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The unit of the ratios: the shortest of several sweeps.
double laplace_sweep_seconds(const PlanarMesh& mesh) {
  const auto stages = stages_of<2>("laplace");
  SmoothingState<2> state{mesh, {}};
  stages[0]->initialize(state);
  double shortest = 1e300;
  for (int i = 0; i < 50; ++i) {
    const auto start = std::chrono::steady_clock::now();
    stages[0]->step(state);
    shortest = std::min(shortest, seconds_since(start));
  }
  return shortest;
}

std::vector<NamedMesh> meshes() {
  std::vector<NamedMesh> all;
  all.push_back({"grid_triangles", test::grid_mesh(80, test::GridCells::triangles)});
  all.push_back({"grid_quadrilaterals", test::grid_mesh(80, test::GridCells::quadrilaterals)});
  for (auto& [name, mesh, seconds] : all) test::distort(mesh, 0.9, 1);
  for (const std::string name : {"gear_tri_initial", "gear_quad_initial"}) {
    const auto path = test::shared_mesh(name + ".mesh");
    if (path.empty())
      std::cerr << test::how_to_get(name + ".mesh") << '\n';
    else
      all.push_back({name, planar_mesh(read_mesh(path), path)});
  }
  for (auto& named : all) named.laplace_sweep_seconds = laplace_sweep_seconds(named.mesh);
  return all;
}

/// work_seconds: time of one run of the measured work.
void report(benchmark::State& state, const NamedMesh& named, double work_seconds) {
  state.counters["ns/element"] = 1e9 * work_seconds / static_cast<double>(named.mesh.n_cells());
  state.counters["laplace_sweeps"] = work_seconds / named.laplace_sweep_seconds;
}

void whole_run(benchmark::State& state, const NamedMesh& named, const std::string& method_name) {
  double total = 0.0;
  SmoothingResult result;
  for (auto _ : state) {
    PlanarMesh mesh = named.mesh;
    Method<2> method = make_method<2>(method_name);
    result = smooth(mesh, method);
    state.SetIterationTime(result.smoothing_seconds);
    total += result.smoothing_seconds;
  }
  report(state, named, total / static_cast<double>(state.iterations()));
  state.SetLabel(result.iterations_text() + " iterations");
}

void mean_ratios(benchmark::State& state, const NamedMesh& named) {
  std::vector<double> quality;
  const auto start = std::chrono::steady_clock::now();
  for (auto _ : state) {
    compute_cell_mean_ratios(named.mesh, quality);
    benchmark::DoNotOptimize(quality.data());
  }
  report(state, named, seconds_since(start) / static_cast<double>(state.iterations()));
}

/// Repeats one iteration (one transformation of GETMe sequential).
void single_step(benchmark::State& state, const NamedMesh& named, const std::string& method_name) {
  const auto stages = stages_of<2>(method_name);
  SmoothingState<2> smoothing{named.mesh, cell_mean_ratios(named.mesh)};
  stages[0]->initialize(smoothing);
  std::size_t n_steps = 0;
  const auto start = std::chrono::steady_clock::now();
  for (auto _ : state) n_steps += stages[0]->step(smoothing).n_counted;
  const double seconds = seconds_since(start) / static_cast<double>(n_steps);
  report(state, named, seconds);
  state.counters["us/step"] = 1e6 * seconds;
}

void register_all(const std::vector<NamedMesh>& all) {
  for (const auto& named : all) {
    const auto name = [&](const std::string& what) { return what + "/" + named.name; };
    for (const std::string method : {"laplace", "weighted-laplace", "smart-laplace",
                                     "getme-simultaneous", "getme", "global-optimization"})
      benchmark::RegisterBenchmark(
          name("run/" + method).c_str(),
          [&named, method](benchmark::State& state) { whole_run(state, named, method); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(name("kernel/mean_ratios").c_str(), [&named](
                                                                         benchmark::State& state) {
      mean_ratios(state, named);
    })->Unit(benchmark::kMicrosecond);
    for (const std::string method : {"laplace", "getme-simultaneous", "getme-sequential"})
      benchmark::RegisterBenchmark(
          name("kernel/step/" + method).c_str(),
          [&named, method](benchmark::State& state) { single_step(state, named, method); })
          ->Unit(benchmark::kMicrosecond);
  }
}

}  // namespace
}  // namespace smoothfem

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  const auto all = smoothfem::meshes();
  smoothfem::register_all(all);
  benchmark::RunSpecifiedBenchmarks();
}
