#include "smoothing/loop/smooth.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "smoothing/loop/invalid_node_reset.h"
#include "smoothing/mesh/reordering.h"
#include "smoothing/mesh/volume_elements.h"
#include "smoothing/surface/node_constraints.h"

namespace smoothfem {

namespace {

/// Adds up the time between start() and stop(): what belongs to smoothing.
class SmoothingClock {
 public:
  void start() { started_ = Clock::now(); }
  void stop() { seconds_ += std::chrono::duration<double>(Clock::now() - started_).count(); }
  double seconds() const { return seconds_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point started_;
  double seconds_ = 0.0;
};

/// Remembers the best mesh a stage has met, by the number its rule names.
template <int spacedim>
class BestMesh {
 public:
  BestMesh(ResultMesh rule, const std::vector<Point<spacedim>>& coordinates,
           const MeshQuality& quality, double score)
      : rule_(rule) {
    if (rule_ == ResultMesh::last) return;
    best_ = number(quality, score);
    coordinates_ = coordinates;
  }

  /// True if this mesh, which the step has just reached, is the new best.
  bool offer(const std::vector<Point<spacedim>>& coordinates, const MeshQuality& quality,
             const StepReport& report) {
    if (rule_ == ResultMesh::last) return false;
    if (const auto* moved = report.moved)
      moved_since_best_.insert(moved_since_best_.end(), moved->begin(), moved->end());
    else
      all_moved_ = true;
    if (quality.n_invalid > 0 || !(number(quality, report.score) > best_)) return false;
    best_ = number(quality, report.score);
    if (all_moved_)
      coordinates_ = coordinates;
    else
      for (const NodeIndex i : moved_since_best_) coordinates_[i] = coordinates[i];
    moved_since_best_.clear();
    all_moved_ = false;
    return true;
  }

  /// Puts the best mesh in place of the last one.
  void restore(std::vector<Point<spacedim>>& coordinates) {
    if (rule_ != ResultMesh::last) coordinates = std::move(coordinates_);
  }

 private:
  double number(const MeshQuality& quality, double score) const {
    if (rule_ == ResultMesh::best_score) return score;
    return rule_ == ResultMesh::best_q_mean ? quality.q_mean : quality.q_star_min;
  }

  ResultMesh rule_;
  double best_ = 0.0;
  std::vector<Point<spacedim>> coordinates_;
  std::vector<NodeIndex> moved_since_best_;
  bool all_moved_ = false;
};

/// The highest quality numbers met so far, and how long ago.
class QualityRecord {
 public:
  explicit QualityRecord(const MeshQuality& initial)
      : q_min_(initial.q_min), q_star_min_(initial.q_star_min), q_mean_(initial.q_mean) {}

  void add(const MeshQuality& quality) {
    const bool gain = quality.q_min > q_min_ || quality.q_mean > q_mean_;
    n_without_gain_ = gain ? 0 : n_without_gain_ + 1;
    q_min_ = std::max(q_min_, quality.q_min);
    q_star_min_ = std::max(q_star_min_, quality.q_star_min);
    q_mean_ = std::max(q_mean_, quality.q_mean);
  }
  double q_star_min() const { return q_star_min_; }
  int n_without_gain() const { return n_without_gain_; }

