// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>
#include <optional>

#include "smoothing/getme/min_tree.h"
#include "smoothing/getme/neighbour_sizes.h"
#include "smoothing/getme/regularize.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/quality/local_quality.h"
#include "smoothing/quality/target_corners.h"
#include "smoothing/quality/warpage.h"

namespace smoothfem {
namespace {

template <int dim>
ElementParameters<dim> default_parameters() {
  if constexpr (dim == 2)
    return {.lambda = 9.0 / 20.0, .theta_degrees = 25.0, .rho = 0.01};
  else  // Tetrahedra and hexahedra: Section 6.3. Pyramids and prisms: Section 5.4.
    return {.tetrahedron = {17.0, 17.0},
            .pyramid = {1.82, 1.82},
            .prism = {0.85, 0.85},
            .hexahedron = {17.0, 17.0},
            .rho = 0.01};
}

/// Chooses the next element by its mean ratio.
struct ByMeanRatio {
  static constexpr std::string_view stage_name = "sequential";
  static constexpr ResultMesh result = ResultMesh::best_q_star_min;
  static constexpr int cycle = 100, patience = 10;

  Parameters parameters() { return {}; }
  template <class AMesh>
  double operator()(const AMesh&, CellIndex, double mean_ratio) const {
    return mean_ratio;
  }
};

/// Chooses it by q_gamma = min(mean ratio, gamma (1 - warpage / 2)) (thesis, Section 4.7).
struct ByMeanRatioAndWarpage {
  static constexpr std::string_view stage_name = "qgamma";
  static constexpr ResultMesh result = ResultMesh::best_score;
  static constexpr int cycle = 1, patience = 10;
  double gamma = 0.25;

  Parameters parameters() {
    return {{"gamma",
             "weight of the warpage: large values raise the mean ratio, small ones flatten faces "
             "(Section 4.7)",
             &gamma, 1e-9, 1e9}};
  }
  double operator()(const VolumeMesh& mesh, CellIndex cell, double mean_ratio) const {
    double warpage = 0.0;
    with_corners<3>(mesh.topology().cell_nodes(cell), mesh.coordinates().data(),
                    [&](auto corners) { warpage = element_warpage(corners); });
    return std::min(mean_ratio, gamma * (1.0 - 0.5 * warpage));
  }
};

/// Transforms the element with the lowest corrected quality, alone, again and again (thesis,
/// Section 4.3, Fig. 4.3). A step is a cycle of such transformations; the lowest quality is
/// evaluated after it. Assessment: the quality of an element.
template <int dim, int spacedim, class Assessment>
class GetmeSequential final : public Smoother<dim, spacedim> {
 public:
  std::string_view name() const override { return Assessment::stage_name; }

  Parameters parameters() override {
    Parameters all = element_.parameters();
    const Parameters own = {
        {"penalty_invalid", "added to an element's penalty when its transformation is undone",
         &penalty_invalid_, 0.0, 1.0},
        {"penalty_repeated", "added when the element is picked twice in a row", &penalty_repeated_,
         0.0, 1.0},
        {"penalty_success", "added when the transformation is kept; penalties never fall below 0",
         &penalty_success_, -1.0, 0.0},
        {"cycle", "transformations between evaluations of the lowest quality (Section 6.2)",
         &cycle_, 1.0, 1e9},
        {"patience", "stop after this many evaluations without improving the lowest quality",
         &patience_, 1.0, 1e9},
        {"patience_below_start",
         "factor on `patience` while the best q*_min is below that of the method's initial mesh; "
         "not in the thesis, which corresponds to 1",
         &patience_below_start_, 1.0, 1e6},
        {"max_cycles", "largest number of cycles", &max_cycles_, 1.0, 1e9},
        {"max_mean_loss",
         "stop when q_mean, evaluated once a cycle, has fallen by more than this fraction of its "
         "value at the stage's start (Section 5.2)",
         &max_mean_loss_, 0.0, 1.0},
        {"perfect",
         "stop when the lowest quality is above 1 minus this; not in the thesis. The last digits "
         "of "
         "a perfect mesh would take thousands of times as long as the mesh",
         &perfect_, 0.0, 1.0}};
    all.insert(all.end(), own.begin(), own.end());
    for (auto& parameter : assess_.parameters()) all.push_back(std::move(parameter));
    return all;
  }

  SmootherTraits traits() const override {
    return {.quality_use = QualityUse::smoother,
            .result = Assessment::result,
            .keeps_constraints = true,
            .takes_targets = Assessment::result == ResultMesh::best_q_star_min};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::result_stall,
            .patience = patience_,
            .patience_below_start = patience_below_start_,
            .max_iterations = max_cycles_};
  }

