// SPDX-License-Identifier: GPL-3.0-or-later
/// Compares how well each method is optimized: the time it takes for each visited cell or node, on
/// one thread, with two lower bounds. The first bound is the time of its bare formulas on a mesh
/// that fits the innermost cache. The second is the time to read and write its numbers once in an
/// iteration, at the bandwidth of a triad a = b + s c. GETMe sequential jumps through the mesh with
/// every transformation; its second bound is the time to load the cache lines of these numbers.
///
/// The ratio shows the rest: numbers read twice or from far away, tables of the method's own, lanes
/// that are not full. Below 1, reading and computing overlap. All methods take turns; times are
/// medians of rounds. Usage: fairness_bench [ROUNDS]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>

#include "meshes/bench/formula_times.h"
#include "meshes/bench/memory_speed.h"
#include "meshes/bench/timing.h"
#include "meshes/bench/volume_meshes.h"
#include "meshes/bench/worst_cells.h"
#include "smoothing/base/parallel.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/mesh/reordering.h"
#include "smoothing/optimization/block_conjugate_gradients.h"
#include "smoothing/optimization/shape_objective.h"

namespace smoothfem::bench {
namespace {

/// Numbers of things in a mesh to visit, read and write.
struct Counts {
  double cells = 0.0, nodes = 0.0, free_nodes = 0.0, cell_nodes = 0.0;
  double neighbours = 0.0,
         around = 0.0;           ///< of the free nodes: nodes joined by an edge; their cells
  double sharing_several = 0.0;  ///< of all cells: other cells that share two nodes or more
  WorstCells worst;

  /// Bytes of the list of the cells' nodes, of the table of cells around nodes, and of coordinates.
  double cell_list() const { return 4.0 * (cell_nodes + cells); }
  double node_cells() const { return 4.0 * (around + 2.0 * free_nodes); }
  double node_neighbours() const { return 4.0 * (neighbours + 2.0 * free_nodes); }
  double coordinates() const { return 24.0 * nodes; }
};

/// Number of other cells that share two nodes or more with a cell.
std::size_t n_sharing_several(const Topology& topology, CellIndex cell) {
  std::vector<CellIndex> others;
  for (const NodeIndex i : topology.cell_nodes(cell))
    for (const CellIndex other : topology.node_cells(i))
      if (other != cell) others.push_back(other);
  std::sort(others.begin(), others.end());
  std::size_t n = 0;
  for (auto at = others.begin(); at != others.end();) {
    const auto next = std::upper_bound(at, others.end(), *at);
    if (next - at > 1) ++n;
    at = next;
  }
  return n;
}

Counts counts_of(const VolumeMesh& mesh) {
  const Topology& topology = mesh.topology();
  Counts counts;
  counts.cells = static_cast<double>(mesh.n_cells());
  counts.nodes = static_cast<double>(mesh.n_nodes());
  counts.free_nodes = static_cast<double>(topology.free_nodes().size());
  counts.cell_nodes = static_cast<double>(topology.cells().n_entries());
  for (const NodeIndex i : topology.free_nodes()) {
    counts.neighbours += static_cast<double>(topology.node_neighbours(i).size());
    counts.around += static_cast<double>(topology.node_cells(i).size());
  }
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    counts.sharing_several += static_cast<double>(n_sharing_several(topology, c));
  return counts;
}

/// A line of the table. measure: returns the seconds of one iteration; visits: their number in it.
struct Line {
  std::string method, visited;
  double visits, formulas, bytes;  ///< lower bounds of seconds and bytes in an iteration
  std::function<double()> measure;
  std::vector<double> measured = {};
};

/// Median time in seconds of an iteration of a method's first stage, as smooth() counts it.
double iteration_seconds(const VolumeMesh& mesh, const std::string& name,
                         const std::string& tolerance) {
  constexpr int n = 9;
  auto method = make_method<3>(name);
  if (method.stages.size() > 1) method.stages.resize(1);
  method.set("max_iterations", std::to_string(n));
  method.set("tolerance", tolerance);
  VolumeMesh smoothed = mesh;
  std::vector<double> times;
  smooth(smoothed, method,
         [&](const auto& record, const auto&) { times.push_back(record.smoothing_seconds); });
  std::vector<double> differences;
  for (std::size_t i = 2; i < times.size(); ++i) differences.push_back(times[i] - times[i - 1]);
  return median(differences);
}

/// Time in seconds of a transformation of GETMe sequential, from a thousand on a mesh.
double transformation_seconds(const VolumeMesh& mesh) {
  const auto stages = stages_of<3>("getme-sequential");
  SmoothingState<3> state{mesh, {}};
  compute_cell_mean_ratios(state.mesh, state.cell_quality);
  stages[0]->initialize(state);
  std::size_t n = 0;
  const double seconds = seconds_of([&] {
    for (int cycle = 0; cycle < 10; ++cycle) n += stages[0]->step(state).n_counted;
  });
  return seconds / static_cast<double>(n);
}

/// The parts of a Newton step of global optimization, on a mesh in a good order.
struct OptimizationParts {
  VolumeMesh mesh;
  ShapeObjective<3> objective;
  BlockMatrix<3> hessian;
  BlockVector<3> gradient, solution;
  BlockConjugateGradients<3> solver;

