// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/smooth.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "smoothing/base/interruption.h"
#include "smoothing/base/scoped_timer.h"
#include "smoothing/geometry/extreme_size.h"
#include "smoothing/loop/best_mesh.h"
#include "smoothing/loop/invalid_node_reset.h"
#include "smoothing/loop/stage_history.h"
#include "smoothing/mesh/node_constraints.h"
#include "smoothing/mesh/reordering.h"
#include "smoothing/mesh/volume_elements.h"
#include "smoothing/parts/exact_sum.h"
#include "smoothing/parts/shared_coordinates.h"
#include "smoothing/second_order/smooth_second_order.h"

namespace smoothfem {

namespace {

/// Calls visit(length) for the edges of every cell; in a part of a mesh, of the cells it owns.
template <int dim, int spacedim, class Visit>
void for_each_edge_length(const Mesh<dim, spacedim>& mesh, const Visit& visit) {
  const MeshPart* const part = mesh.topology().part();
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    if (part && !part->owns_cell(c)) continue;
    const auto nodes = mesh.topology().cell_nodes(c);
    for_each_edge(dim, nodes.size(), [&](std::size_t a, std::size_t b) {
      visit((mesh.coordinates()[nodes[b]] - mesh.coordinates()[nodes[a]]).norm());
    });
  }
}

/// Returns the mean over the edges of every cell. As in the thesis' stopping rule, an inner edge
/// counts once for each of its cells.
template <int dim, int spacedim>
double mean_edge_length(const Mesh<dim, spacedim>& mesh) {
  std::size_t n_edges = 0;
  if (const MeshPart* part = mesh.topology().part()) {
    ExactSum sum;
    for_each_edge_length(mesh, [&](double length) {
      sum.add(length);
      ++n_edges;
    });
    return sum.total(*part) / static_cast<double>(part->sum(n_edges));
  }
  double sum = 0.0;
  for_each_edge_length(mesh, [&](double length) {
    sum += length;
    ++n_edges;
  });
  return sum / static_cast<double>(n_edges);
}

template <int dim, int spacedim>
bool any_stage(const Method<dim, spacedim>& method, const auto& condition) {
  return std::any_of(method.stages.begin(), method.stages.end(),
                     [&](const auto& stage) { return condition(*stage); });
}

/// True if a stage needs the quality of its meshes, for its steps or for the choice of its result.
bool needs_quality(const SmootherTraits& traits) {
  return traits.quality_use != QualityUse::none || traits.result == ResultMesh::best_q_mean;
}

/// State that the stages of one method's run share. It holds the caller's mesh while it lives;
/// large meshes are reordered for memory locality.
template <int dim, int spacedim>
class SmoothingRun {
 public:
  SmoothingRun(Mesh<dim, spacedim>& mesh, const Observer<dim, spacedim>& observer)
      : caller_mesh_(mesh), state_{std::move(mesh), {}}, observer_(observer) {}
  /// Returns the mesh to the caller, in the state of the last iteration.
  ~SmoothingRun() {
    if constexpr (dim == spacedim)
      if (reordering_) state_.mesh = std::move(*reordering_).undo(std::move(state_.mesh));
    caller_mesh_ = std::move(state_.mesh);
  }
  SmoothingRun(const SmoothingRun&) = delete;
  SmoothingRun& operator=(const SmoothingRun&) = delete;

  /// The initial quality counts as a method's time only if the method uses quality.
  void start(const Method<dim, spacedim>& method) {
    if (method.info.needs_problem()) {
      solver_ = method.problem->make_solver();
      state_.solver = solver_.get();
    }
    reorder(method);
    // Built here so that its cost is not charged to a method.
    if (!reordering_) state_.mesh.topology().build_node_cells();
    double uncounted_seconds = 0.0;
    {
      const bool uses_quality =
          any_stage(method, [](const auto& stage) { return needs_quality(stage.traits()); });
      const ScopedTimer timer(uses_quality ? preparation_seconds_ : uncounted_seconds);
      evaluate_quality();
    }
    state_.initial_quality = quality_;
    if (method.floor != 0 && quality_.n_invalid == 0)
      initial_.assign(state_.mesh.coordinates().begin(), state_.mesh.coordinates().end());
    if (any_stage(method, [](const auto& stage) {
          return stage.stopping().criterion == StoppingRule::Criterion::max_displacement;
        })) {
      const ScopedTimer timer(preparation_seconds_);
      mean_edge_length_ = mean_edge_length(state_.mesh);
    }
    observe("initial", 0, {});
  }

