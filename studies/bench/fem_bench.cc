// SPDX-License-Identifier: GPL-3.0-or-later
/// Measures finite element records on good meshes of the size of the thesis' Section 6.3, and the
/// parts of records.
/// It uses as many processes as mpirun starts. Products with the matrix are compared with the
/// memory bandwidth in the same run. Records are compared with the way of deal.II's tutorials on
/// one process.
#include <benchmark/benchmark.h>
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>

#include "fem/adaptivity/poisson_problem.h"
#include "fem/assembly/assembly.h"
#include "fem/linear_algebra/conjugate_gradients.h"
#include "fem/linear_algebra/trilinos_matrix.h"
#include "fem/poisson_solver.h"
#include "fem/ranks/mpi_session.h"
#include "meshes/domains/catalogue.h"
#include "meshes/io/mesh_file.h"
#include "studies/bench/stock_path.h"

namespace smoothfem::bench {
namespace {

const Ranks& ranks() {
  static const Ranks all(MPI_COMM_WORLD);
  return all;
}

/// Seconds from the start of all ranks until the last one is done.
double seconds_of(const auto& work) {
  MPI_Barrier(ranks().communicator());
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> own = std::chrono::steady_clock::now() - start;
  return ranks().max(own.count());
}

struct Case {
  ElementType type;
  int degree;
};

/// The mesh on the root, null on other ranks. A file in the folder for temporary files keeps it.
const VolumeMesh* flange(ElementType type) {
  static std::map<ElementType, VolumeMesh> meshes;
  if (!ranks().is_root()) return nullptr;
  const auto found = meshes.find(type);
  if (found != meshes.end()) return &found->second;
  const auto path = std::filesystem::temp_directory_path() /
                    ("smoothfem_bench_flange_" + std::string(name_of(type)) + ".vtu");
  if (!std::filesystem::exists(path)) {
    std::cerr << "generating " << path << '\n';
    write_mesh(path,
               std::get<VolumeMesh>(find_domain("flange").generate(
                   {.elements = type == ElementType::tetrahedron ? "tetrahedra" : "hexahedra"})));
  }
  return &meshes.emplace(type, std::get<VolumeMesh>(read_mesh(path).mesh)).first->second;
}

std::vector<Point<3>> coordinates_of(const VolumeMesh* mesh) {
  return mesh == nullptr ? std::vector<Point<3>>() : mesh->copied_coordinates();
}

/// Coordinates as one iteration of smoothing might have had before: each free node a tenth of the
/// way to the mean of its neighbours.
std::vector<Point<3>> moved_coordinates(const VolumeMesh* mesh) {
  auto moved = coordinates_of(mesh);
  if (mesh == nullptr) return moved;
  for (const NodeIndex node : mesh->topology().free_nodes()) {
    const auto neighbours = mesh->topology().node_neighbours(node);
    Point<3> mean = Point<3>::Zero();
    for (const NodeIndex k : neighbours) mean += mesh->coordinates()[k];
    moved[node] += 0.1 * (mean / static_cast<double>(neighbours.size()) - moved[node]);
  }
  return moved;
}

const ManufacturedSolution<3>& solution() {
  return manufactured_solution<3>("volume");
}

PoissonOptions options_of(const Case& c, ConditionNumberMethod method) {
  PoissonOptions options;
  options.degree = c.degree;
  options.condition_number = method;
  options.jacobi_cg = Recorded::never;
  return options;
}

/// Measures a record whose condition number comes from CG.
void record(benchmark::State& state, const Case& c) {
  const auto* mesh = flange(c.type);
  PoissonSolver<3> solver(mesh, options_of(c, ConditionNumberMethod::lanczos), ranks());
  const auto x = coordinates_of(mesh);
  SolutionRecord record;
  for (auto _ : state)
    state.SetIterationTime(seconds_of([&] { record = solver.solve(x, solution(), false); }));
  state.counters["dofs"] = static_cast<double>(record.n_dofs);
  state.counters["cg_iterations"] = static_cast<double>(record.cg_iterations);
  state.counters["condition"] = record.condition_number;
}

/// Measures a verified condition number as in a run: from the eigenvectors of the mesh before.
void verified_record(benchmark::State& state, const Case& c) {
  const auto* mesh = flange(c.type);
  PoissonSolver<3> solver(mesh, options_of(c, ConditionNumberMethod::verified), ranks());
  const auto x = coordinates_of(mesh), before = moved_coordinates(mesh);
  const double cold = seconds_of([&] { solver.solve(before, solution()); });
  const auto eigenvectors = solver.eigenvectors();
  SolutionRecord record;
  for (auto _ : state) {
    solver.set_eigenvectors(eigenvectors);
    state.SetIterationTime(seconds_of([&] { record = solver.solve(x, solution()); }));
  }
  state.counters["cold_s"] = cold;
  state.counters["condition"] = record.condition_number;
  state.counters["residual"] = record.condition_residual;
  state.counters["amg_setup_s"] = record.amg_setup_seconds;
}

/// The data that the parts of a record work on.
struct Parts {
  std::shared_ptr<const FiniteElementSpace<3>> space;
  std::vector<Point<3>> x;
  PoissonSystem system;