  /// Only elements with a free node take part.
  void initialize(const SmoothingState<dim, spacedim>& state) override {
    regularization_.emplace(state.mesh.targets() ? with_given_sizes(element_) : element_);
    const auto& topology = state.mesh.topology();
    std::vector<double> keys(topology.n_cells(), MinTree::never);
    for (CellIndex c = 0; c < topology.n_cells(); ++c)
      if (topology.has_free_node(c)) keys[c] = assess_(state.mesh, c, state.cell_quality[c]);
    by_quality_.build(std::move(keys));
    by_corrected_quality_ = by_quality_;
    penalties_.assign(topology.n_cells(), 0.0);
    touched_in_.assign(topology.n_cells(), 0);
    quality_gain_ = 0.0;
    initial_quality_sum_ =
        std::accumulate(state.cell_quality.begin(), state.cell_quality.end(), 0.0);
    n_transformations_ = 0;
    last_picked_ = no_cell;
  }

  double initial_score() const override { return lowest_quality(); }

  StepReport step(SmoothingState<dim, spacedim>& state) override {
    StepReport report{.n_counted = 0};
    moved_in_cycle_.clear();
    for (int i = 0; i < cycle_ && !by_corrected_quality_.empty() && !is_perfect(); ++i) {
      const CellIndex worst = worst_cell(state);
      transform(state, worst);
      const bool kept = accept_or_undo(state, worst);
      update_penalty(worst, kept);
      if (kept)
        for (const CellIndex c : touched_) {
          by_quality_.update(c, assess_(state.mesh, c, state.cell_quality[c]));
          by_corrected_quality_.update(c, by_quality_.key(c) + penalties_[c]);
        }
      else
        ++report.n_reset;
      by_corrected_quality_.update(worst, by_quality_.key(worst) + penalties_[worst]);
      ++report.n_counted;
    }
    report.score = lowest_quality();
    if (Assessment::result == ResultMesh::best_q_star_min && !by_quality_.empty())
      report.q_star_min = report.score;
    report.moved = moved_in_cycle_;
    report.converged = quality_gain_ < -max_mean_loss_ * initial_quality_sum_ || is_perfect();
    return report;
  }

 private:
  static constexpr CellIndex no_cell = static_cast<CellIndex>(-1);

  double lowest_quality() const {
    return by_quality_.empty() ? 0.0 : by_quality_.key(by_quality_.top());
  }

  bool is_perfect() const { return lowest_quality() > 1.0 - perfect_; }

  /// Returns the worst cell. If two elements share their worst face and so have equal quality, it
  /// is the one with the lower mean ratio (thesis, Section 4.7).
  CellIndex worst_cell(const SmoothingState<dim, spacedim>& state) const {
    CellIndex worst = by_corrected_quality_.top();
    if (Assessment::result == ResultMesh::best_q_star_min) return worst;
    const double key = by_corrected_quality_.key(worst);
    for (const NodeIndex node : state.mesh.topology().cell_nodes(worst))
      for (const CellIndex c : state.mesh.topology().node_cells(node))
        if (by_corrected_quality_.key(c) == key &&
            state.cell_quality[c] < state.cell_quality[worst])
          worst = c;
    return worst;
  }

  /// Returns the size that is passed to an element's step, if it needs one.
  double fitting_size(const Mesh<dim, spacedim>& mesh, std::span<const NodeIndex> nodes) {
    if (!regularization_->fits_neighbours()) return 0.0;
    if (mesh.targets()) return 1.0;  // the corners are mapped to where the targets are regular
    neighbour_sizes_.update(mesh, nodes);
    return neighbour_sizes_.of(nodes);
  }

  /// Moves the free nodes of a cell to their transformed positions; remembers the old ones.
  [[gnu::flatten]] void transform(SmoothingState<dim, spacedim>& state, CellIndex cell) {
    auto& mesh = state.mesh;
    const auto& topology = mesh.topology();
    const auto nodes = topology.cell_nodes(cell);
    moved_.clear();
    touched_.clear();
    ++n_transformations_;
    const Point<spacedim>* const x = std::as_const(mesh).coordinates().data();
    with_target_corners(mesh, cell, coordinates_at(x), [&](auto corners) {
      with_result(corners, [&](auto result) {
        const double size = fitting_size(mesh, nodes);
        regularize(*regularization_, upper_side(mesh, cell), corners, result, size);
        map_to_target(mesh, cell, result);
        for (std::size_t k = 0; k < nodes.size(); ++k) {
          if (topology.is_fixed(nodes[k])) continue;
          moved_.emplace_back(nodes[k], x[nodes[k]]);
          mesh.coordinates()[nodes[k]] = allowed_position(mesh, nodes[k], point_of(result[k]));
          for (const CellIndex c : topology.node_cells(nodes[k])) {
            if (touched_in_[c] == n_transformations_) continue;
            touched_in_[c] = n_transformations_;
            touched_.push_back(c);
          }
        }
      });
    });
  }