  StageResult run_stage(Smoother<dim, spacedim>& smoother) {
    const SmootherTraits traits = smoother.traits();
    const StoppingRule stopping = smoother.stopping();
    if (traits.needs_valid_mesh && quality_.n_invalid > 0) refuse_invalid();
    StageResult result{.name = std::string(smoother.name()),
                       .why_stopped = "reached max_iterations"};
    std::optional<BestMesh<spacedim>> best;
    {
      // With a problem, the work before the first step is mostly a solve.
      const ScopedTimer timer(solver_ ? seconds_ : preparation_seconds_);
      smoother.initialize(state_);
      best.emplace(traits.result, state_.mesh.coordinates(), quality_, smoother.initial_score(),
                   traits.quality_use == QualityUse::none);
    }
    StageHistory history(quality_);
    const double begin_seconds = seconds_;
    for (int i = 0; i < stopping.max_iterations; ++i) {
      StepReport report;
      bool is_best;
      {
        const ScopedTimer timer(seconds_);
        report = guarded_step(smoother, traits);
        is_best = best->offer(state_.mesh.coordinates(), quality_, report);
        if (is_best || traits.result == ResultMesh::last) result_record_ = n_records_;
      }
      if (report.stage_seconds) seconds_ = begin_seconds + *report.stage_seconds;
      complete_quality(traits, report);
      result.iterations += report.n_counted;
      observe(result.name, result.iterations, report);
      if (holds_anywhere(state_.mesh.topology(), interruption())) throw Interrupted{};
      history.add(quality_, is_best);
      result.n_last_reset = report.n_reset;
      if (auto why = history.why_stop(stopping, report, state_.initial_quality.q_star_min,
                                      mean_edge_length_)) {
        result.why_stopped = *std::move(why);
        break;
      }
    }
    {
      const ScopedTimer timer(seconds_);
      best->restore(state_.mesh);
    }
    if (traits.result != ResultMesh::last) evaluate_quality();
    return result;
  }

  /// Resets nodes until no cell is worse than the worst one of the initial mesh (Method::floor).
  /// This ends: a cell whose nodes all have their initial positions is not worse.
  void keep_floor() {
    if (initial_.empty()) return;
    const double floor = state_.initial_quality.q_min;
    StepReport report{.n_counted = 0};
    {
      const ScopedTimer timer(seconds_);
      evaluate_quality();
      if (quality_.n_invalid == 0 && quality_.q_min >= floor) return;
      report.n_made_invalid = quality_.n_invalid;
      report.n_reset = count_in_whole(
          state_.mesh.topology(),
          reset_nodes_of_invalid_cells(state_.mesh, initial_, state_.cell_quality, floor));
      quality_ = mesh_quality(state_.mesh.topology(), state_.cell_quality);
    }
    n_floor_reset_ = report.n_reset;
    n_floor_invalid_ = *report.n_made_invalid;
    result_record_ = n_records_;
    observe("floor", 1, report);
  }

  SmoothingResult result(std::vector<StageResult> stages) const {
    return {std::move(stages), seconds_,       preparation_seconds_, quality_,
            result_record_,    n_floor_reset_, n_floor_invalid_};
  }

 private:
  void refuse_invalid() {
    if (state_.mesh.topology().part() == nullptr) require_valid(in_original_order());
    throw InputError(std::to_string(quality_.n_invalid) +
                     " cells of the mesh are invalid; 'smoothfem check' names them; without "
                     "mpirun, 'smoothfem repair' turns over cells that run backwards, and "
                     "'smoothfem smooth --untangle' repairs others");
  }

  /// Reorders large meshes. Small meshes fit the cache in any order, and without reordering keep
  /// the published numbers' order of sums. Constraints refer to node numbers, and problems refer to
  /// boundary parts by labels, and targets refer to cell numbers; such meshes are not reordered.
  /// Neither are meshes of second order, whose midside nodes a new order leaves out, and parts.
  void reorder(const Method<dim, spacedim>& method) {
    constexpr std::size_t min_nodes = 16384;
    // Sweeps in the mesh's own order also need nodes stored in that order. With the nodes of a
    // neighbourhood stored together they took twice the time (Laplace, 580,000 tetrahedra as Gmsh
    // numbers them).
    if (state_.mesh.constraints() || state_.mesh.targets() || solver_ ||
        state_.mesh.topology().midside() || state_.mesh.topology().part() ||
        state_.mesh.n_nodes() < min_nodes ||
        any_stage(method, [](const auto& stage) { return stage.traits().needs_node_order; }))
      return;
    if constexpr (dim == spacedim) {
      const ScopedTimer timer(preparation_seconds_);
      reordering_.emplace(state_.mesh.shared_topology());
      state_.mesh = reordering_->apply(std::move(state_.mesh));
    }
  }

  /// Returns the present mesh in the caller's order.
  const Mesh<dim, spacedim>& in_original_order() {
    if constexpr (dim == spacedim)
      if (reordering_) {
        if (view_)
          reordering_->restore(state_.mesh.coordinates(), view_->coordinates());
        else
          view_.emplace(reordering_->restored(state_.mesh));
        return *view_;
      }
    return state_.mesh;
  }