 private:
  double q_min_, q_star_min_, q_mean_;
  int n_without_gain_ = 0;
};

/// Over the edges of every cell: an inner edge counts once a cell, as in the thesis' stopping rule.
template <int dim, int spacedim>
double mean_edge_length(const Mesh<dim, spacedim>& mesh) {
  double sum = 0.0;
  std::size_t n_edges = 0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = mesh.topology().cell_nodes(c);
    for_each_edge(dim, nodes.size(), [&](std::size_t a, std::size_t b) {
      sum += (mesh.coordinates()[nodes[b]] - mesh.coordinates()[nodes[a]]).norm();
      ++n_edges;
    });
  }
  return sum / static_cast<double>(n_edges);
}

template <int dim, int spacedim>
bool any_stage(const Method<dim, spacedim>& method, const auto& condition) {
  return std::any_of(method.stages.begin(), method.stages.end(),
                     [&](const auto& stage) { return condition(stage->rule()); });
}

/// The run of one method: what its stages share.
template <int dim, int spacedim>
class SmoothingRun {
 public:
  /// The initial quality costs a method time only if it looks at quality at all.
  SmoothingRun(Mesh<dim, spacedim>& mesh, const Method<dim, spacedim>& method,
               const Observer<dim, spacedim>& observer)
      : users_mesh_(mesh), state_{mesh, {}}, observer_(observer) {
    require_constraints_kept(method);
    reorder(method);
    if (!reordering_) state_.mesh.topology().node_cells(0);  // of the mesh, and so no method's time
    const bool uses_quality =
        any_stage(method, [](const auto& rule) { return rule.quality_use != QualityUse::none; });
    if (uses_quality) clock_.start();
    evaluate_quality();
    if (uses_quality) clock_.stop();
    state_.initial_quality = quality_;
    if (any_stage(method, [](const auto& rule) {
          return rule.criterion == StoppingCriterion::max_displacement;
        })) {
      clock_.start();
      mean_edge_length_ = mean_edge_length(state_.mesh);
      clock_.stop();
    }
    observe("initial", 0, 0);
    if (!observer_) std::vector<Point<spacedim>>().swap(users_mesh_.coordinates());
  }

  StageResult run_stage(Smoother<dim, spacedim>& smoother) {
    const SmoothingRule rule = smoother.rule();
    if (rule.needs_valid_mesh && quality_.n_invalid > 0) require_valid(users_mesh());
    StageResult result{std::string(smoother.name()), 0};
    clock_.start();
    smoother.initialize(state_);
    BestMesh<spacedim> best(rule.result, state_.mesh.coordinates(), quality_,
                            smoother.initial_score());
    clock_.stop();
    int n_without_best = 0;
    QualityRecord highest(quality_);
    for (int i = 0; i < rule.max_iterations; ++i) {
      const MeshQuality before = quality_;
      clock_.start();
      const StepReport report = guarded_step(smoother, rule);
      const bool is_best = best.offer(state_.mesh.coordinates(), quality_, report);
      n_without_best = is_best ? 0 : n_without_best + 1;
      if (is_best || rule.result == ResultMesh::last) result_record_ = n_records_;
      clock_.stop();
      complete_quality(rule, report);
      result.iterations += report.n_counted;
      observe(result.name, result.iterations, report.n_reset);
      highest.add(quality_);
      if (stops(rule, report, before, n_without_best, highest)) break;
    }
    clock_.start();
    best.restore(state_.mesh.coordinates());
    clock_.stop();
    if (rule.result != ResultMesh::last) evaluate_quality();
    return result;
  }

  /// Gives the caller's mesh the present places.
  void give_back() { users_mesh_.coordinates() = users_mesh().coordinates(); }
  SmoothingResult result(std::vector<StageResult> stages) const {
    return {std::move(stages), clock_.seconds(), quality_, result_record_};
  }

 private:
  void require_constraints_kept(const Method<dim, spacedim>& method) const {
    if (state_.mesh.constraints() && !keeps_constraints(method))
      throw InputError("method " + method.info.name +
                       " cannot keep boundary nodes on the boundary; fix them, or take one of " +
                       joined(methods_that_take<dim, spacedim>(true)));
  }

  /// Small meshes stay in the cache in any order, and keep the sums of the published numbers.
  /// Constraints know nodes by their numbers.
  void reorder(const Method<dim, spacedim>& method) {
    constexpr std::size_t min_nodes = 16384;
    if (state_.mesh.constraints() || state_.mesh.n_nodes() < min_nodes ||
        any_stage(method, [](const auto& rule) { return rule.needs_node_order; }))
      return;
    if constexpr (dim == spacedim) {
      clock_.start();
      reordering_.emplace(state_.mesh.topology());
      Mesh<dim> ordered = reordering_->apply(state_.mesh);
      clock_.stop();
      state_.mesh = std::move(ordered);
    }
  }

  /// The present mesh in the caller's order.
  const Mesh<dim, spacedim>& users_mesh() {
    if (!reordering_) return state_.mesh;
    users_mesh_.coordinates().resize(state_.mesh.n_nodes());
    reordering_->restore(state_.mesh.coordinates(), users_mesh_.coordinates());
    return users_mesh_;
  }

