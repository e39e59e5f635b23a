#include "smoothing/loop/catalogue.h"
#include "smoothing/mesh/cell_blocks.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/smoothers/quality_gain_stopping.h"

namespace smoothfem {
namespace {

/// Adds how much the quality of n_lanes cells with n nodes each (the first `count` of them) has
/// changed; false as soon as one is invalid.
template <std::size_t n>
SMOOTHFEM_INLINE bool add_gain(const SmoothingState<2>& state, const CellIndex* cells,
                               std::size_t count, double& gain) {
  const auto& topology = state.mesh.topology();
  std::array<const NodeIndex*, n_lanes> rows;
  for (std::size_t l = 0; l < n_lanes; ++l)
    rows[l] = topology.cell_nodes(cells[std::min(l, count - 1)]).data();
  const auto corners = gather_cells<n>(state.mesh.coordinates().data(), rows);
  const Lanes q = mean_ratio(std::span(corners));
  for (std::size_t l = 0; l < count; ++l) {
    if (!(q[l] > 0.0)) return false;
    gain += q[l] - state.cell_quality[cells[l]];
  }
  return true;
}

/// Whether a node's cells, in their order, are valid with a higher mean quality than before. Takes
/// triangles and quadrilaterals several at a time where they follow each other.
SMOOTHFEM_INLINE bool raises_quality(const SmoothingState<2>& state,
                                     std::span<const CellIndex> cells) {
  const auto& topology = state.mesh.topology();
  double gain = 0.0;
  for (std::size_t first = 0; first < cells.size();) {
    const auto nodes = topology.cell_nodes(cells[first]);
    std::size_t count = 1;
    while (count < n_lanes && first + count < cells.size() &&
           topology.cell_nodes(cells[first + count]).size() == nodes.size())
      ++count;
    bool valid;
    if (nodes.size() == 3) {
      valid = add_gain<3>(state, &cells[first], count, gain);
    } else if (nodes.size() == 4) {
      valid = add_gain<4>(state, &cells[first], count, gain);
    } else {
      count = 1;
      const double q = cell_mean_ratio(state.mesh, cells[first]);
      gain += q - state.cell_quality[cells[first]];
      valid = q > 0.0;
    }
    if (!valid) return false;
    first += count;
  }
  return gain > 0.0;
}

/// Laplacian movements from the old places of all nodes, each accepted only if the node's cells
/// stay valid and their mean quality rises; all accepted ones are applied at once (thesis,
/// Section 1.3.2).
class SmartLaplace final : public Smoother<2> {
 public:
  std::string_view name() const override { return "smart-laplace"; }
  Parameters parameters() override { return stopping_.parameters(); }
  SmoothingRule rule() const override { return stopping_.rule(); }

  StepReport step(SmoothingState<2>& state) override {
    find_accepted(state);
    for (const auto& [i, position] : accepted_) state.mesh.coordinates()[i] = position;
    return {};
  }

 private:
  void find_accepted(SmoothingState<2>& state);

  QualityGainStopping stopping_;
  std::vector<std::pair<NodeIndex, Point<2>>> accepted_;
};

SMOOTHFEM_VECTOR_CLONES
void SmartLaplace::find_accepted(SmoothingState<2>& state) {
  const auto& topology = state.mesh.topology();
  auto& x = state.mesh.coordinates();
  accepted_.clear();
  for (const NodeIndex i : topology.free_nodes()) {
    const auto neighbours = topology.node_neighbours(i);
    Point<2> mean(0.0, 0.0);
    for (const NodeIndex j : neighbours) mean += x[j];
    mean /= static_cast<double>(neighbours.size());
    const Point<2> old = x[i];
    x[i] = mean;
    if (raises_quality(state, topology.node_cells(i))) accepted_.emplace_back(i, mean);
    x[i] = old;
  }
}

const RegisteredMethod registered({.name = "smart-laplace",
                                   .title = "Smart Laplace",
                                   .description = "Laplacian movements that are accepted only if "
                                                  "they raise the mean quality around the node",
                                   .source = "Section 1.3.2; Freitag (1997)"},
                                  single_stage<SmartLaplace>);

}  // namespace
}  // namespace smoothfem