  void evaluate_quality() { quality_ = compute_cell_mean_ratios(state_.mesh, state_.cell_quality); }

  /// Makes one step, resets nodes of invalid cells and updates the quality, as the traits require.
  StepReport guarded_step(Smoother<dim, spacedim>& smoother, const SmootherTraits& traits) {
    if (traits.quality_use == QualityUse::loop)
      previous_.assign(state_.mesh.coordinates().begin(), state_.mesh.coordinates().end());
    StepReport report = smoother.step(state_);
    if (traits.quality_use == QualityUse::loop) {
      evaluate_quality();
      report.n_made_invalid = quality_.n_invalid;
      if (quality_.n_invalid > 0 || has_facet_bound(state_.mesh)) {
        report.n_reset += count_in_whole(
            state_.mesh.topology(),
            reset_nodes_of_invalid_cells(state_.mesh, previous_, state_.cell_quality));
        quality_ = mesh_quality(state_.mesh.topology(), state_.cell_quality);
      }
    }
    if (traits.quality_use == QualityUse::none && needs_quality(traits)) evaluate_quality();
    if (traits.quality_use == QualityUse::smoother) {
      if (report.quality)
        quality_ = *report.quality;
      else if (report.q_star_min)
        quality_.q_star_min = *report.q_star_min;
      else
        quality_ = mesh_quality(state_.mesh.topology(), state_.cell_quality);
    }
    return report;
  }

  /// Completes the quality for stopping rules and observers. The method does not need it, so that
  /// it is not part of its time.
  void complete_quality(const SmootherTraits& traits, const StepReport& report) {
    if (!needs_quality(traits))
      evaluate_quality();
    else if (traits.quality_use == QualityUse::smoother && !report.quality && observer_)
      quality_ = mesh_quality(state_.mesh.topology(), state_.cell_quality);
  }

  void observe(const std::string& stage, std::size_t iteration, const StepReport& report) {
    if (observer_)
      observer_({n_records_, stage, iteration, seconds_, preparation_seconds_, report.wall_seconds,
                 quality_, report.n_made_invalid, report.n_reset,
                 solver_ ? std::optional(solver_->effort()) : std::nullopt},
                in_original_order());
    ++n_records_;
  }

  Mesh<dim, spacedim>& caller_mesh_;
  SmoothingState<dim, spacedim> state_;
  const Observer<dim, spacedim>& observer_;
  std::unique_ptr<ProblemSolver<spacedim>> solver_;  ///< null: the method needs none
  std::optional<Reordering<spacedim>> reordering_;
  std::optional<Mesh<dim, spacedim>> view_;  ///< the mesh in the caller's order, if reordered
  double seconds_ = 0.0;                     ///< of the main loops
  double preparation_seconds_ = 0.0;
  MeshQuality quality_;
  double mean_edge_length_ = 0.0;
  std::vector<Point<spacedim>> previous_;
  std::vector<Point<spacedim>> initial_;  ///< empty without a floor
  std::size_t n_floor_reset_ = 0, n_floor_invalid_ = 0;
  std::size_t n_records_ = 0, result_record_ = 0;
};

template <int dim, int spacedim>
void require_constraints_kept(const Mesh<dim, spacedim>& mesh,
                              const Method<dim, spacedim>& method) {
  if (mesh.constraints() && !keeps_constraints(method))
    throw InputError(
        "method " + method.info.name +
        " cannot keep nodes on the boundary or on interfaces; fix them, or use one of " +
        joined(methods_supporting<dim, spacedim>(true)));
}

template <int dim, int spacedim>
void require_targets_taken(const Mesh<dim, spacedim>& mesh, const Method<dim, spacedim>& method) {
  if constexpr (dim == spacedim)
    if (mesh.targets() && !takes_targets(method))
      throw InputError("method " + method.info.name +
                       " knows regular elements only and cannot take targets; use one of " +
                       joined(methods_with_targets<dim>()));
}

template <int dim, int spacedim>
void require_parts_taken(const Mesh<dim, spacedim>& mesh, const Method<dim, spacedim>& method) {
  if (mesh.topology().part() && !works_in_parts(method))
    throw InputError("method " + method.info.name +
                     " needs the whole mesh, without mpirun; methods for a mesh in parts are " +
                     joined(methods_for_parts<dim, spacedim>()));
}

template <int dim, int spacedim>
void require_problem(const Method<dim, spacedim>& method) {
  if (method.info.needs_problem() && !method.problem)
    throw InputError("method " + method.info.name +
                     " moves nodes by the solution of a problem; it works only in a study "
                     "with a solution");
}

template <int dim, int spacedim>
SmoothingResult smooth_unscaled(Mesh<dim, spacedim>& mesh, Method<dim, spacedim>& method,
                                const Observer<dim, spacedim>& observer) {
  SmoothingRun<dim, spacedim> run(mesh, observer);
  run.start(method);
  std::vector<StageResult> stages;
  for (auto& stage : method.stages) stages.push_back(run.run_stage(*stage));
  run.keep_floor();
  return run.result(std::move(stages));
}

/// Scales a mesh during its lifetime.
template <int dim, int spacedim>
class ScaledMesh {
 public:
  ScaledMesh(Mesh<dim, spacedim>& mesh, int exponent) : mesh_(mesh), exponent_(exponent) {
    scale_by_power_of_two(mesh_.coordinates(), exponent_);
  }
  ~ScaledMesh() { scale_by_power_of_two(mesh_.coordinates(), -exponent_); }
  ScaledMesh(const ScaledMesh&) = delete;
  ScaledMesh& operator=(const ScaledMesh&) = delete;