  /// Evaluates the cells around the moved nodes of a cell. Resets these nodes if one of the cells
  /// is invalid, or if a facet there is beyond its bound.
  bool accept_or_undo(SmoothingState<dim, spacedim>& state, CellIndex cell) {
    new_quality_.resize(touched_.size());
    prefetch_corners(state.mesh.topology(), touched_, state.mesh.coordinates().data());
    const auto set_if_valid = [&](std::size_t position, double q) {
      new_quality_[position] = q;
      return q > 0.0;
    };
    if (!for_each_mean_ratio(state.mesh, touched_, set_if_valid) ||
        !keeps_facet_bound(state.mesh, state.mesh.topology().cell_nodes(cell))) {
      for (const auto& [node, position] : moved_) state.mesh.coordinates()[node] = position;
      return false;
    }
    for (std::size_t i = 0; i < touched_.size(); ++i) {
      quality_gain_ += new_quality_[i] - state.cell_quality[touched_[i]];
      state.cell_quality[touched_[i]] = new_quality_[i];
    }
    for (const auto& [node, position] : moved_) moved_in_cycle_.push_back(node);
    return true;
  }

  void update_penalty(CellIndex cell, bool kept) {
    double& penalty = penalties_[cell];
    penalty += kept ? penalty_success_ : penalty_invalid_;
    if (cell == last_picked_) penalty += penalty_repeated_;
    penalty = std::max(penalty, 0.0);
    last_picked_ = cell;
  }

  ElementParameters<dim> element_ = default_parameters<dim>();
  std::optional<ElementRegularization<dim, spacedim>> regularization_;
  NeighbourSizes<dim, spacedim> neighbour_sizes_;
  Assessment assess_;
  double penalty_invalid_ = 1e-4;
  double penalty_repeated_ = 1e-5;
  double penalty_success_ = -1e-3;
  int cycle_ = Assessment::cycle;
  int patience_ = Assessment::patience;
  int patience_below_start_ = 10;
  int max_cycles_ = 100000;
  double max_mean_loss_ = 1.0;
  double perfect_ = 1e-4;

  MinTree by_quality_, by_corrected_quality_;
  std::vector<double> penalties_;
  CellIndex last_picked_ = no_cell;
  double initial_quality_sum_ = 0.0, quality_gain_ = 0.0;  ///< of all cells
  std::vector<std::pair<NodeIndex, Point<spacedim>>> moved_;
  std::vector<NodeIndex> moved_in_cycle_;
  std::vector<CellIndex> touched_;  ///< cells with a moved node
  std::vector<std::uint32_t>
      touched_in_;  ///< number of the transformation that last touched a cell
  std::uint32_t n_transformations_ = 0;
  std::vector<double> new_quality_;
};

template <int dim, int spacedim>
using Sequential = GetmeSequential<dim, spacedim, ByMeanRatio>;

const RegisteredMethod registered({.name = "getme-sequential",
                                   .title = "GETMe sequential",
                                   .description = "transforms the worst element, one at a time; "
                                                  "second stage of GETMe",
                                   .source = "Section 4.3, Fig. 4.3; parameters of Chapter 6"},
                                  single_stage_also_on_surfaces<Sequential>());

/// GETMe, followed by the sequential method on q_gamma.
Stages<3> make_qgamma_stages() {
  Stages<3> stages = stages_of<3>("getme");
  stages.push_back(std::make_unique<GetmeSequential<3, 3, ByMeanRatioAndWarpage>>());
  return stages;
}

const RegisteredMethod registered_qgamma(
    {.name = "getme-qgamma",
     .title = "GETMe q_gamma",
     .description = "GETMe, then the sequential method on the lower of mean ratio and weighted "
                    "warpage of the faces; volume meshes",
     .source = "Section 4.7; parameters of Section 5.4.4"},
    {{}, make_qgamma_stages});

}  // namespace
}  // namespace smoothfem
