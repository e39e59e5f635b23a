// SPDX-License-Identifier: GPL-3.0-or-later
/// Benchmarks of global optimization on large, heavily distorted volume meshes: whole runs with and
/// without the start phase, and the phases of one Newton step.
#include <benchmark/benchmark.h>

#include "smoothing/bench/strong_distortion.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/mesh/reordering.h"
#include "smoothing/optimization/block_conjugate_gradients.h"
#include "smoothing/optimization/shape_objective.h"
#include "smoothing/optimization/vertex_descent.h"

namespace smoothfem {
namespace {

/// 0: 584,016 tetrahedra; 1: 68,921 hexahedra.
const VolumeMesh& distorted_mesh(std::int64_t kind) {
  static const auto make = [](std::uint32_t n, test::BoxCells cells, double radius, int n_sweeps) {
    auto mesh = test::box_mesh(n, n, n, cells);
    bench::distort_strongly(mesh, radius, n_sweeps, 1);
    return Reordering<3>(mesh.shared_topology()).apply(mesh);
  };
  if (kind == 0) {
    static const VolumeMesh mesh = make(46, test::BoxCells::tetrahedra, 0.65, 2);
    return mesh;
  }
  static const VolumeMesh mesh = make(41, test::BoxCells::hexahedra, 0.9, 1);
  return mesh;
}

void whole_run(benchmark::State& state) {
  const VolumeMesh& distorted = distorted_mesh(state.range(0));
  const ShapeObjective<3> objective(distorted.shared_topology());
  for (auto _ : state) {
    auto mesh = distorted;
    Method<3> method = make_method<3>("global-optimization");
    method.set("start_sweeps", std::to_string(state.range(1)));
    const auto result = smooth(mesh, method);
    state.SetIterationTime(result.smoothing_seconds);
    state.counters["iterations"] = static_cast<double>(result.stages[0].iterations);
    state.counters["objective_per_cell"] =
        objective.value(mesh.coordinates()) / static_cast<double>(mesh.n_cells());
  }
}
BENCHMARK(whole_run)
    ->ArgsProduct({{0, 1}, {0, 10}})
    ->ArgNames({"hexahedra", "start_sweeps"})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();

void objective_value(benchmark::State& state) {
  const VolumeMesh& mesh = distorted_mesh(state.range(0));
  const ShapeObjective<3> objective(mesh.shared_topology());
  for (auto _ : state) benchmark::DoNotOptimize(objective.value(mesh.coordinates()));
}

void assembly(benchmark::State& state) {
  const VolumeMesh& mesh = distorted_mesh(state.range(0));
  ShapeObjective<3> objective(mesh.shared_topology());
  auto hessian = objective.make_hessian();
  auto gradient = hessian.make_vector();
  for (auto _ : state)
    objective.derivatives(mesh.coordinates(), HessianModel::exact, gradient, hessian);
}

void pattern(benchmark::State& state) {
  const VolumeMesh& mesh = distorted_mesh(state.range(0));
  ShapeObjective<3> objective(mesh.shared_topology());
  for (auto _ : state) benchmark::DoNotOptimize(objective.make_hessian());
}

/// Conjugate gradients with the scaled matrix; products with it take nearly all of their time.
/// bytes_per_second counts the smallest number of bytes that these products must read and write.
void conjugate_gradients(benchmark::State& state) {
  constexpr int n_iterations = 20;
  const VolumeMesh& mesh = distorted_mesh(state.range(0));
  ShapeObjective<3> objective(mesh.shared_topology());
  auto hessian = objective.make_hessian();
  auto gradient = hessian.make_vector(), solution = gradient;
  objective.derivatives(mesh.coordinates(), HessianModel::convex, gradient, hessian);
  BlockConjugateGradients<3> solver;
  solver.prepare(hessian);
  for (auto _ : state)
    benchmark::DoNotOptimize(solver.solve(gradient, 0.0, n_iterations, solution));
  const auto& columns = hessian.columns();
  const std::size_t bytes =
      columns.n_entries() * (9 * sizeof(BlockMatrix<3>::Number) + sizeof(std::uint32_t)) +
      columns.size() * (2 * sizeof(Point<3>) + sizeof(RowOffset));
  state.SetBytesProcessed(state.iterations() * n_iterations * static_cast<std::int64_t>(bytes));
}

void start_sweep(benchmark::State& state) {
  const VolumeMesh& mesh = distorted_mesh(state.range(0));
  const VertexDescent<3> descent(mesh.topology());
  auto coordinates = mesh.copied_coordinates();
  for (auto _ : state) descent.sweep(coordinates);
}

BENCHMARK(objective_value)->DenseRange(0, 1)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(pattern)->DenseRange(0, 1)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(assembly)->DenseRange(0, 1)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(conjugate_gradients)->DenseRange(0, 1)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(start_sweep)->DenseRange(0, 1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace smoothfem

BENCHMARK_MAIN();