  explicit OptimizationParts(const VolumeMesh& ordered)
      : mesh(ordered),
        objective(mesh.shared_topology()),
        hessian(objective.make_hessian()),
        gradient(hessian.make_vector()),
        solution(gradient) {}

  double objective_seconds() {
    double value = 0.0;
    const double seconds = seconds_of([&] { value = objective.value(mesh.coordinates()); });
    return value > 0.0 ? seconds : 0.0;
  }
  double derivatives_seconds() {
    return seconds_of([&] {
      objective.derivatives(mesh.coordinates(), HessianModel::convex, gradient, hessian);
    });
  }
  double cg_iteration_seconds() {
    constexpr int n = 10;
    solver.prepare(hessian);
    return seconds_of([&] { solver.solve(gradient, 0.0, n, solution); }) / n;
  }
};

std::vector<Line> lines_of(const VolumeMesh& mesh, const VolumeMesh& ordered,
                           const VolumeMesh& smoothed, const FormulaTimes& t, const Counts& n,
                           double bandwidth) {
  const auto method = [](const VolumeMesh& of, const std::string& name,
                         const std::string& tolerance) {
    return [&of, name, tolerance] { return iteration_seconds(of, name, tolerance); };
  };
  const auto parts = std::make_shared<OptimizationParts>(ordered);
  const double blocks = static_cast<double>(parts->hessian.columns().n_entries());
  const double per_cell = n.cell_nodes / n.cells;
  const double pairs = n.cells * per_cell * (per_cell - 1.0) / 2.0;
  const double moved = 24.0 * n.free_nodes, sums = 2.0 * 32.0 * n.nodes;
  const double laplace = n.neighbours * t.neighbour, weighted = n.around * t.centroid;
  const double laplace_bytes = n.node_neighbours() + n.coordinates() + moved;
  const double weighted_bytes = n.node_cells() + n.cell_list() + n.coordinates() + moved;
  return {
      {"laplace", "node", n.free_nodes, laplace, laplace_bytes, method(mesh, "laplace", "0")},
      {"  nodes in a good order", "node", n.free_nodes, laplace, laplace_bytes,
       method(ordered, "laplace", "0")},
      {"weighted-laplace", "node", n.free_nodes, weighted, weighted_bytes,
       method(mesh, "weighted-laplace", "0")},
      {"  nodes in a good order", "node", n.free_nodes, weighted, weighted_bytes,
       method(ordered, "weighted-laplace", "0")},
      {"smart-laplace", "node", n.free_nodes, laplace + (n.around + n.cells) * t.mean_ratio,
       n.node_neighbours() + n.node_cells() + 2.0 * n.cell_list() + 2.0 * n.coordinates() +
           3.0 * moved + 2.0 * 8.0 * n.cells,
       method(mesh, "smart-laplace", "-1")},
      {"getme-simultaneous", "element", n.cells, n.cells * t.transformed,
       n.cell_list() + 8.0 * n.cells + 3.0 * n.coordinates() + sums,
       method(mesh, "getme-simultaneous", "-1")},
      {"getme-adaptive", "element", n.cells,
       n.cells * (t.transformed + t.mean_ratio) +
           (2.0 * n.cell_nodes + n.sharing_several) * t.weight,
       3.0 * n.cell_list() + 2.0 * n.sharing_several + (4.0 * 8.0 + 2.0 * 8.0) * n.cells +
           4.0 * n.coordinates() + sums,
       method(mesh, "getme-adaptive", "-1")},
      {"getme-sequential", "transformation", 1.0,
       t.transformed_alone + (1.0 + n.worst.n_touching) * t.mean_ratio,
       n.worst.n_lines * random_line_seconds(n.worst.n_bytes) * bandwidth,
       [&smoothed] { return transformation_seconds(smoothed); }},
      {"optimization: objective", "element", n.cells, n.cells * t.objective,
       n.cell_list() + n.coordinates(), [parts] { return parts->objective_seconds(); }},
      {"  derivatives", "element", n.cells, n.cells * t.derivatives,
       n.cell_list() + n.coordinates() + 8.0 * pairs + 36.0 * blocks + 3.0 * 72.0 * n.free_nodes,
       [parts] { return parts->derivatives_seconds(); }},
      {"  CG iteration", "block", blocks, blocks * t.product,
       (36.0 + 4.0) * blocks + (4.0 + 10.0 * 24.0) * n.free_nodes,
       [parts] { return parts->cg_iteration_seconds(); }},
  };
}

void print_table(const std::string& name, const Counts& n, std::vector<Line>& lines,
                 double bandwidth) {
  double best = 1e300;
  std::vector<double> ratios;
  for (const Line& line : lines) {
    ratios.push_back(median(line.measured) / (line.formulas + line.bytes / bandwidth));
    best = std::min(best, ratios.back());
  }
  std::printf("\n%.0f %s, %.0f nodes of %.0f free\n%-26s %-15s %9s %9s %9s %7s %8s\n", n.cells,
              name.c_str(), n.nodes, n.free_nodes, "method", "visited", "ns", "formulas", "memory",
              "ratio", "to best");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Line& line = lines[i];
    std::printf("%-26s %-15s %9.1f %9.1f %9.1f %7.2f %8.2f\n", line.method.c_str(),
                line.visited.c_str(), 1e9 * median(line.measured) / line.visits,
                1e9 * line.formulas / line.visits, 1e9 * line.bytes / bandwidth / line.visits,
                ratios[i], ratios[i] / best);
  }
}

void measure(const std::string& name, const VolumeMesh& mesh, int n_rounds, double bandwidth) {
  const VolumeMesh ordered = Reordering<3>(mesh.shared_topology()).apply(mesh);
  VolumeMesh smoothed = ordered;
  auto simultaneous = make_method<3>("getme-simultaneous");
  smooth(smoothed, simultaneous);
  const FormulaTimes times = formula_times(ordered);
  Counts counts = counts_of(ordered);
  counts.worst = worst_cells(smoothed);
  auto lines = lines_of(mesh, ordered, smoothed, times, counts, bandwidth);
  for (int round = 0; round < n_rounds; ++round)
    for (Line& line : lines) line.measured.push_back(line.measure());
  print_table(name, counts, lines, bandwidth);
}

}  // namespace
}  // namespace smoothfem::bench

int main(int argc, char** argv) {
  using namespace smoothfem;
  const int n_rounds = argc > 1 ? std::atoi(argv[1]) : 5;
  if (argc > 2 || n_rounds < 1) {
    std::fprintf(stderr, "usage: fairness_bench [ROUNDS], ROUNDS at least 1\n");
    return 2;
  }
  set_n_threads(1);
  const double bandwidth = bench::triad_bandwidth();
  std::printf("One thread, medians of %d rounds; memory at %.1f GB/s\n", n_rounds,
              1e-9 * bandwidth);
  bench::measure("tetrahedra", bench::bored_cube(true), n_rounds, bandwidth);
  bench::measure("hexahedra", bench::swept_gear(true), n_rounds, bandwidth);
}
