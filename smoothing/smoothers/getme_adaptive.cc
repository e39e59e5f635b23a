#include <algorithm>
#include <cstdint>
#include <numeric>

#include "smoothing/getme/element_pass.h"
#include "smoothing/getme/neighbour_weights.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/quality/local_quality.h"

namespace smoothfem {
namespace {

/// Elements of at most this quality are transformed, and count by their neighbours' quality.
struct ThresholdWeighting {
  const double* weights;
  double threshold;

  SMOOTHFEM_INLINE double weight(CellIndex cell, double) const { return weights[cell]; }
  SMOOTHFEM_INLINE Lanes weight(const std::array<CellIndex, n_lanes>& cells, Lanes) const {
    return Lanes{weights[cells[0]], weights[cells[1]], weights[cells[2]], weights[cells[3]]};
  }
  SMOOTHFEM_INLINE bool transforms(double quality) const { return quality <= threshold; }
  SMOOTHFEM_INLINE LaneMask transforms(Lanes quality) const { return quality <= threshold; }
};
template <int dim>
using Pass = ElementPass<dim, ThresholdWeighting>;

void add_some(const Pass<2>& pass, std::span<const CellIndex> cells,
              const std::vector<std::uint8_t>& marked, double* sums) {
  add_to_marked(pass, cells, marked, sums);
}
void add_some(const Pass<3>& pass, std::span<const CellIndex> cells,
              const std::vector<std::uint8_t>& marked, double* sums) {
  add_to_marked(pass, cells, marked, sums);
}

template <int dim>
SMOOTHFEM_INLINE void write_mean_ratios(const Mesh<dim>& mesh, std::span<const CellIndex> cells,
                                        std::vector<double>& quality) {
  for_each_mean_ratio(
      mesh, cells,
      [&](NodeIndex i)
          SMOOTHFEM_INLINE_LAMBDA -> const Point<dim>& { return mesh.coordinates()[i]; },
      [&](std::size_t position, double q) SMOOTHFEM_INLINE_LAMBDA {
        quality[cells[position]] = q;
        return true;
      });
}
void evaluate(const PlanarMesh& mesh, std::span<const CellIndex> cells,
              std::vector<double>& quality) {
  write_mean_ratios<2>(mesh, cells, quality);
}
void evaluate(const VolumeMesh& mesh, std::span<const CellIndex> cells,
              std::vector<double>& quality) {
  write_mean_ratios<3>(mesh, cells, quality);
}

ElementRegularization<2> default_element(std::integral_constant<int, 2>) {
  ElementRegularization<2> element;
  element.lambda = 7.0 / 20.0;
  element.theta_degrees = 15.0;
  element.rho = 1.0;
  return element;
}
ElementRegularization<3> default_element(std::integral_constant<int, 3>) {
  ElementRegularization<3> element;
  element.tetrahedron = element.pyramid = element.prism = element.hexahedron = {1.5, 1.5};
  element.rho = 1.0;
  return element;
}

/// Tables and arrays of a run; the stages, which follow each other, use the same ones.
template <int dim>
struct AdaptiveArrays {
  NeighbourWeights weights;
  NodeSums sums;
  std::vector<NodeIndex> moving;        ///< free nodes of transformed elements, ascending
  std::vector<std::uint8_t> marked;     ///< those of them that know where to move
  std::vector<std::uint8_t> active;     ///< cells around them
  std::vector<std::uint8_t> level;      ///< position in the relaxation values of each node
  std::vector<CellIndex> active_cells;  ///< the same, ascending
  std::vector<Point<dim>> previous;     ///< of moving nodes
};

/// What both stages of GETMe adaptive do (thesis, Section 4.5, Fig. 4.4): nodes move to the
/// weighted means of their places in the transformed elements of low quality and the untransformed
/// other ones; where that makes elements invalid, their nodes move less, by a table of relaxation
/// values that ends with zero.
template <int dim>
class AdaptiveStage : public Smoother<dim> {
 public:
  Parameters parameters() override {
    Parameters all = element_.parameters();
    all.push_back({"relaxation",
                   "shares of its movement that a node tries in turn while elements around it are "
                   "invalid; ends with 0 (Eq. 4.4)",
                   &relaxation_, 0.0, 1.0});
    return all;
  }

