// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>
#include <optional>

#include "smoothing/base/parallel.h"
#include "smoothing/getme/independent_cells.h"
#include "smoothing/getme/min_tree.h"
#include "smoothing/getme/neighbour_sizes.h"
#include "smoothing/getme/regularize.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/parts/exact_sum.h"
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
///
/// In a mesh in parts, or if asked, each transformation of a cycle becomes a round: the elements of
/// the lowest corrected quality that have separate neighbourhoods are transformed at the same time.
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
        {"at_once",
         "most elements that are transformed at the same time, which counts once in a cycle; 1: "
         "one "
         "element after the other, as in the thesis; 0: 10 in a mesh in parts, otherwise 1",
         &at_once_, 0.0, 1e3},
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
            .takes_targets = Assessment::result == ResultMesh::best_q_star_min,
            .works_in_parts = !element_.fits_neighbours()};
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
    const WholeMesh whole(topology);
    std::vector<double> keys(topology.n_cells(), MinTree::never);
    for (CellIndex c = 0; c < topology.n_cells(); ++c)
      if (topology.has_free_node(c) && whole.owns_cell(c))
        keys[c] = assess_(state.mesh, c, state.cell_quality[c]);
    by_quality_.build(std::move(keys));
    by_corrected_quality_ = by_quality_;
    find_lowest(topology);
    penalties_.assign(topology.n_cells(), 0.0);
    touched_in_.assign(topology.n_cells(), 0);
    quality_gain_ = ExactSum();
    initial_quality_sum_ =
        topology.part()
            ? state.initial_quality.q_mean *
                  static_cast<double>(topology.part()->n_cells_of_whole())
            : std::accumulate(state.cell_quality.begin(), state.cell_quality.end(), 0.0);
    n_transformations_ = 0;
    last_picked_.clear();
    independent_.prepare(topology);
  }

  double initial_score() const override { return lowest_quality(); }

  StepReport step(SmoothingState<dim, spacedim>& state) override {
    const Topology& topology = state.mesh.topology();
    const int chosen = at_once_ > 0 ? at_once_ : topology.part() ? 10 : 1;
    const auto at_once = static_cast<std::size_t>(chosen);
    const bool makes_rounds = topology.part() != nullptr || at_once > 1;
    StepReport report{.n_counted = 0};
    moved_in_cycle_.clear();
    for (int round = 0; round < cycle_ && !is_perfect(); ++round) {
      const auto [n, n_undone] =
          makes_rounds ? transform_round(state, at_once) : transform_worst(state);
      if (n == 0) break;
      report.n_counted += n;
      report.n_reset += n_undone;
      if (!makes_rounds) find_lowest(topology);
    }
    find_lowest(topology);
    report.score = lowest_quality();
    if (Assessment::result == ResultMesh::best_q_star_min && lowest_key_ != MinTree::never)
      report.q_star_min = report.score;
    report.moved = moved_in_cycle_;
    report.converged =
        quality_gain(topology) < -max_mean_loss_ * initial_quality_sum_ || is_perfect();
    return report;
  }

 private:
  struct Counts {
    std::size_t n_transformed = 0, n_undone = 0;
  };
  /// A transformation that may be undone, as far as this process knows of it.
  struct Trial {
    std::vector<NodeIndex> moved{};
    std::vector<Point<spacedim>> before{};  ///< positions of the moved nodes
    std::vector<CellIndex> touched{};       ///< cells with a moved node
    std::vector<double> quality{};          ///< of these, afterwards

    void clear() {
      moved.clear();
      before.clear();
    }
    void move(Mesh<dim, spacedim>& mesh, NodeIndex node, const Point<spacedim>& position) {
      moved.push_back(node);
      before.push_back(std::exchange(mesh.coordinates()[node], position));
    }
  };
  using NewPositions = std::vector<std::pair<NodeIndex, Point<spacedim>>>;
  struct SentPosition {
    CandidateNode node;
    std::array<double, std::size_t{spacedim}> x;
  };

  double lowest_quality() const { return lowest_key_ == MinTree::never ? 0.0 : lowest_key_; }
  void find_lowest(const Topology& topology) {
    lowest_key_ = WholeMesh(topology).min(
        by_quality_.size() == 0 ? MinTree::never : by_quality_.key(by_quality_.top()));
  }
  bool is_perfect() const { return lowest_quality() > 1.0 - perfect_; }

  /// Returns by how much the sum of the qualities of all cells has risen.
  double quality_gain(const Topology& topology) const {
    return topology.part() ? quality_gain_.total(*topology.part()) : quality_gain_.total();
  }

  /// Transforms the element with the lowest corrected quality.
  Counts transform_worst(SmoothingState<dim, spacedim>& state) {
    if (by_corrected_quality_.empty()) return {};
    const CellIndex worst = worst_cell(state);
    Trial& trial = trials_.front();
    trial.clear();
    transform(state.mesh, worst, positions_);
    for (const auto& [node, position] : positions_) trial.move(state.mesh, node, position);
    find_touched(state.mesh.topology(), ++n_transformations_, trial);
    const bool keeps = is_valid(state.mesh, trial);
    accept_or_undo(state, trial, keeps);
    update_penalty(worst, keeps, worst);
    last_picked_.assign(1, worst);
    return {1, keeps ? 0U : 1U};
  }

  /// Transforms elements among the n with the lowest corrected quality at the same time. Their
  /// owners find the new positions. All processes with cells around them say whether these are
  /// valid. Collective.
  Counts transform_round(SmoothingState<dim, spacedim>& state, std::size_t n) {
    const WholeMesh whole(state.mesh.topology());
    const auto candidates = lowest_cells(whole, by_corrected_quality_, n);
    const auto positions = whole.gather(positions_to_send(state, candidates));
    std::vector<CandidateNode> nodes;
    for (const SentPosition& position : positions) nodes.push_back(position.node);
    const auto chosen = independent_.choose(candidates, nodes);

    trials_.resize(std::max(trials_.size(), candidates.size()));
    for (Trial& trial : trials_) trial.clear();
    std::vector<std::uint8_t> is_chosen(candidates.size(), 0);
    for (const std::uint32_t place : chosen) is_chosen[place] = 1;
    for (const auto& [node, x] : positions)
      if (const auto here = whole.find_node(node.node); here && is_chosen[node.place])
        trials_[node.place].move(state.mesh, *here, Point<spacedim>(x.data()));
    std::vector<std::int64_t> n_invalid(candidates.size());
    parallel_for(chosen.size(), [&](std::size_t k) {
      Trial& trial = trials_[chosen[k]];
      find_touched(state.mesh.topology(), n_transformations_ + static_cast<std::uint32_t>(k) + 1,
                   trial);
      n_invalid[chosen[k]] = !is_valid(state.mesh, trial);
    });
    n_transformations_ += static_cast<std::uint32_t>(chosen.size());
    whole.sum(n_invalid);

    Counts counts{chosen.size()};
    std::vector<GlobalIndex> picked;
    for (const std::uint32_t place : chosen) {
      const bool keeps = n_invalid[place] == 0;
      counts.n_undone += keeps ? 0 : 1;
      accept_or_undo(state, trials_[place], keeps);
      picked.push_back(candidates[place].cell);
      const auto cell = whole.find_cell(picked.back());
      if (cell && whole.owns_cell(*cell)) update_penalty(*cell, keeps, picked.back());
    }
    last_picked_ = std::move(picked);
    return counts;
  }

  /// Returns where the free nodes of the candidates that this process owns would move.
  std::vector<SentPosition> positions_to_send(const SmoothingState<dim, spacedim>& state,
                                              std::span<const KeyedCell> candidates) {
    const WholeMesh whole(state.mesh.topology());
    std::vector<std::vector<SentPosition>> of_each(candidates.size());
    const auto find_positions = [&](std::size_t place) {
      const auto cell = whole.find_cell(candidates[place].cell);
      if (!cell || !whole.owns_cell(*cell)) return;
      NewPositions new_positions;
      transform(state.mesh, *cell, new_positions);
      for (const auto& [node, position] : new_positions) {
        SentPosition& sent = of_each[place].emplace_back();
        sent.node = {static_cast<std::uint32_t>(place), whole.node_number(node),
                     state.cell_quality[*cell]};
        std::copy_n(position.data(), spacedim, sent.x.begin());
      }
    };
    if (regularization_->fits_neighbours())  // sizes at nodes are kept, and candidates share nodes
      for (std::size_t place = 0; place < candidates.size(); ++place) find_positions(place);
    else
      parallel_for(candidates.size(), find_positions);
    std::vector<SentPosition> all;
    for (const auto& some : of_each) all.insert(all.end(), some.begin(), some.end());
    return all;
  }

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

  /// Finds the new positions of the free nodes of a cell.
  [[gnu::flatten]] void transform(const Mesh<dim, spacedim>& mesh, CellIndex cell,
                                  NewPositions& positions) {
    positions.clear();
    const auto nodes = mesh.topology().cell_nodes(cell);
    with_target_corners(mesh, cell, coordinates_at(mesh.coordinates().data()), [&](auto corners) {
      with_result(corners, [&](auto result) {
        const double size = fitting_size(mesh, nodes);
        regularize(*regularization_, upper_side(mesh, cell), corners, result, size);
        map_to_target(mesh, cell, result);
        for (std::size_t k = 0; k < nodes.size(); ++k)
          if (!mesh.topology().is_fixed(nodes[k]))
            positions.emplace_back(nodes[k], allowed_position(mesh, nodes[k], point_of(result[k])));
      });
    });
  }

  /// Finds the cells with a moved node. transformation: its number.
  void find_touched(const Topology& topology, std::uint32_t transformation, Trial& trial) {
    trial.touched.clear();
    for (const NodeIndex node : trial.moved)
      for (const CellIndex c : topology.node_cells(node)) {
        if (touched_in_[c] == transformation) continue;
        touched_in_[c] = transformation;
        trial.touched.push_back(c);
      }
  }

  /// Evaluates the touched cells. Returns false if one of them is invalid, or if a facet there is
  /// beyond its bound.
  bool is_valid(const Mesh<dim, spacedim>& mesh, Trial& trial) const {
    trial.quality.resize(trial.touched.size());
    prefetch_corners(mesh.topology(), trial.touched, mesh.coordinates().data());
    const auto set_if_valid = [&](std::size_t position, double q) {
      trial.quality[position] = q;
      return q > 0.0;
    };
    return for_each_mean_ratio(mesh, trial.touched, set_if_valid) &&
           keeps_facet_bound(mesh, trial.moved);
  }

  /// Takes over the qualities of the touched cells, or resets the moved nodes.
  void accept_or_undo(SmoothingState<dim, spacedim>& state, const Trial& trial, bool keeps) {
    if (!keeps) {
      for (std::size_t k = 0; k < trial.moved.size(); ++k)
        state.mesh.coordinates()[trial.moved[k]] = trial.before[k];
      return;
    }
    const WholeMesh whole(state.mesh.topology());
    for (std::size_t i = 0; i < trial.touched.size(); ++i) {
      const CellIndex c = trial.touched[i];
      const double before = std::exchange(state.cell_quality[c], trial.quality[i]);
      if (!whole.owns_cell(c)) continue;
      if (max_mean_loss_ < 1.0) quality_gain_.add(trial.quality[i] - before);
      by_quality_.update(c, assess_(state.mesh, c, trial.quality[i]));
      by_corrected_quality_.update(c, by_quality_.key(c) + penalties_[c]);
    }
    moved_in_cycle_.insert(moved_in_cycle_.end(), trial.moved.begin(), trial.moved.end());
  }

  /// number: that of the cell in the whole mesh.
  void update_penalty(CellIndex cell, bool kept, GlobalIndex number) {
    double& penalty = penalties_[cell];
    penalty += kept ? penalty_success_ : penalty_invalid_;
    if (std::find(last_picked_.begin(), last_picked_.end(), number) != last_picked_.end())
      penalty += penalty_repeated_;
    penalty = std::max(penalty, 0.0);
    by_corrected_quality_.update(cell, by_quality_.key(cell) + penalty);
  }

  ElementParameters<dim> element_ = default_parameters<dim>();
  std::optional<ElementRegularization<dim, spacedim>> regularization_;
  NeighbourSizes<dim, spacedim> neighbour_sizes_;
  Assessment assess_;
  double penalty_invalid_ = 1e-4;
  double penalty_repeated_ = 1e-5;
  double penalty_success_ = -1e-3;
  int at_once_ = 0;
  int cycle_ = Assessment::cycle;
  int patience_ = Assessment::patience;
  int patience_below_start_ = 10;
  int max_cycles_ = 100000;
  double max_mean_loss_ = 1.0;
  double perfect_ = 1e-4;

  MinTree by_quality_, by_corrected_quality_;
  double lowest_key_ = MinTree::never;  ///< lowest quality of the whole mesh
  std::vector<double> penalties_;
  std::vector<GlobalIndex> last_picked_;  ///< one element, or those of a round
  double initial_quality_sum_ = 0.0;      ///< of all cells
  ExactSum quality_gain_;                 ///< of the cells that this process owns
  IndependentCells independent_;
  std::vector<Trial> trials_{1};
  NewPositions positions_;
  std::vector<NodeIndex> moved_in_cycle_;
  std::vector<std::uint32_t>
      touched_in_;  ///< number of the transformation that last touched a cell
  std::uint32_t n_transformations_ = 0;
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