  void evaluate_quality() { quality_ = compute_cell_mean_ratios(state_.mesh, state_.cell_quality); }

  /// One step, and what has to follow it for the quality to be known and every cell valid.
  StepReport guarded_step(Smoother<dim, spacedim>& smoother, const SmoothingRule& rule) {
    if (rule.quality_use == QualityUse::loop) previous_ = state_.mesh.coordinates();
    StepReport report = smoother.step(state_);
    if (rule.quality_use == QualityUse::loop) {
      evaluate_quality();
      if (quality_.n_invalid > 0 || has_facet_bound(state_.mesh)) {
        report.n_reset +=
            reset_nodes_of_invalid_cells(state_.mesh, previous_, state_.cell_quality).size();
        quality_ = mesh_quality(state_.mesh.topology(), state_.cell_quality);
      }
    }
    if (rule.quality_use == QualityUse::smoother) {
      if (report.quality)
        quality_ = *report.quality;
      else if (report.q_star_min)
        quality_.q_star_min = *report.q_star_min;
      else
        quality_ = mesh_quality(state_.mesh.topology(), state_.cell_quality);
    }
    return report;
  }

  /// What the method need not know, but whoever looks on wants to: not part of its time.
  void complete_quality(const SmoothingRule& rule, const StepReport& report) {
    if (rule.quality_use == QualityUse::none)
      evaluate_quality();
    else if (rule.quality_use == QualityUse::smoother && !report.quality && observer_)
      quality_ = mesh_quality(state_.mesh.topology(), state_.cell_quality);
  }

  bool stops(const SmoothingRule& rule, const StepReport& report, const MeshQuality& before,
             int n_without_best, const QualityRecord& highest) const {
    switch (rule.criterion) {
      case StoppingCriterion::q_mean_gain:
        return !(quality_.q_mean - before.q_mean > rule.tolerance);
      case StoppingCriterion::q_mean_change:
        return std::abs(quality_.q_mean - before.q_mean) <= rule.tolerance ||
               highest.n_without_gain() >= rule.patience;
      case StoppingCriterion::max_displacement:
        return report.max_displacement < rule.tolerance * mean_edge_length_;
      case StoppingCriterion::result_stall:
        return report.converged ||
               n_without_best >= (highest.q_star_min() < state_.initial_quality.q_star_min
                                      ? patience_below_start
                                      : 1) *
                                     rule.patience;
      case StoppingCriterion::converged:
        return report.converged;
    }
    return true;
  }

  void observe(const std::string& stage, std::size_t iteration, std::size_t n_reset) {
    if (observer_)
      observer_({n_records_, stage, iteration, clock_.seconds(), quality_, n_reset}, users_mesh());
    ++n_records_;
  }

  Mesh<dim, spacedim>& users_mesh_;  ///< without places while nobody looks: large meshes need them
  SmoothingState<dim, spacedim> state_;
  const Observer<dim, spacedim>& observer_;
  std::optional<Reordering<spacedim>> reordering_;
  SmoothingClock clock_;
  MeshQuality quality_;
  double mean_edge_length_ = 0.0;
  std::vector<Point<spacedim>> previous_;
  std::size_t n_records_ = 0, result_record_ = 0;
};

}  // namespace

std::string SmoothingResult::iterations_text() const {
  std::string text;
  for (const auto& stage : stages)
    text += (text.empty() ? "" : "/") + std::to_string(stage.iterations);
  return text;
}

template <int dim, int spacedim>
SmoothingResult smooth(Mesh<dim, spacedim>& mesh, Method<dim, spacedim>& method,
                       const std::type_identity_t<Observer<dim, spacedim>>& observer) {
  SmoothingRun<dim, spacedim> run(mesh, method, observer);
  std::vector<StageResult> stages;
  try {
    for (auto& stage : method.stages) stages.push_back(run.run_stage(*stage));
  } catch (...) {
    run.give_back();
    throw;
  }
  run.give_back();
  return run.result(std::move(stages));
}

template SmoothingResult smooth(Mesh<2>&, Method<2>&, const Observer<2>&);
template SmoothingResult smooth(Mesh<3>&, Method<3>&, const Observer<3>&);
template SmoothingResult smooth(Mesh<2, 3>&, Method<2, 3>&, const Observer<2, 3>&);

}  // namespace smoothfem
