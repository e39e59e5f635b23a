// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>

#include "smoothing/base/parallel.h"
#include "smoothing/getme/element_pass.h"
#include "smoothing/getme/neighbour_weights.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/parts/order_statistic.h"
#include "smoothing/parts/shared_coordinates.h"
#include "smoothing/quality/local_quality.h"

namespace smoothfem {
namespace {

template <int dim>
ElementParameters<dim> default_parameters() {
  if constexpr (dim == 2)
    return {.lambda = 7.0 / 20.0, .theta_degrees = 15.0, .rho = 1.0};
  else
    return {.tetrahedron = {1.5, 1.5},
            .pyramid = {1.5, 1.5},
            .prism = {1.5, 1.5},
            .hexahedron = {1.5, 1.5},
            .rho = 1.0};
}

constexpr std::size_t grain = 4096;  ///< nodes or cells that one thread takes at a time

/// Tables and arrays of a run, shared by the stages, which run one after the other.
template <int dim>
struct AdaptiveArrays {
  NeighbourWeights weights;
  ElementPass<dim> pass;
  std::vector<NodeIndex> moving;        ///< free nodes of transformed elements, ascending
  std::vector<std::uint8_t> marked;     ///< moving nodes with a weighted mean to move to
  std::vector<std::uint8_t> active;     ///< cells around them
  std::vector<std::uint8_t> level;      ///< position of each node in the relaxation values
  std::vector<CellIndex> active_cells;  ///< the active cells, ascending
  std::vector<Point<dim>> previous;     ///< of moving nodes
};

/// Base of both stages of GETMe adaptive (thesis, Section 4.5, Fig. 4.4). Elements of low quality
/// are transformed, the others are not; nodes move to the weighted means of their positions in
/// both. Nodes of elements that become invalid move less, by a table of relaxation values that ends
/// with zero.
template <int dim>
class AdaptiveStage : public Smoother<dim> {
 public:
  Parameters parameters() override {
    Parameters all = element_.parameters();
    all.push_back({"relaxation",
                   "fractions of its movement that a node tries in turn while elements around it "
                   "are invalid; ends with 0 (Eq. 4.4)",
                   &relaxation_, 0.0, 1.0});
    return all;
  }

  void initialize(const SmoothingState<dim>& state) override {
    if (relaxation_.back() != 0.0)
      throw InputError("method getme-adaptive: the parameter relaxation must end with 0");
    const Topology& topology = state.mesh.topology();
    arrays_->pass.prepare(state.mesh, element_);
    arrays_->weights.prepare(state.mesh.shared_topology());
    arrays_->moving.clear();
    arrays_->active_cells.clear();
    arrays_->marked.assign(topology.n_nodes(), 0);
    arrays_->active.assign(topology.n_cells(), 0);
    arrays_->level.assign(topology.n_nodes(), 0);
    arrays_->previous.resize(topology.n_nodes());
  }

 protected:
  AdaptiveStage(std::vector<double> relaxation, std::shared_ptr<AdaptiveArrays<dim>> arrays)
      : relaxation_(std::move(relaxation)), arrays_(std::move(arrays)) {}

  /// Makes one iteration that transforms the elements of at most this quality.
  StepReport smooth_below(SmoothingState<dim>& state, double threshold) {
    auto& weights = arrays_->weights;
    const auto& moving = arrays_->moving;
    find_active(state, threshold);
    weights.compute(arrays_->active_cells, state.cell_quality);
    arrays_->pass.transform_some(state, moving, arrays_->active_cells, weights.weights(),
                                 threshold);
    parallel_for_ranges(moving.size(), grain, [&](std::size_t first, std::size_t last) {
      for (const NodeIndex i : std::span(arrays_->moving).subspan(first, last - first)) {
        arrays_->previous[i] = state.mesh.coordinates()[i];
        arrays_->level[i] = 0;
        if (!arrays_->pass.has_mean(i))
          arrays_->marked[i] = 0;  // all weights are zero: the node stays
        if (arrays_->marked[i]) set_position(state.mesh, i);
      }
    });
    StepReport report;
    report.n_reset = relax_until_valid(state);
    report.quality = mesh_quality(state.mesh.topology(), state.cell_quality);
    if (threshold < 1.0 && state.mesh.topology().part() == nullptr) report.moved = moving;
    return report;
  }

  ElementParameters<dim> element_ = default_parameters<dim>();

