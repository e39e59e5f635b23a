#include "smoothing/base/parallel.h"
#include "smoothing/laplacian/gauss_seidel_sweep.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/quality_gain_stopping.h"
#include "smoothing/quality/local_quality.h"

namespace smoothfem {
namespace {

/// Laplacian movements from the old places of all nodes, each accepted only if the node's cells
/// stay valid and their mean quality rises; all accepted ones are applied at once (thesis,
/// Section 1.3.2).
template <int dim, int spacedim>
class SmartLaplace final : public Smoother<dim, spacedim> {
 public:
  std::string_view name() const override { return "smart-laplace"; }
  Parameters parameters() override { return stopping_.parameters(); }
  SmoothingRule rule() const override {
    SmoothingRule rule = stopping_.rule();
    rule.keeps_constraints = true;
    return rule;
  }

  StepReport step(SmoothingState<dim, spacedim>& state) override;

 private:
  QualityGainStopping stopping_;
  std::vector<Point<spacedim>> places_;  ///< of the free nodes, after the step
};

/// Whether a node's cells are valid with a higher mean quality than before once it is at `place`.
template <int dim, int spacedim>
SMOOTHFEM_INLINE bool raises_quality(const SmoothingState<dim, spacedim>& state, NodeIndex node,
                                     const Point<spacedim>& place) {
  const auto cells = state.mesh.topology().node_cells(node);
  const auto& x = state.mesh.coordinates();
  double gain = 0.0;
  const bool valid = for_each_mean_ratio(
      state.mesh, cells,
      [&](NodeIndex i)
          SMOOTHFEM_INLINE_LAMBDA -> const Point<spacedim>& { return i == node ? place : x[i]; },
      [&](std::size_t position, double quality) SMOOTHFEM_INLINE_LAMBDA {
        gain += quality - state.cell_quality[cells[position]];
        return quality > 0.0;
      });
  return valid && gain > 0.0;
}

template <int dim, int spacedim>
SMOOTHFEM_INLINE void find_places(const SmoothingState<dim, spacedim>& state, std::size_t first,
                                  std::size_t last, std::vector<Point<spacedim>>& places) {
  const auto& free_nodes = state.mesh.topology().free_nodes();
  for (std::size_t i = first; i < last; ++i) {
    const NodeIndex node = free_nodes[i];
    const Point<spacedim> place =
        allowed_place(state.mesh, node, mean_of_neighbours(state.mesh, node));
    places[i] = raises_quality(state, node, place) ? place : state.mesh.coordinates()[node];
  }
}
void find(const SmoothingState<2>& state, std::size_t first, std::size_t last,
          std::vector<Point<2>>& places) {
  find_places(state, first, last, places);
}
void find(const SmoothingState<3>& state, std::size_t first, std::size_t last,
          std::vector<Point<3>>& places) {
  find_places(state, first, last, places);
}
void find(const SmoothingState<2, 3>& state, std::size_t first, std::size_t last,
          std::vector<Point<3>>& places) {
  find_places(state, first, last, places);
}

template <int dim, int spacedim>
StepReport SmartLaplace<dim, spacedim>::step(SmoothingState<dim, spacedim>& state) {
  constexpr std::size_t grain = 1024;
  const auto& free_nodes = state.mesh.topology().free_nodes();
  places_.resize(free_nodes.size());
  parallel_for_ranges(free_nodes.size(), grain, [&](std::size_t first, std::size_t last) {
    find(state, first, last, places_);
  });
  for (std::size_t i = 0; i < free_nodes.size(); ++i)
    state.mesh.coordinates()[free_nodes[i]] = places_[i];
  return {};
}

const RegisteredMethod registered({.name = "smart-laplace",
                                   .title = "Smart Laplace",
                                   .description = "Laplacian movements that are accepted only if "
                                                  "they raise the mean quality around the node",
                                   .source = "Section 1.3.2; Freitag (1997)"},
                                  single_stage_also_on_surfaces<SmartLaplace>());

}  // namespace
}  // namespace smoothfem
