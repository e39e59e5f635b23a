// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/resource.h>

#include <charconv>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "distributed/examine_parts.h"
#include "distributed/files/box.h"
#include "distributed/files/pieces.h"
#include "distributed/files/refine.h"
#include "distributed/files/split.h"
#include "distributed/partition.h"
#include "fem/poisson_solver.h"
#include "fem/ranks/mpi_session.h"
#include "meshes/io/atomic_file.h"
#include "meshes/io/mesh_file.h"
#include "smoothing/base/interruption.h"
#include "smoothing/base/parallel.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "studies/cli/commands.h"
#include "studies/cli/configured_method.h"
#include "studies/cli/iteration_log.h"
#include "studies/cli/mesh_notes.h"
#include "studies/cli/piece_commands.h"
#include "studies/cli/smooth_notes.h"

namespace smoothfem {

namespace {

/// Runs work on all processes. Only the first one prints an error. If one process fails in another
/// way, for example because memory is short, all end.
template <class Work>
void on_ranks(const Work& work) {
  const MpiSession session;
  const Ranks ranks(MPI_COMM_WORLD);
  try {
    work(ranks);
  } catch (const InputError&) {
    if (ranks.is_root()) throw;
    throw ExitCode{2};
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "smoothfem: process %d of %d failed: %s\n", ranks.rank() + 1, ranks.size(),
                 dynamic_cast<const std::bad_alloc*>(&error)
                     ? "there is not enough memory; use more processes on more machines"
                     : error.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
}

/// Shares the cores of a machine among its processes, unless the user has said how.
void share_cores(int asked) {
  if (asked > 0) return set_n_threads(asked);
  const char* const n_local = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
  if (std::getenv("OMP_NUM_THREADS") != nullptr || n_local == nullptr) return;
  set_n_threads(std::max(1, n_threads() / std::max(1, std::atoi(n_local))));
}

class Clock {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Largest memory of a process so far, in bytes.
double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Throws InputError for an option that does not work on pieces.
void refuse_options(const SmoothArguments& a) {
  const std::pair<bool, const char*> given[]{{!a.from.empty(), "--from"},
                                             {!a.to.empty(), "--to"},
                                             {!a.fix_rule.empty(), "--fix"},
                                             {!a.series.empty(), "--series"},
                                             {!a.tag_field.empty(), "--tag-field"},
                                             {!a.target.empty(), "--target"},
                                             {a.boundary == "slide", "--boundary slide"},
                                             {a.interfaces != "fixed", "--interfaces"},
                                             {a.periodic != "fixed", "--periodic"},
                                             {a.only_below.has_value(), "--only-below"},
                                             {a.keep_layers.has_value(), "--keep-layers"},
                                             {a.untangle, "--untangle"},
                                             {a.merge, "--merge"},
                                             {a.feature_angle.has_value(), "--feature-angle"},
                                             {a.slide_distance.has_value(), "--slide-distance"}};
  for (const auto& [is_given, option] : given)
    if (is_given)
      throw InputError(std::string(option) +
                       " does not work on a mesh in parts; leave it out, or use one file without "
                       "mpirun");
}

template <int dim>
DistributedMesh<dim> distributed(const Ranks& ranks, ScatteredMesh<dim> mesh) {
  return distribute(ranks, balanced(ranks, std::move(mesh)));
}

/// Counts of the parts, to print.
template <int dim>
std::string parts_text(const Ranks& ranks, const DistributedMesh<dim>& mesh) {
  const MeshPart& part = *mesh.part.topology().part();
  double n_own = 0.0, n_copied_nodes = 0.0;
  for (CellIndex c = 0; c < mesh.part.n_cells(); ++c) n_own += part.owns_cell(c);
  for (NodeIndex i = 0; i < mesh.part.n_nodes(); ++i) n_copied_nodes += !part.owns_node(i);
  const double most = ranks.max(n_own),
               most_neighbours = ranks.max(static_cast<double>(mesh.n_neighbours));
  char text[200];
  std::snprintf(text, sizeof text,
                "%zu nodes and %zu cells on %d %s; the largest part has %.3g times its share of "
                "the cells; at most %.0f copied nodes, of %.0f %s",
                mesh.n_nodes, part.n_cells_of_whole(), ranks.size(),
                ranks.size() == 1 ? "process" : "processes",
                most * ranks.size() / static_cast<double>(part.n_cells_of_whole()),
                ranks.max(n_copied_nodes), most_neighbours,
                most_neighbours == 1.0 ? "process" : "processes");
  return text;
}

void print_quality(const char* when, const MeshQuality& quality) {
  std::printf("%-8s %9.6f %9.6f %9.6f %9zu\n", when, quality.q_min, quality.q_star_min,
              quality.q_mean, quality.n_invalid);
}

/// Writes a row of the log after each iteration, with finite element numbers of the solution that
/// the user names.
template <int dim>
class PartsLog {
 public:
  /// Collective. Throws InputError.
  PartsLog(const Ranks& ranks, const SmoothArguments& arguments, const Mesh<dim>& part)
      : ranks_(ranks), arguments_(arguments) {
    ranks.together([&] {
      if (ranks.is_root()) log_.emplace(arguments.log, arguments.resume);
    });
    if (arguments.solution.empty()) return;
    PoissonOptions options;
    ranks.together([&] {
      solution_ = manufactured_solution<dim>(arguments.solution);
      reinterpret_cast<decltype(&smoothfem_read_finite_elements)>(function_of_module(
          study_module, "smoothfem_read_finite_elements"))(arguments.finite_elements, options);
    });
    const Clock clock;
    solver_.emplace(&part, options, ranks);
    setup_seconds_ = clock.seconds();
  }

  /// Collective.
  void observe(const IterationRecord& record, const Mesh<dim>& now) {
    IterationRow row{.mesh = std::filesystem::path(arguments_.in).stem().string(),
                     .method = arguments_.method,
                     .iteration = record,
                     .degree = solver_ ? 1 : 0,
                     .solved = {},
                     .status = record.quality.n_invalid > 0 ? "invalid mesh" : "not solved"};
    row.iteration.smoothing_seconds = ranks_.max(record.smoothing_seconds);
    row.iteration.preparation_seconds = ranks_.max(record.preparation_seconds);
    bool is_known = log_ && log_->has(row);
    ranks_.broadcast(is_known);
    // The first row is solved again: other problems have other numbers.
    const bool is_check = is_known && record.record == 0;
    if (solver_ && record.quality.n_invalid == 0 && (!is_known || is_check)) {
      const Clock clock;
      row.solved = solver_->solve(now.coordinates(), solution_, false);
      row.status = row.solved->status;
      seconds_ += clock.seconds();
      ++n_solved_;
    }
    ranks_.together([&] {
      if (!log_) return;
      if (record.record == 0 && !is_known && log_->has_rows_left())
        refuse_log("another mesh, method or version");
      if (is_check && row.solved) require_same(row);
      if (is_known)
        log_->keep();
      else
        log_->add(row);
    });
  }

  void finish() {
    ranks_.together([&] {
      if (log_) log_->finish();
    });
  }

  /// Returns a sentence on the solves; empty if there were none. On the root.
  std::string text() const {
    if (!solver_) return {};
    char text[200];
    std::snprintf(text, sizeof text,
                  "finite elements: %zu solves in %.4g s, after %.4g s of preparation; %zu "
                  "rows kept\n",
                  n_solved_, seconds_, setup_seconds_, log_->n_kept());
    return text;
  }

 private:
  [[noreturn]] void refuse_log(const std::string& of_what) const {
    throw InputError(arguments_.log + " has rows of " + of_what +
                     "; leave --resume out, or give another file name");
  }

  /// Throws InputError if the log has other errors of the initial mesh, or other columns of it.
  void require_same(const IterationRow& row) const {
    constexpr double tolerance = 1e-3;  // CG stops early, and elsewhere on other numbers of ranks
    for (const auto& [column, error] : {std::pair{"l2_error", row.solved->l2_error},
                                        std::pair{"h1_error", row.solved->h1_error}}) {
      const auto earlier = log_->number_of_next(column);
      if (!earlier || !(std::abs(*earlier - error) <= tolerance * error))
        refuse_log("another problem: its " + std::string(column) + " of the initial mesh differs");
    }
    if (!log_->fills_columns_of_next(row))
      refuse_log("other finite elements: its columns for the initial mesh differ");
  }

  Ranks ranks_;
  const SmoothArguments& arguments_;
  std::optional<IterationLog> log_;  ///< on the root
  ManufacturedSolution<dim> solution_;
  std::optional<PoissonSolver<dim>> solver_;
  double setup_seconds_ = 0.0, seconds_ = 0.0;
  std::size_t n_solved_ = 0;
};

/// What smoothing leaves: the mesh itself is freed before it is written, which needs memory, too.
template <int dim>
struct SmoothedParts {
  NodeDirectory<NodeEntry<dim>> directory;
  std::string title;
  MeshQuality before;
  SmoothingResult result;
  std::string of_log, fixed;   ///< to print
  double distributed_seconds;  ///< until then
};

template <int dim>
SmoothedParts<dim> smoothed(const Ranks& ranks, const SmoothArguments& arguments,
                            ScatteredMesh<dim> scattered, const Clock& clock) {
  auto method = configured_method<dim>(arguments);
  if (!arguments.allow_worse) method.floor = 1;
  auto mesh = distributed(ranks, std::move(scattered));
  const double distributed_seconds = clock.seconds();
  const std::string parts = parts_text(ranks, mesh);
  if (ranks.is_root() && !arguments.quiet) std::printf("%s\n", parts.c_str());
  const MeshQuality before = mesh_quality(mesh.part);
  std::string fixed = fixed_reasons_text(mesh.part.topology());
  std::optional<PartsLog<dim>> log;
  Observer<dim> observer;
  if (!arguments.log.empty()) {
    log.emplace(ranks, arguments, mesh.part);
    observer = [&](const IterationRecord& record, const Mesh<dim>& now) {
      log->observe(record, now);
    };
  }
  SmoothingResult result = smooth(mesh.part, method, observer);
  if (log) log->finish();
  if (arguments.fail_if_invalid && result.quality.n_invalid > 0)
    throw InputError("the smoothed mesh has " + std::to_string(result.quality.n_invalid) +
                     " invalid cells; nothing is written");
  store_coordinates(mesh);
  return {std::move(mesh.directory),
          method.info.title,
          before,
          std::move(result),
          log && ranks.is_root() ? log->text() : "",
          std::move(fixed),
          distributed_seconds};
}

template <int dim>
void smooth_parts(const Ranks& ranks, const SmoothArguments& arguments, const Pieces& pieces,
                  ScatteredMesh<dim> scattered, const Clock& clock) {
  const double read_seconds = clock.seconds();
  if (ranks.is_root()) print_notes(arguments.in, pieces.notes());
  const auto [directory, title, before, result, of_log, fixed, distributed_seconds] =
      smoothed(ranks, arguments, std::move(scattered), clock);
  const double smoothed_seconds = clock.seconds();
  pieces.write<dim>(arguments.out, directory);
  const double peak = ranks.max(peak_bytes());
  const double seconds = ranks.max(result.smoothing_seconds);
  if (!ranks.is_root()) return;
  print_losses(arguments.out, pieces.losses());
  if (result.quality.n_invalid > 0)
    std::fprintf(stderr, "smoothfem: warning: %s: %zu cells are invalid\n", arguments.out.c_str(),
                 result.quality.n_invalid);
  if (arguments.quiet) return;
  std::printf("%-8s %9s %9s %9s %9s\n", "", "q_min", "q*_min", "q_mean", "invalid");
  print_quality("before", before);
  print_quality("after", result.quality);
  std::printf(
      "%s: %s iterations in %.4g s on %d %s with %d threads each; written to %s\n"
      "%sseconds: %.4g to read, %.4g to distribute, %.4g to smooth, %.4g to write; at most %.3g "
      "GiB "
      "a process\n",
      title.c_str(), result.iterations_text().c_str(), seconds, ranks.size(),
      ranks.size() == 1 ? "process" : "processes", n_threads(),
      pieces.output_text(arguments.out).c_str(), of_log.c_str(), read_seconds,
      distributed_seconds - read_seconds, smoothed_seconds - distributed_seconds,
      clock.seconds() - smoothed_seconds, peak / (1024.0 * 1024.0 * 1024.0));
  if (!fixed.empty()) std::printf("%s\n", fixed.c_str());
}

void print_pieces(const std::string& out, std::size_t n_cells, std::size_t n_pieces) {
  std::printf("%s: %zu cells in %zu %s\n", out.c_str(), n_cells, n_pieces,
              n_pieces == 1 ? "piece" : "pieces");
}

std::vector<std::size_t> counts_of(const std::string& text) {
  std::vector<std::size_t> counts;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (error != std::errc() || end != word.data() + word.size() || count == 0)
      throw InputError("--cells is '" + text +
                       "'; give two or three numbers, for example 20,20,20");
    counts.push_back(count);
  }
  if (counts.size() < 2 || counts.size() > 3)
    throw InputError("--cells is '" + text + "'; give two or three numbers, for example 20,20,20");
  return counts;
}

/// Throws InputError if a box has more cells or nodes than can be numbered.
void require_box_size(const std::string& text, const std::vector<std::size_t>& counts,
                      bool splits) {
  double n_cells = splits ? (counts.size() == 3 ? 6.0 : 2.0) : 1.0, n_nodes = 1.0;
  for (const std::size_t n : counts) {
    n_cells *= static_cast<double>(n);
    n_nodes *= static_cast<double>(n) + 1.0;
  }
  if (std::max(n_cells, n_nodes) > std::numeric_limits<GlobalIndex>::max())
    throw InputError("--cells is '" + text +
                     "', but a mesh can have at most 4294967295 cells and nodes; give smaller "
                     "numbers");
}

}  // namespace
}  // namespace smoothfem

void smoothfem_smooth_pieces(const smoothfem::SmoothArguments& arguments) {
  using namespace smoothfem;
  on_ranks([&](const Ranks& ranks) {
    SmoothArguments all = arguments;
    const Clock clock;
    const Pieces pieces(ranks, all.in);
    if (all.out.empty()) all.out = pieces.default_output().string();
    refuse_options(all);
    ranks.together([&] {
      pieces.require_output(all.out);
      if (!ranks.is_root()) return;
      require_writable_file(all.out);
      if (all.log.empty()) return;
      for (const auto& files : {pieces.input_files(), pieces.output_files(all.out)})
        require_other_files(files, {all.log}, "--log");
      require_writable_file(all.log);
    });
    share_cores(all.n_threads);
    std::visit(
        [&](auto& scattered) { smooth_parts(ranks, all, pieces, std::move(scattered), clock); },
        *std::make_unique<std::variant<ScatteredMesh<2>, ScatteredMesh<3>>>(pieces.read()));
  });
}

void smoothfem_report_pieces(const std::string& mesh, const bool& as_json) {
  using namespace smoothfem;
  on_ranks([&](const Ranks& ranks) {
    share_cores(0);
    const Pieces pieces(ranks, mesh);
    auto scattered = pieces.read();
    if (ranks.is_root()) print_notes(mesh, pieces.notes());
    std::visit(
        [&](auto& of_dim) {
          const auto whole = distributed(ranks, std::move(of_dim));
          const MeshQuality quality = mesh_quality(whole.part);
          const std::string parts = parts_text(ranks, whole);
          if (ranks.is_root() && as_json)
            std::printf("%s\n",
                        nlohmann::ordered_json{
                            {"n_nodes", whole.n_nodes},
                            {"n_cells", whole.part.topology().part()->n_cells_of_whole()},
                            {"q_min", quality.q_min},
                            {"q_star_min", quality.q_star_min},
                            {"q_mean", quality.q_mean},
                            {"n_invalid", quality.n_invalid}}
                            .dump(2)
                            .c_str());
          else if (ranks.is_root())
            std::printf("%s\n%-13s%.6f\n%-13s%.6f\n%-13s%.6f\n%-13s%zu\n", parts.c_str(), "q_min",
                        quality.q_min, "q*_min", quality.q_star_min, "q_mean", quality.q_mean,
                        "invalid", quality.n_invalid);
          if (quality.n_invalid > 0) throw ExitCode{2};
        },
        scattered);
  });
}

void smoothfem_examine_pieces(const std::string& mesh, smoothfem::Examination& seen,
                              bool& is_first) {
  using namespace smoothfem;
  on_ranks([&](const Ranks& ranks) {
    share_cores(0);
    is_first = ranks.is_root();
    const Pieces pieces(ranks, mesh);
    auto scattered = pieces.read(ReadFor::examination);
    if (is_first) print_notes(mesh, pieces.notes());
    try {
      seen = std::visit([&](auto& of_dim) { return examine_parts(ranks, std::move(of_dim)); },
                        scattered);
    } catch (const InputError& error) {
      throw InputError(mesh + ": " + error.what());
    }
  });
}

void smoothfem_generate_box(const smoothfem::BoxArguments& arguments) {
  using namespace smoothfem;
  on_ranks([&](const Ranks& ranks) {
    if (!Pieces::is_list(arguments.out))
      throw InputError("the domain box is written in pieces; name a .pvtu file, not " +
                       arguments.out);
    const auto counts = counts_of(arguments.cells);
    BoxParameters parameters{
        .splits = arguments.split == "tetrahedra" || arguments.split == "triangles",
        .displacement = arguments.displacement,
        .seed = arguments.seed};
    std::copy(counts.begin(), counts.end(), parameters.n.begin());
    require_box_size(arguments.cells, counts, parameters.splits);
    if (!(arguments.displacement >= 0.0 && arguments.displacement < 1.0 / 6.0))
      throw InputError("--displacement is " + std::to_string(arguments.displacement) +
                       ", but cells stay valid only from 0 to below 1/6");
    ranks.together([&] {
      if (ranks.is_root()) require_writable_file(arguments.out);
    });
    const std::size_t n_cells =
        counts.size() == 3 ? write_box<3>(ranks, parameters, arguments.n_pieces, arguments.out)
                           : write_box<2>(ranks, parameters, arguments.n_pieces, arguments.out);
    if (ranks.is_root() && !arguments.quiet)
      print_pieces(arguments.out, n_cells, std::min(arguments.n_pieces, counts.back()));
  });
}

void smoothfem_refine_pieces(const std::string& in, const std::string& out, const bool& quiet) {
  using namespace smoothfem;
  on_ranks([&](const Ranks& ranks) {
    share_cores(0);
    ranks.together([&] {
      if (ranks.is_root()) require_writable_file(out);
    });
    const RefinedPieces refined = refine_pieces(ranks, in, out);
    if (!ranks.is_root()) return;
    print_notes(in, refined.notes);
    print_left_out(in, refined.losses);
    if (!quiet) print_pieces(out, refined.n_cells, refined.n_pieces);
  });
}

void smoothfem_split_mesh(const smoothfem::AnyMesh& mesh, const std::size_t& n_pieces,
                          const std::string& in, const std::string& out) {
  using namespace smoothfem;
  const MpiSession session;
  require_other_files(Pieces(Ranks(MPI_COMM_WORLD), in).input_files(),
                      files_of_list(out, n_pieces));
  std::visit(
      [&]<int dim, int spacedim>(const Mesh<dim, spacedim>& of_kind) {
        if constexpr (dim == spacedim)
          write_in_pieces(of_kind, n_pieces, out);
        else
          throw InputError("surface meshes cannot be written in pieces; name another file than " +
                           out);
      },
      mesh);
}