 private:
  /// Finds the free nodes of transformed elements and the cells around them.
  void find_active(const SmoothingState<dim>& state, double threshold) {
    const Topology& topology = state.mesh.topology();
    const WholeMesh whole(topology);
    for (const NodeIndex i : arrays_->moving) arrays_->marked[i] = 0;
    for (const CellIndex c : arrays_->active_cells) arrays_->active[c] = 0;
    if (threshold >= 1.0) {
      arrays_->moving = topology.free_nodes();
      for (const NodeIndex i : arrays_->moving) arrays_->marked[i] = 1;
      arrays_->active_cells.resize(topology.n_cells());
      std::iota(arrays_->active_cells.begin(), arrays_->active_cells.end(), CellIndex{0});
      return;
    }
    for (CellIndex c = 0; c < topology.n_cells(); ++c)
      if (state.cell_quality[c] <= threshold)
        for (const NodeIndex i : topology.cell_nodes(c))
          if (!topology.is_fixed(i) && whole.owns_node(i)) arrays_->marked[i] = 1;
    list_marked(arrays_->marked, arrays_->moving);
    for (const NodeIndex i : arrays_->moving)
      for (const CellIndex c : topology.node_cells(i)) arrays_->active[c] = 1;
    list_marked(arrays_->active, arrays_->active_cells);
  }
  static void list_marked(const std::vector<std::uint8_t>& marks,
                          std::vector<std::uint32_t>& marked) {
    marked.clear();
    for (std::uint32_t i = 0; i < marks.size(); ++i)
      if (marks[i]) marked.push_back(i);
  }

  /// Moves a marked node by the fraction of its level.
  void set_position(Mesh<dim>& mesh, NodeIndex i) const {
    const double fraction = relaxation_[arrays_->level[i]];
    const Point<dim>& previous = arrays_->previous[i];
    mesh.coordinates()[i] = previous;
    if (fraction == 0.0) return;
    mesh.coordinates()[i] = (1.0 - fraction) * previous + fraction * arrays_->pass.mean(i);
  }

  void evaluate(SmoothingState<dim>& state, std::span<const CellIndex> cells) {
    parallel_for_ranges(cells.size(), grain, [&](std::size_t first, std::size_t last) {
      const auto part = cells.subspan(first, last - first);
      for_each_mean_ratio(state.mesh, part, [&](std::size_t position, double q) {
        state.cell_quality[part[position]] = q;
        return true;
      });
    });
  }

  /// Shortens the movements around invalid cells until none is left. Returns the number of nodes
  /// that do not move, of the whole mesh. Collective in a part of a mesh.
  std::size_t relax_until_valid(SmoothingState<dim>& state) {
    const Topology& topology = state.mesh.topology();
    std::size_t n_reset = 0;
    std::vector<CellIndex> cells = with_cells_of_copies(state, arrays_->active_cells);
    while (true) {
      evaluate(state, cells);
      std::vector<NodeIndex> shortened;
      for (const CellIndex c : cells)
        if (!(state.cell_quality[c] > 0.0))
          for (const NodeIndex i : topology.cell_nodes(c))
            if (arrays_->marked[i] && arrays_->level[i] + 1u < relaxation_.size())
              shortened.push_back(i);
      if (!holds_anywhere(topology, !shortened.empty()))
        return topology.part() ? topology.part()->sum(n_reset) : n_reset;
      std::sort(shortened.begin(), shortened.end());
      shortened.erase(std::unique(shortened.begin(), shortened.end()), shortened.end());
      for (const NodeIndex i : shortened) {
        ++arrays_->level[i];
        set_position(state.mesh, i);
        if (relaxation_[arrays_->level[i]] == 0.0) ++n_reset;
      }
      cells = with_cells_of_copies(state, topology.cells_around(shortened));
    }
  }

  /// In a part of a mesh: moves copies where their owners are. Returns some cells (ascending) and
  /// those around these copies, ascending.
  static std::vector<CellIndex> with_cells_of_copies(SmoothingState<dim>& state,
                                                     std::vector<CellIndex> cells) {
    if (state.mesh.topology().part() == nullptr) return cells;
    const auto others = state.mesh.topology().cells_around(changed_copies(state.mesh));
    const auto n = static_cast<std::ptrdiff_t>(cells.size());
    cells.insert(cells.end(), others.begin(), others.end());
    std::inplace_merge(cells.begin(), cells.begin() + n, cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
  }

  std::vector<double> relaxation_;
  std::shared_ptr<AdaptiveArrays<dim>> arrays_;
};

/// First stage: transforms all elements until q_mean hardly rises.
template <int dim>
class AdaptiveMeanStage final : public AdaptiveStage<dim> {
 public:
  explicit AdaptiveMeanStage(std::shared_ptr<AdaptiveArrays<dim>> arrays)
      : AdaptiveStage<dim>({1.0, 0.25, 0.0625, 0.0}, std::move(arrays)) {}
  std::string_view name() const override { return "mean"; }

  Parameters parameters() override {
    Parameters all = AdaptiveStage<dim>::parameters();
    all.push_back({"tolerance", "stop when q_mean rises by no more than this in an iteration",
                   &tolerance_, -1.0, 1.0});
    all.push_back({"max_iterations", "largest number of iterations", &max_iterations_, 1.0, 1e9});
    return all;
  }
  SmootherTraits traits() const override {
    return {.quality_use = QualityUse::smoother,
            .result = ResultMesh::best_q_mean,
            .takes_targets = true,
            .works_in_parts = !this->element_.fits_neighbours()};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::q_mean_gain,
            .tolerance = tolerance_,
            .max_iterations = max_iterations_};
  }
  StepReport step(SmoothingState<dim>& state) override { return this->smooth_below(state, 1.0); }

