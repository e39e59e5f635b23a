#include <algorithm>

#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/indexed_min_heap.h"
#include "smoothing/mesh/cell_blocks.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/smoothers/polygon_regularization.h"

namespace smoothfem {
namespace {

/// Transforms the element with the lowest corrected quality, alone, again and again (thesis,
/// Section 4.3, Fig. 4.3). A step is a cycle of such transformations, after which q*_min is looked
/// at.
class GetmeSequential final : public Smoother<2> {
 public:
  std::string_view name() const override { return "sequential"; }

  Parameters parameters() override {
    Parameters all = element_.parameters();
    const Parameters own = {
        {"penalty_invalid", "added to an element's penalty when its transformation is undone",
         &penalty_invalid_, 0.0, 1.0},
        {"penalty_repeated", "added when the element is picked twice in a row", &penalty_repeated_,
         0.0, 1.0},
        {"penalty_success", "added when the transformation is kept; penalties never fall below 0",
         &penalty_success_, -1.0, 0.0},
        {"cycle", "transformations between two looks at q*_min (Section 6.2)", &cycle_, 1.0, 1e9},
        {"patience", "stop after this many looks without a new best q*_min", &patience_, 1.0, 1e9},
        {"max_cycles", "stop after this many cycles at the latest", &max_cycles_, 1.0, 1e9}};
    all.insert(all.end(), own.begin(), own.end());
    return all;
  }

  SmoothingRule rule() const override {
    return {.quality_use = QualityUse::smoother,
            .result = ResultMesh::best_q_star_min,
            .criterion = StoppingCriterion::q_star_min_stall,
            .patience = patience_,
            .max_iterations = max_cycles_};
  }

  /// Fills the heap with the elements that can be changed.
  void initialize(const SmoothingState<2>& state) override {
    const auto& topology = state.mesh.topology();
    std::vector<CellIndex> changeable;
    for (CellIndex c = 0; c < topology.n_cells(); ++c)
      if (topology.has_free_node(c)) changeable.push_back(c);
    heap_.build(state.cell_quality, std::move(changeable));
    penalties_.assign(topology.n_cells(), 0.0);
    last_picked_ = no_cell;
  }

  StepReport step(SmoothingState<2>& state) override {
    StepReport report{.n_counted = 0};
    const PolygonTransformation transformation = element_.transformation();
    for (int i = 0; i < cycle_ && !heap_.empty(); ++i) {
      const CellIndex worst = heap_.top();
      transform(state.mesh, worst, transformation);
      const bool kept = accept_or_undo(state);
      if (!kept) ++report.n_reset;
      update_penalty(worst, kept);
      if (kept)
        for (const CellIndex c : touched_)
          if (heap_.contains(c)) heap_.update(c, state.cell_quality[c] + penalties_[c]);
      heap_.update(worst, state.cell_quality[worst] + penalties_[worst]);
      ++report.n_counted;
    }
    return report;
  }

 private:
  static constexpr CellIndex no_cell = static_cast<CellIndex>(-1);

  /// Sets the free nodes of a cell to their transformed places; remembers the old ones.
  void transform(PlanarMesh& mesh, CellIndex cell, const PolygonTransformation& transformation) {
    const auto& topology = mesh.topology();
    const auto nodes = topology.cell_nodes(cell);
    moved_.clear();
    touched_.clear();
    with_corners(nodes, mesh.coordinates(), [&](auto corners) {
      with_room_for_result(corners, [&](auto result) {
        regularize(transformation, element_.rho, corners, result);
        for (std::size_t k = 0; k < nodes.size(); ++k) {
          if (topology.is_fixed(nodes[k])) continue;
          moved_.emplace_back(nodes[k], point_of(corners[k]));
          mesh.coordinates()[nodes[k]] = point_of(result[k]);
          const auto cells = topology.node_cells(nodes[k]);
          touched_.insert(touched_.end(), cells.begin(), cells.end());
        }
      });
    });
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  }

  /// Evaluates the cells around the moved nodes; puts the nodes back if one of them is invalid.
  bool accept_or_undo(SmoothingState<2>& state) {
    new_quality_.clear();
    for (const CellIndex c : touched_) {
      new_quality_.push_back(cell_mean_ratio(state.mesh, c));
      if (new_quality_.back() > 0.0) continue;
      for (const auto& [node, position] : moved_) state.mesh.coordinates()[node] = position;
      return false;
    }
    for (std::size_t i = 0; i < touched_.size(); ++i)
      state.cell_quality[touched_[i]] = new_quality_[i];
    return true;
  }

  void update_penalty(CellIndex cell, bool kept) {
    double& penalty = penalties_[cell];
    penalty += kept ? penalty_success_ : penalty_invalid_;
    if (cell == last_picked_) penalty += penalty_repeated_;
    penalty = std::max(penalty, 0.0);
    last_picked_ = cell;
  }

  PolygonRegularization element_{.lambda = 9.0 / 20.0, .theta_degrees = 25.0, .rho = 0.01};
  double penalty_invalid_ = 1e-4;
  double penalty_repeated_ = 1e-5;
  double penalty_success_ = -1e-3;
  int cycle_ = 100;
  int patience_ = 10;
  int max_cycles_ = 100000;

  IndexedMinHeap heap_;
  std::vector<double> penalties_;
  CellIndex last_picked_ = no_cell;
  std::vector<std::pair<NodeIndex, Point<2>>> moved_;
  std::vector<CellIndex> touched_;  ///< cells with a moved node
  std::vector<double> new_quality_;
};

const RegisteredMethod registered({.name = "getme-sequential",
                                   .title = "GETMe sequential",
                                   .description = "transforms the worst element, one at a time; "
                                                  "second stage of GETMe",
                                   .source = "Section 4.3, Fig. 4.3; parameters of Section 6.2"},
                                  single_stage<GetmeSequential>);

}  // namespace
}  // namespace smoothfem