  void initialize(const SmoothingState<dim>& state) override {
    if (relaxation_.back() != 0.0)
      throw InputError("method getme-adaptive: the parameter relaxation has to end with 0");
    const Topology& topology = state.mesh.topology();
    element_.prepare();
    arrays_->sums.prepare(topology);
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

  /// One iteration that transforms the elements of at most this quality.
  StepReport smooth_below(SmoothingState<dim>& state, double threshold) {
    find_active(state, threshold);
    arrays_->weights.compute(arrays_->active_cells, state.cell_quality);
    add_active(state, threshold);
    constexpr std::size_t grain = 4096;
    parallel_for_ranges(arrays_->moving.size(), grain, [&](std::size_t first, std::size_t last) {
      for (const NodeIndex i : std::span(arrays_->moving).subspan(first, last - first)) {
        arrays_->previous[i] = state.mesh.coordinates()[i];
        arrays_->level[i] = 0;
        if (!(arrays_->sums[i][dim] > 0.0)) arrays_->marked[i] = 0;  // nothing says where to
        if (arrays_->marked[i]) place(state.mesh, i);
      }
    });
    StepReport report;
    report.n_reset = relax_until_valid(state);
    report.quality = mesh_quality(state.mesh.topology(), state.cell_quality);
    if (threshold < 1.0) report.moved = &arrays_->moving;
    return report;
  }

  ElementRegularization<dim> element_ = default_element(std::integral_constant<int, dim>{});

 private:
  /// Finds the free nodes of transformed elements and the cells around them.
  void find_active(const SmoothingState<dim>& state, double threshold) {
    const Topology& topology = state.mesh.topology();
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
          if (!topology.is_fixed(i)) arrays_->marked[i] = 1;
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

  void add_active(const SmoothingState<dim>& state, double threshold) {
    const Pass<dim> pass{state.mesh, element_, {arrays_->weights.weights().data(), threshold}};
    arrays_->sums.compute_some(arrays_->moving, arrays_->active_cells,
                               [&](std::size_t, std::span<const CellIndex> cells, double* sums) {
                                 add_some(pass, cells, arrays_->marked, sums);
                               });
  }

  /// Moves a marked node as far as its level says.
  void place(Mesh<dim>& mesh, NodeIndex i) const {
    const double share = relaxation_[arrays_->level[i]];
    const Point<dim>& previous = arrays_->previous[i];
    mesh.coordinates()[i] = previous;
    if (share == 0.0) return;
    mesh.coordinates()[i] = (1.0 - share) * previous + share * mean_place<dim>(arrays_->sums[i]);
  }

  void evaluate_cells(SmoothingState<dim>& state, std::span<const CellIndex> cells) {
    constexpr std::size_t grain = 4096;
    parallel_for_ranges(cells.size(), grain, [&](std::size_t first, std::size_t last) {
      evaluate(state.mesh, cells.subspan(first, last - first), state.cell_quality);
    });
  }

  /// Shortens the movements around invalid cells until there is none; returns how many nodes stay
  /// where they were.
  std::size_t relax_until_valid(SmoothingState<dim>& state) {
    const Topology& topology = state.mesh.topology();
    std::size_t n_reset = 0;
    std::span<const CellIndex> cells = arrays_->active_cells;
    std::vector<CellIndex> around;
    while (true) {
      evaluate_cells(state, cells);
      std::vector<NodeIndex> shortened;
      for (const CellIndex c : cells)
        if (!(state.cell_quality[c] > 0.0))
          for (const NodeIndex i : topology.cell_nodes(c))
            if (arrays_->marked[i] && arrays_->level[i] + 1u < relaxation_.size())
              shortened.push_back(i);
      if (shortened.empty()) return n_reset;
      std::sort(shortened.begin(), shortened.end());
      shortened.erase(std::unique(shortened.begin(), shortened.end()), shortened.end());
      for (const NodeIndex i : shortened) {
        ++arrays_->level[i];
        place(state.mesh, i);
        if (relaxation_[arrays_->level[i]] == 0.0) ++n_reset;
      }
      around = topology.cells_around(shortened);
      cells = around;
    }
  }

  std::vector<double> relaxation_;
  std::shared_ptr<AdaptiveArrays<dim>> arrays_;
};

/// First stage: all elements are transformed until q_mean hardly rises.
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
    all.push_back({"max_iterations", "stop after this many iterations at the latest",
                   &max_iterations_, 1.0, 1e9});
    return all;
  }
  SmoothingRule rule() const override {
    return {.quality_use = QualityUse::smoother,
            .result = ResultMesh::best_q_mean,
            .criterion = StoppingCriterion::q_mean_gain,
            .tolerance = tolerance_,
            .max_iterations = max_iterations_};
  }
  StepReport step(SmoothingState<dim>& state) override { return this->smooth_below(state, 1.0); }