 private:
  double tolerance_ = 1e-4;
  int max_iterations_ = 1000;
};

/// Second stage: cycles that transform the fraction of elements with the lowest quality at the
/// start of the cycle. Default: a cycle ends after `patience` iterations in a row without a higher
/// best q*_min (Section 5.1.3). With `no_gain` (Fig. 4.4) the stage ends after a cycle that did not
/// raise it.
template <int dim>
class AdaptiveMinStage final : public AdaptiveStage<dim> {
 public:
  explicit AdaptiveMinStage(std::shared_ptr<AdaptiveArrays<dim>> arrays)
      : AdaptiveStage<dim>({0.5, 0.25, 0.1, 0.01, 0.0}, std::move(arrays)) {}
  std::string_view name() const override { return "min"; }

  Parameters parameters() override {
    Parameters all = AdaptiveStage<dim>::parameters();
    all.push_back(
        {"fraction",
         "fraction of the elements whose quality sets the threshold at the beginning of "
         "a cycle; the thesis has 'a fixed percentage' (Section 4.5). Small fractions take more "
         "iterations, and may end early on strongly distorted meshes",
         &fraction_, 0.0, 1.0});
    all.push_back(
        {"patience",
         "iterations in a row without a higher q*_min that end a cycle; 5 in the thesis; with 10 "
         "q*_min rises as much as by the sequential method",
         &patience_, 1.0, 1e9});
    all.push_back(
        {"no_gain",
         "iterations that count for `patience`: those in a row without a new best q*_min "
         "(Section 5.1.3), or all of a cycle whose q*_min is not above that of the previous "
         "one, until there are more (Fig. 4.4)",
         Choice{&no_gain_, {"in-a-row", "in-cycle"}}});
    all.push_back({"patience_below_start",
                   "factor on `patience` while the best q*_min is below that of the method's "
                   "initial mesh; not in the thesis, which corresponds to 1",
                   &patience_below_start_, 1.0, 1e6});
    all.push_back({"max_iterations", "largest number of iterations", &max_iterations_, 1.0, 1e9});
    return all;
  }
  SmootherTraits traits() const override {
    return {.quality_use = QualityUse::smoother,
            .result = ResultMesh::best_q_star_min,
            .takes_targets = true,
            .works_in_parts = !this->element_.fits_neighbours()};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so,
            .patience = patience_,
            .patience_below_start = patience_below_start_,
            .max_iterations = max_iterations_};
  }

  void initialize(const SmoothingState<dim>& state) override {
    AdaptiveStage<dim>::initialize(state);
    best_ = last_ = mesh_quality(state.mesh.topology(), state.cell_quality).q_star_min;
    start_cycle(state);
  }

  StepReport step(SmoothingState<dim>& state) override {
    StepReport report = this->smooth_below(state, threshold_);
    const double q_star_min = report.quality->q_star_min;
    const bool gain = q_star_min > (no_gain_ == in_a_row ? best_ : last_);
    best_ = std::max(best_, q_star_min);
    last_ = q_star_min;
    if (!gain)
      ++n_without_gain_;
    else if (no_gain_ == in_a_row)
      n_without_gain_ = 0;
    const int patience = stopping().patience_at(best_, state.initial_quality.q_star_min);
    if (no_gain_ == in_a_row ? n_without_gain_ >= patience : n_without_gain_ > patience) {
      report.converged = !(best_ > best_at_start_);
      start_cycle(state);
    }
    return report;
  }

 private:
  enum NoGain { in_a_row, in_cycle };

  void start_cycle(const SmoothingState<dim>& state) {
    const Topology& topology = state.mesh.topology();
    const std::size_t n =
        topology.part() ? topology.part()->n_cells_of_whole() : topology.n_cells();
    const auto position = static_cast<std::size_t>(fraction_ * static_cast<double>(n));
    threshold_ = order_statistic(topology, state.cell_quality, std::min(position, n - 1));
    n_without_gain_ = 0;
    best_at_start_ = best_;
  }

  double fraction_ = 0.005;
  int patience_ = 10;
  int patience_below_start_ = 10;
  int max_iterations_ = 10000;
  double threshold_ = 1.0;
  double best_ = 0.0, best_at_start_ = 0.0, last_ = 0.0;
  int n_without_gain_ = 0;
  int no_gain_ = in_a_row;
};

template <int dim>
Stages<dim> make_stages() {
  Stages<dim> stages;
  const auto arrays = std::make_shared<AdaptiveArrays<dim>>();
  stages.push_back(std::make_unique<AdaptiveMeanStage<dim>>(arrays));
  stages.push_back(std::make_unique<AdaptiveMinStage<dim>>(arrays));
  return stages;
}

const RegisteredMethod registered(
    {.name = "getme-adaptive",
     .title = "GETMe adaptive",
     .description = "transforms all elements, then those of low quality; averages by the quality "
                    "of neighbours and relaxes node by node",
     .source = "Section 4.5, Fig. 4.4; parameters of Sections 5.1.3 and 5.5"},
    {make_stages<2>, make_stages<3>});

}  // namespace
}  // namespace smoothfem