 private:
  Mesh<dim, spacedim>& mesh_;
  int exponent_;
};

/// Returns the exponent that extreme coordinates are scaled by, 0 for ordinary ones.
template <int dim, int spacedim>
int extreme_exponent_of_whole(const Mesh<dim, spacedim>& mesh) {
  const int own = extreme_exponent(mesh.coordinates());
  const MeshPart* const part = mesh.topology().part();
  if (part && part->any(own != 0))
    throw InputError("a mesh in parts has coordinates that are too large or too small; scale it");
  return own;
}

/// Smooths a mesh whose midside nodes, if it has some, are nodes like others.
template <int dim, int spacedim>
SmoothingResult smooth_nodes(Mesh<dim, spacedim>& mesh, Method<dim, spacedim>& method,
                             const Observer<dim, spacedim>& observer) {
  require_constraints_kept(mesh, method);
  require_targets_taken(mesh, method);
  require_parts_taken(mesh, method);
  require_problem(method);
  const int own_exponent = extreme_exponent_of_whole(mesh);
  require_ordinary_numbers(own_exponent);
  // Scaling would move the mesh off its constraints, its targets and its problem.
  const int exponent =
      mesh.constraints() || mesh.targets() || method.info.needs_problem() ? 0 : own_exponent;
  if (exponent == 0) return smooth_unscaled(mesh, method, observer);
  const ScaledMesh scaled(mesh, -exponent);
  Observer<dim, spacedim> rescaling_observer;
  if (observer)
    rescaling_observer = [&](const IterationRecord& record, const Mesh<dim, spacedim>& now) {
      Mesh<dim, spacedim> unscaled = now;
      scale_by_power_of_two(unscaled.coordinates(), exponent);
      observer(record, unscaled);
    };
  return smooth_unscaled(mesh, method, rescaling_observer);
}

template <int dim, int spacedim>
SmoothingResult smooth_of_second_order(Mesh<dim, spacedim>& mesh, Method<dim, spacedim>& method,
                                       const Observer<dim, spacedim>& observer) {
  if constexpr (spacedim > dim) {
    throw InputError(
        "surface meshes of second order cannot be smoothed; save the mesh with linear cells");
  } else {
    if (method.info.needs_problem())
      throw InputError("method " + method.info.name +
                       " solves a problem on linear cells; it does not support meshes of second "
                       "order");
    if (moves_midside_nodes(method)) {
      const bool needs_valid =
          any_stage(method, [](const auto& stage) { return stage.traits().needs_valid_mesh; });
      return smooth_with_midside_nodes(mesh, needs_valid, [&](Mesh<dim>& whole) {
        return smooth_nodes(whole, method, observer);
      });
    }
    return smooth_second_order(mesh, CornerNumbers::dense, method.floor != 0, observer,
                               [&](Mesh<dim>& corners, const Observer<dim>& of_corners) {
                                 return smooth(corners, method, of_corners);
                               });
  }
}

}  // namespace

std::string SmoothingResult::iterations_text() const {
  std::string text;
  for (const auto& stage : stages) {
    if (!text.empty()) text += '/';
    text += std::to_string(stage.iterations);
  }
  return text;
}

template <int dim, int spacedim>
SmoothingResult smooth(Mesh<dim, spacedim>& mesh, Method<dim, spacedim>& method,
                       const std::type_identity_t<Observer<dim, spacedim>>& observer) {
  return mesh.topology().midside() ? smooth_of_second_order(mesh, method, observer)
                                   : smooth_nodes(mesh, method, observer);
}

template SmoothingResult smooth(Mesh<2>&, Method<2>&, const Observer<2>&);
template SmoothingResult smooth(Mesh<3>&, Method<3>&, const Observer<3>&);
template SmoothingResult smooth(Mesh<2, 3>&, Method<2, 3>&, const Observer<2, 3>&);

}  // namespace smoothfem
