#include "smoothing/loop/smooth.h"

#include <algorithm>
#include <chrono>

#include "smoothing/loop/invalid_node_reset.h"

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
class BestMesh {
 public:
  BestMesh(ResultMesh rule, const std::vector<Point<2>>& coordinates, const MeshQuality& quality)
      : rule_(rule) {
    if (rule_ != ResultMesh::last) keep(coordinates, quality);
  }

  /// True if this mesh is the new best.
  bool offer(const std::vector<Point<2>>& coordinates, const MeshQuality& quality) {
    if (rule_ == ResultMesh::last || quality.n_invalid > 0 || !(number(quality) > best_))
      return false;
    keep(coordinates, quality);
    return true;
  }

  /// Puts the best mesh in place of the last one.
  void restore(std::vector<Point<2>>& coordinates) {
    if (rule_ != ResultMesh::last) coordinates = std::move(coordinates_);
  }

 private:
  double number(const MeshQuality& quality) const {
    return rule_ == ResultMesh::best_q_mean ? quality.q_mean : quality.q_star_min;
  }
  void keep(const std::vector<Point<2>>& coordinates, const MeshQuality& quality) {
    best_ = number(quality);
    coordinates_ = coordinates;
  }

  ResultMesh rule_;
  double best_ = 0.0;
  std::vector<Point<2>> coordinates_;
};

/// Over the edges of every cell: an inner edge counts twice, as in the thesis' stopping rule.
double mean_edge_length(const PlanarMesh& mesh) {
  double sum = 0.0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = mesh.topology().cell_nodes(c);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      sum +=
          (mesh.coordinates()[nodes[(k + 1) % nodes.size()]] - mesh.coordinates()[nodes[k]]).norm();
  }
  return sum / static_cast<double>(mesh.topology().cells().n_entries());
}

/// The run of one method: what its stages share.
class SmoothingRun {
 public:
  /// The initial quality costs a method time only if it looks at quality at all.
  SmoothingRun(PlanarMesh& mesh, bool uses_quality, const Observer& observer)
      : state_{mesh, {}}, observer_(observer) {
    if (uses_quality) clock_.start();
    evaluate_quality();
    if (uses_quality) clock_.stop();
    clock_.start();
    mean_edge_length_ = mean_edge_length(state_.mesh);
    clock_.stop();
    observe("initial", 0, 0);
  }

  StageResult run_stage(Smoother<2>& smoother) {
    const SmoothingRule rule = smoother.rule();
    if (rule.needs_valid_mesh) require_valid(state_.mesh);
    StageResult result{std::string(smoother.name()), 0};
    clock_.start();
    smoother.initialize(state_);
    BestMesh best(rule.result, state_.mesh.coordinates(), quality_);
    clock_.stop();
    int n_without_best = 0;
    for (int i = 0; i < rule.max_iterations; ++i) {
      const MeshQuality before = quality_;
      clock_.start();
      const StepReport report = guarded_step(smoother, rule);
      n_without_best = best.offer(state_.mesh.coordinates(), quality_) ? 0 : n_without_best + 1;
      clock_.stop();
      if (rule.quality_use == QualityUse::none) evaluate_quality();
      result.iterations += report.n_counted;
      observe(result.name, result.iterations, report.n_reset);
      if (stops(rule, report, before, n_without_best)) break;
    }
    clock_.start();
    best.restore(state_.mesh.coordinates());
    clock_.stop();
    if (rule.result != ResultMesh::last) evaluate_quality();
    return result;
  }

  SmoothingResult finish(PlanarMesh& mesh, std::vector<StageResult> stages) {
    mesh = std::move(state_.mesh);
    return {std::move(stages), clock_.seconds(), quality_};
  }

 private:
  void evaluate_quality() {
    compute_cell_mean_ratios(state_.mesh, state_.cell_quality);
    quality_ = mesh_quality(state_.mesh.topology(), state_.cell_quality);
  }

  /// One step, and what has to follow it for the quality to be known and every cell valid.
  StepReport guarded_step(Smoother<2>& smoother, const SmoothingRule& rule) {
    if (rule.quality_use == QualityUse::loop) previous_ = state_.mesh.coordinates();
    StepReport report = smoother.step(state_);
    if (rule.quality_use == QualityUse::loop) {
      compute_cell_mean_ratios(state_.mesh, state_.cell_quality);
      report.n_reset += reset_nodes_of_invalid_cells(state_.mesh, previous_, state_.cell_quality);
    }
    if (rule.quality_use != QualityUse::none)
      quality_ = mesh_quality(state_.mesh.topology(), state_.cell_quality);
    return report;
  }

  bool stops(const SmoothingRule& rule, const StepReport& report, const MeshQuality& before,
             int n_without_best) const {
    switch (rule.criterion) {
      case StoppingCriterion::q_mean_gain:
        return !(quality_.q_mean - before.q_mean > rule.tolerance);
      case StoppingCriterion::max_displacement:
        return report.max_displacement < rule.tolerance * mean_edge_length_;
      case StoppingCriterion::q_star_min_stall:
        return n_without_best >= rule.patience;
      case StoppingCriterion::converged:
        return report.converged;
    }
    return true;
  }

  void observe(const std::string& stage, std::size_t iteration, std::size_t n_reset) {
    if (observer_)
      observer_({n_records_, stage, iteration, clock_.seconds(), quality_, n_reset}, state_.mesh);
    ++n_records_;
  }

  SmoothingState<2> state_;
  const Observer& observer_;
  SmoothingClock clock_;
  MeshQuality quality_;
  double mean_edge_length_ = 0.0;
  std::vector<Point<2>> previous_;
  std::size_t n_records_ = 0;
};

}  // namespace

std::string SmoothingResult::iterations_text() const {
  std::string text;
  for (const auto& stage : stages)
    text += (text.empty() ? "" : "/") + std::to_string(stage.iterations);
  return text;
}

SmoothingResult smooth(PlanarMesh& mesh, Method& method, const Observer& observer) {
  const bool uses_quality =
      std::any_of(method.stages.begin(), method.stages.end(),
                  [](const auto& stage) { return stage->rule().quality_use != QualityUse::none; });
  SmoothingRun run(mesh, uses_quality, observer);
  std::vector<StageResult> stages;
  for (auto& stage : method.stages) stages.push_back(run.run_stage(*stage));
  return run.finish(mesh, std::move(stages));
}

}  // namespace smoothfem