  explicit Parts(const Case& c)
      : space(make_finite_element_space(flange(c.type), c.degree, TensorPoints{.hexahedron = 4},
                                        ranks())),
        x(space->local_coordinates(coordinates_of(flange(c.type)))),
        system(make_system(*space)) {
    assemble();
  }
  void assemble() { smoothfem::assemble(*space, x, solution(), Load::nodal, system); }
  SlicedMatrix sliced() const { return SlicedMatrix(system.matrix, ranks(), space->halo); }
};

void assembly(benchmark::State& state, const Case& c) {
  Parts parts(c);
  for (auto _ : state) state.SetIterationTime(seconds_of([&] { parts.assemble(); }));
}

/// Bytes per second that all ranks together read from an array too large for the cache. Products
/// with the matrix mostly read.
double read_bandwidth() {
  static const double bandwidth = [] {
    const Eigen::VectorXd values = Eigen::VectorXd::Ones(1 << 25);
    double best = 1e300;
    for (int i = 0; i < 7; ++i)
      best = std::min(best, seconds_of([&] {
                        const double sum = values.sum();
                        benchmark::DoNotOptimize(sum);
                      }));
    return static_cast<double>(ranks().size()) * 8.0 * static_cast<double>(values.size()) / best;
  }();
  return bandwidth;
}

/// Bytes per second of a triad a = b + s c.
double triad_bandwidth() {
  static const double bandwidth = [] {
    Eigen::VectorXd a = Eigen::VectorXd::Zero(1 << 24), b = a, c = a;
    double best = 1e300;
    for (int i = 0; i < 7; ++i)
      best = std::min(best, seconds_of([&] {
                        a = b + 3.0 * c;
                        benchmark::DoNotOptimize(a.data());
                      }));
    return static_cast<double>(ranks().size()) * 24.0 * static_cast<double>(a.size()) / best;
  }();
  return bandwidth;
}

void product(benchmark::State& state, const Case& c) {
  const Parts parts(c);
  const SlicedMatrix matrix = parts.sliced();
  Eigen::VectorXd x = Eigen::VectorXd::Ones(matrix.n_columns()), y(matrix.n_rows());
  constexpr int n_products = 10;
  double best = 1e300, best_by_rows = 1e300;
  Eigen::setNbThreads(1);  // one core against one core
  for (auto _ : state) {
    const double seconds = seconds_of([&] {
                             for (int i = 0; i < n_products; ++i)
                               benchmark::DoNotOptimize(matrix.multiply(x, y));
                           }) /
                           n_products;
    best = std::min(best, seconds);
    state.SetIterationTime(seconds);
    // The same product row by row, as Eigen does it. Several processes would have to exchange
    // entries first.
    const double by_rows = ranks().size() > 1 ? 0.0 : seconds_of([&] {
                                                        for (int i = 0; i < n_products; ++i) {
                                                          y.noalias() = parts.system.matrix * x;
                                                          benchmark::DoNotOptimize(x.dot(y));
                                                        }
                                                      }) / n_products;
    best_by_rows = std::min(best_by_rows, by_rows);
  }
  state.counters["rows_over_this"] = best_by_rows / best;
  // Bytes of value and column of each entry; x is read, y is written.
  const double bytes = ranks().sum(12.0 * static_cast<double>(parts.system.matrix.nonZeros()) +
                                   8.0 * static_cast<double>(matrix.n_rows() + matrix.n_columns()));
  state.counters["GB/s"] = 1e-9 * bytes / best;
  state.counters["read_GB/s"] = 1e-9 * read_bandwidth();
  state.counters["triad_GB/s"] = 1e-9 * triad_bandwidth();
  state.counters["over_read"] = read_bandwidth() * best / bytes;
  state.counters["over_triad"] = triad_bandwidth() * best / bytes;
}

void cg(benchmark::State& state, const Case& c) {
  const Parts parts(c);
  const SlicedMatrix matrix = parts.sliced();
  Eigen::VectorXd x;
  ConjugateGradientsResult result;
  for (auto _ : state)
    state.SetIterationTime(seconds_of(
        [&] { result = conjugate_gradients(matrix, parts.system.right_hand_side, x, {}); }));
  state.counters["iterations"] = static_cast<double>(result.iterations);
}

void multigrid_cg(benchmark::State& state, const Case& c) {
  const Parts parts(c);
  const SlicedMatrix matrix = parts.sliced();
  TrilinosMatrix trilinos(*parts.space);
  trilinos.set_values(parts.system.matrix);
  const auto multigrid = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    trilinos.apply_multigrid(r, z);
  };
  Eigen::VectorXd x;
  ConjugateGradientsResult result;
  double setup = 0.0;
  for (auto _ : state) {
    setup = seconds_of([&] { trilinos.set_up_multigrid(); });
    state.SetIterationTime(setup + seconds_of([&] {
                             result = conjugate_gradients(matrix, parts.system.right_hand_side, x,
                                                          {}, multigrid);
                           }));
  }
  state.counters["setup_s"] = setup;
  state.counters["iterations"] = static_cast<double>(result.iterations);
}

/// Measures, on one process, the energy gradient that a step needs in addition to its solve.
void energy_gradient(benchmark::State& state, const Case& c) {
  if (ranks().size() > 1) return state.SkipWithError("solves for methods are those of one process");
  const auto* mesh = flange(c.type);
  const auto problem = make_poisson_problem(solution());
  const auto solver = problem->make_solver();
  solver->prepare(*mesh, c.degree);
  std::array x{coordinates_of(mesh), moved_coordinates(mesh)};
  solver->solve(x[1]);
  double solve = 0.0, gradient = 0.0;
  for (auto _ : state) {
    solve += seconds_of([&] { solver->solve(x[0]); });
    const double own = seconds_of([&] { benchmark::DoNotOptimize(solver->energy_gradient()); });
    gradient += own;
    state.SetIterationTime(own);
    std::swap(x[0], x[1]);
  }
  state.counters["solve_s"] = solve / static_cast<double>(state.iterations());
  state.counters["over_solve"] = gradient / solve;
}

/// Measures the tutorials' way on the root while the others wait, compared with a record by all
/// ranks.
void stock_path(benchmark::State& state, const Case& c) {
  const auto* mesh = flange(c.type);
  auto options = options_of(c, ConditionNumberMethod::lanczos);
  PoissonSolver<3> solver(mesh, options, ranks());
  const auto x = coordinates_of(mesh);
  SolutionRecord record;
  const double own = seconds_of([&] { record = solver.solve(x, solution(), false); });
  StockTimes times;
  for (auto _ : state) {
    if (mesh != nullptr)
      times = solve_by_stock_path(*mesh, c.degree, solution(), options.cg_tolerance);
    state.SetIterationTime(ranks().max(times.seconds()));
  }
  state.counters["assembly_s"] = times.assembly;
  state.counters["cg_s"] = times.cg;
  state.counters["errors_s"] = times.errors;
  state.counters["cg_iterations"] = times.cg_iterations;
  state.counters["over_record"] = times.seconds() / own;
  state.counters["l2_ratio"] = times.l2_error / record.l2_error;
}

void register_all() {
  struct Named {
    const char* name;
    void (*run)(benchmark::State&, const Case&);
    int iterations;  // fixed: all ranks have to agree
  };
  constexpr std::array benchmarks{
      Named{"record", record, 3},
      Named{"record_verified", verified_record, 3},
      Named{"assembly", assembly, 5},
      Named{"product", product, 10},
      Named{"cg", cg, 3},
      Named{"multigrid_cg", multigrid_cg, 3},
      Named{"energy_gradient", energy_gradient, 3},
      Named{"stock_path", stock_path, 1},
  };
  for (const ElementType type : {ElementType::tetrahedron, ElementType::hexahedron})
    for (const int degree : {1, 2})
      for (const auto& [name, run, iterations] : benchmarks)
        benchmark::RegisterBenchmark(
            (std::string(name) + "/" + std::string(name_of(type)) + "/" + std::to_string(degree))
                .c_str(),
            [=](benchmark::State& state) {
              run(state, {type, degree});
            })
            ->UseManualTime()
            ->Iterations(iterations)
            ->Unit(benchmark::kMillisecond);
}

/// The reporter of all ranks except the root.
class SilentReporter : public benchmark::BenchmarkReporter {
 public:
  SilentReporter() { SetOutputStream(&nowhere_); }
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>&) override {}

 private:
  std::ostream nowhere_{nullptr};
};

/// Arguments of a rank. Only the root writes the output files.
std::vector<char*> arguments_of_rank(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  if (!ranks().is_root())
    std::erase_if(arguments, [](const char* argument) {
      return std::string_view(argument).starts_with("--benchmark_out");
    });
  return arguments;
}

}  // namespace
}  // namespace smoothfem::bench

int main(int argc, char** argv) {
  using namespace smoothfem::bench;
  const smoothfem::MpiSession mpi;
  auto arguments = arguments_of_rank(argc, argv);
  argc = static_cast<int>(arguments.size());
  benchmark::Initialize(&argc, arguments.data());
  const bool understood = !benchmark::ReportUnrecognizedArguments(argc, arguments.data());
  if (understood) {
    register_all();
    SilentReporter silent;
    if (ranks().is_root())
      benchmark::RunSpecifiedBenchmarks();
    else
      benchmark::RunSpecifiedBenchmarks(&silent);
  }
  return understood ? 0 : 1;
}