 private:
  double tolerance_ = 1e-4;
  int max_iterations_ = 1000;
};

/// Second stage: cycles that transform a share of the elements, those of the lowest quality when
/// the cycle begins. A cycle ends after `patience` iterations in a row that did not raise q*_min
/// (Section 5.1.3; in Fig. 4.4 they need not follow each other), the stage after a cycle that did
/// not.
template <int dim>
class AdaptiveMinStage final : public AdaptiveStage<dim> {
 public:
  explicit AdaptiveMinStage(std::shared_ptr<AdaptiveArrays<dim>> arrays)
      : AdaptiveStage<dim>({0.5, 0.25, 0.1, 0.01, 0.0}, std::move(arrays)) {}
  std::string_view name() const override { return "min"; }

  Parameters parameters() override {
    Parameters all = AdaptiveStage<dim>::parameters();
    all.push_back({"share",
                   "share of the elements whose quality sets the threshold at the beginning of a "
                   "cycle; the thesis does not print it, 0.001 to 0.01 is good",
                   &share_, 0.0, 1.0});
    all.push_back(
        {"patience",
         "iterations in a row without a higher q*_min that end a cycle; the thesis has 5, 10 "
         "gains as much q*_min as the sequential method",
         &patience_, 1.0, 1e9});
    all.push_back({"max_iterations", "stop after this many iterations at the latest",
                   &max_iterations_, 1.0, 1e9});
    return all;
  }
  SmoothingRule rule() const override {
    return {.quality_use = QualityUse::smoother,
            .result = ResultMesh::best_q_star_min,
            .criterion = StoppingCriterion::converged,
            .max_iterations = max_iterations_};
  }

  void initialize(const SmoothingState<dim>& state) override {
    AdaptiveStage<dim>::initialize(state);
    best_ = mesh_quality(state.mesh.topology(), state.cell_quality).q_star_min;
    start_cycle(state);
  }

  StepReport step(SmoothingState<dim>& state) override {
    StepReport report = this->smooth_below(state, threshold_);
    const bool gain = report.quality->q_star_min > best_;
    best_ = std::max(best_, report.quality->q_star_min);
    n_without_gain_ = gain ? 0 : n_without_gain_ + 1;
    const bool below_start = best_ < state.initial_quality.q_star_min;
    if (n_without_gain_ >= (below_start ? patience_below_start : 1) * patience_) {
      report.converged = !(best_ > best_at_start_);
      start_cycle(state);
    }
    return report;
  }

 private:
  void start_cycle(const SmoothingState<dim>& state) {
    std::vector<double> sorted = state.cell_quality;
    const auto position = std::min(
        static_cast<std::size_t>(share_ * static_cast<double>(sorted.size())), sorted.size() - 1);
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(position),
                     sorted.end());
    threshold_ = sorted[position];
    n_without_gain_ = 0;
    best_at_start_ = best_;
  }

  double share_ = 0.005;
  int patience_ = 10;
  int max_iterations_ = 10000;
  double threshold_ = 1.0;
  double best_ = 0.0, best_at_start_ = 0.0;
  int n_without_gain_ = 0;
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
