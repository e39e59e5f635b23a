// SPDX-License-Identifier: GPL-3.0-or-later
/// Measures the smoothers on volume meshes of the size of the thesis' Section 6.3: 568,000
/// distorted tetrahedra and 68,600 distorted hexahedra, on one and two threads. An iteration is
/// compared with a plain Laplace sweep and with the same work on a mesh that fits the innermost
/// cache. It is also compared with the time to move its bytes at the bandwidth of a triad a = b + s
/// c. One more benchmark smooths ten million tetrahedra and reports the memory used.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <limits>
#include <map>

#include "meshes/bench/memory_speed.h"
#include "meshes/bench/timing.h"
#include "meshes/bench/volume_meshes.h"
#include "smoothing/base/parallel.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/mesh/reordering.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem::bench {
namespace {

/// Median of n runs.
double median_seconds(int n, const auto& work) {
  std::vector<double> all;
  for (int i = 0; i < n; ++i) all.push_back(seconds_of(work));
  return median(all);
}

/// Smallest number of bytes of a pass over the mesh: the cells' nodes and row offsets, coordinates,
/// qualities written, sums of the nodes read and written, new coordinates.
double bytes_of_iteration(const VolumeMesh& mesh) {
  const double nodes = static_cast<double>(mesh.n_nodes());
  return static_cast<double>(mesh.topology().cells().n_entries()) * sizeof(NodeIndex) +
         static_cast<double>(mesh.n_cells()) * (sizeof(RowOffset) + sizeof(double)) +
         nodes * (3 * sizeof(Point<3>) + 2 * 4 * sizeof(double));
}

/// Median time in seconds of one iteration of a method's first stage.
double iteration_seconds(const VolumeMesh& mesh, const std::string& method, int n) {
  const Reordering<3> reordering(mesh.shared_topology());
  SmoothingState<3> state{reordering.apply(mesh), {}};
  compute_cell_mean_ratios(state.mesh, state.cell_quality);
  const auto stages = stages_of<3>(method);
  stages[0]->initialize(state);
  return median_seconds(n, [&] {
    stages[0]->step(state);
    if (stages[0]->traits().quality_use == QualityUse::loop)
      compute_cell_mean_ratios(state.mesh, state.cell_quality);
  });
}

const VolumeMesh& mesh_named(const std::string& name) {
  static std::map<std::string, VolumeMesh> meshes;
  const auto found = meshes.find(name);
  if (found != meshes.end()) return found->second;
  return meshes.emplace(name, name == "tetrahedra" ? bored_cube(true) : swept_gear(true))
      .first->second;
}
VolumeMesh small_mesh(const std::string& name) {
  auto mesh = test::box_mesh(
      5, 5, 5, name == "tetrahedra" ? test::BoxCells::tetrahedra : test::BoxCells::hexahedra);
  test::distort(mesh, 0.3, 1);
  return mesh;
}

void iteration(benchmark::State& state, const std::string& name, const std::string& method) {
  set_n_threads(static_cast<int>(state.range(0)));
  const VolumeMesh& mesh = mesh_named(name);
  double seconds = 0.0;
  for (auto _ : state) {
    seconds = iteration_seconds(mesh, method, 15);
    state.SetIterationTime(seconds);
  }
  const auto n_cells = static_cast<double>(mesh.n_cells());
  state.counters["ns/element"] = 1e9 * seconds / n_cells;
  state.counters["laplace_sweeps"] = seconds / iteration_seconds(mesh, "laplace", 15);
  const VolumeMesh small = small_mesh(name);
  const double small_seconds = iteration_seconds(small, method, 2000);
  state.counters["to_in_cache"] =
      seconds / n_cells / (small_seconds / small.n_cells()) * static_cast<double>(state.range(0));
  state.counters["to_bandwidth"] = seconds / (bytes_of_iteration(mesh) / triad_bandwidth());
}

/// Measures one transformation of the sequential method on the mesh of the simultaneous one.
void sequential_step(benchmark::State& state, const std::string& name) {
  set_n_threads(1);
  VolumeMesh mesh = mesh_named(name);
  auto simultaneous = make_method<3>("getme-simultaneous");
  smooth(mesh, simultaneous);
  const Reordering<3> reordering(mesh.shared_topology());
  SmoothingState<3> smoothing{reordering.apply(mesh), {}};
  compute_cell_mean_ratios(smoothing.mesh, smoothing.cell_quality);
  const auto stages = stages_of<3>("getme-sequential");
  stages[0]->initialize(smoothing);
  std::size_t n_steps = 0;
  double total = 0.0;
  for (auto _ : state) {
    const double seconds = seconds_of([&] { n_steps += stages[0]->step(smoothing).n_counted; });
    total += seconds;
    state.SetIterationTime(seconds);
  }
  state.counters["us/step"] = 1e6 * total / static_cast<double>(n_steps);
}

void whole_run(benchmark::State& state, const std::string& name, const std::string& method_name) {
  set_n_threads(static_cast<int>(state.range(0)));
  SmoothingResult result;
  double preparation = std::numeric_limits<double>::infinity();
  for (auto _ : state) {
    VolumeMesh mesh = mesh_named(name);
    auto method = make_method<3>(method_name);
    result = smooth(mesh, method);
    state.SetIterationTime(result.smoothing_seconds);
    preparation = std::min(preparation, result.preparation_seconds);
  }
  state.counters["preparation_ms"] = 1e3 * preparation;
  state.counters["q_min"] = result.quality.q_min;
  state.counters["q_star_min"] = result.quality.q_star_min;
  state.counters["q_mean"] = result.quality.q_mean;
  state.SetLabel(result.iterations_text() + " iterations");
}

double peak_bytes() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Smooths Kuhn tetrahedra: n^3 cubes of six. Run alone, its peak memory is that of the mesh and
/// smoothing.
void many_tetrahedra(benchmark::State& state) {
  set_n_threads(static_cast<int>(state.range(1)));
  VolumeMesh mesh = kuhn_cube(static_cast<std::uint32_t>(state.range(0)));
  test::distort(mesh, 0.3, 1);
  const double before = peak_bytes();
  SmoothingResult result;
  std::size_t n_iterations = 0;
  for (auto _ : state) {
    auto method = make_method<3>("getme-simultaneous");
    method.set("max_iterations", "10");
    method.set("tolerance", "-1");
    VolumeMesh smoothed = mesh;
    std::vector<double> times;
    result = smooth(smoothed, method, [&](const auto& record, const auto&) {
      times.push_back(record.smoothing_seconds);
    });
    n_iterations = times.size() - 1;
    state.SetIterationTime(times.back() - times[1]);
    state.counters["ns/element/iteration"] = 1e9 * (times.back() - times[1]) /
                                             static_cast<double>(n_iterations - 1) /
                                             static_cast<double>(mesh.n_cells());
  }
  state.counters["tetrahedra"] = static_cast<double>(mesh.n_cells());
  state.counters["peak_GiB"] = peak_bytes() / (1 << 30);
  state.counters["bytes/element_above_start"] =
      (peak_bytes() - before) / static_cast<double>(mesh.n_cells());
}

void register_all() {
  for (const std::string mesh : {"tetrahedra", "hexahedra"}) {
    for (const std::string method :
         {"getme-simultaneous", "smart-laplace", "weighted-laplace", "laplace"})
      benchmark::RegisterBenchmark(("iteration/" + method + "/" + mesh).c_str(),
                                   [=](benchmark::State& state) { iteration(state, mesh, method); })
          ->Arg(1)
          ->Arg(2)
          ->UseManualTime()
          ->Iterations(3)
          ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("step/getme-sequential/" + mesh).c_str(),
                                 [=](benchmark::State& state) { sequential_step(state, mesh); })
        ->UseManualTime()
        ->Iterations(100)
        ->Unit(benchmark::kMicrosecond);
    for (const std::string method : {"getme", "getme-adaptive", "global-optimization",
                                     "smart-laplace", "weighted-laplace", "laplace"})
      benchmark::RegisterBenchmark(("run/" + method + "/" + mesh).c_str(),
                                   [=](benchmark::State& state) { whole_run(state, mesh, method); })
          ->Arg(1)
          ->Arg(2)
          ->UseManualTime()
          ->Iterations(3)
          ->Unit(benchmark::kMillisecond);
  }
  benchmark::RegisterBenchmark("many_tetrahedra", many_tetrahedra)
      ->Args({26, 2})
      ->Args({119, 2})
      ->UseManualTime()
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace smoothfem::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  smoothfem::bench::register_all();
  benchmark::RunSpecifiedBenchmarks();
}
