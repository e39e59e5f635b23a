#include "smoothing/loop/catalogue.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/smoothers/quality_gain_stopping.h"

namespace smoothfem {
namespace {

/// Laplacian movements from the old places of all nodes, each accepted only if the node's cells
/// stay valid and their mean quality rises; all accepted ones are applied at once (thesis,
/// Section 1.3.2).
class SmartLaplace final : public Smoother<2> {
 public:
  std::string_view name() const override { return "smart-laplace"; }
  Parameters parameters() override { return stopping_.parameters(); }
  SmoothingRule rule() const override { return stopping_.rule(); }

  StepReport step(SmoothingState<2>& state) override {
    const auto& topology = state.mesh.topology();
    auto& x = state.mesh.coordinates();
    accepted_.clear();
    for (const NodeIndex i : topology.free_nodes()) {
      const auto neighbours = topology.node_neighbours(i);
      Point<2> mean = Point<2>::Zero();
      for (const NodeIndex j : neighbours) mean += x[j];
      mean /= static_cast<double>(neighbours.size());
      if (raises_quality(state, i, mean)) accepted_.emplace_back(i, mean);
    }
    for (const auto& [i, position] : accepted_) x[i] = position;
    return {};
  }

 private:
  /// Whether node i at `position` keeps its cells valid and raises their mean quality.
  static bool raises_quality(SmoothingState<2>& state, NodeIndex i, const Point<2>& position) {
    auto& here = state.mesh.coordinates()[i];
    const Point<2> old = here;
    here = position;
    double gain = 0.0;
    bool valid = true;
    for (const CellIndex c : state.mesh.topology().node_cells(i)) {
      const double q = cell_mean_ratio(state.mesh, c);
      if (!(q > 0.0)) {
        valid = false;
        break;
      }
      gain += q - state.cell_quality[c];
    }
    here = old;
    return valid && gain > 0.0;
  }

  QualityGainStopping stopping_;
  std::vector<std::pair<NodeIndex, Point<2>>> accepted_;
};

const RegisteredMethod registered({.name = "smart-laplace",
                                   .title = "Smart Laplace",
                                   .description = "Laplacian movements that are accepted only if "
                                                  "they raise the mean quality around the node",
                                   .source = "Section 1.3.2; Freitag (1997)"},
                                  single_stage<SmartLaplace>);

}  // namespace
}  // namespace smoothfem
