// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/base/parallel.h"
#include "smoothing/laplacian/laplacian_sweep.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/parts/shared_coordinates.h"
#include "smoothing/quality/local_quality.h"

namespace smoothfem {
namespace {

/// Computes Laplacian movements from the old positions of all nodes. A movement is accepted only if
/// the node's cells stay valid and their mean quality rises. All accepted movements are made at
/// once (thesis, Section 1.3.2).
template <int dim, int spacedim>
class SmartLaplace final : public Smoother<dim, spacedim> {
 public:
  std::string_view name() const override { return "smart-laplace"; }
  Parameters parameters() override { return stopping_.parameters(); }
  SmootherTraits traits() const override {
    return {.keeps_constraints = true, .works_in_parts = true};
  }
  StoppingRule stopping() const override { return stopping_.rule(); }

  void initialize(const SmoothingState<dim, spacedim>& state) override {
    state.mesh.topology().build_node_neighbours();
  }

  StepReport step(SmoothingState<dim, spacedim>& state) override {
    constexpr std::size_t grain = 1024;
    const auto& free_nodes = state.mesh.topology().free_nodes();
    positions_.resize(free_nodes.size());
    parallel_for_ranges(free_nodes.size(), grain, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) positions_[i] = next(state, free_nodes[i]);
    });
    for (std::size_t i = 0; i < free_nodes.size(); ++i)
      state.mesh.coordinates()[free_nodes[i]] = positions_[i];
    update_copies(state.mesh);
    return {};
  }

 private:
  /// Returns the mean of a node's neighbours if that is accepted, otherwise the present position.
  static Point<spacedim> next(const SmoothingState<dim, spacedim>& state, NodeIndex node) {
    const Point<spacedim> mean =
        allowed_position(state.mesh, node, mean_of_neighbours(state.mesh, node));
    return raises_quality(state, node, mean) ? mean : state.mesh.coordinates()[node];
  }

  /// True if a node's cells are valid with a higher mean quality after the move than before.
  static bool raises_quality(const SmoothingState<dim, spacedim>& state, NodeIndex node,
                             const Point<spacedim>& moved) {
    const auto cells = state.mesh.topology().node_cells(node);
    const Point<spacedim>* const x = state.mesh.coordinates().data();
    double gain = 0.0;
    const bool valid = for_each_mean_ratio_at(
        state.mesh, cells,
        [&](NodeIndex i) -> const Point<spacedim>& { return i == node ? moved : x[i]; },
        [&](std::size_t position, double quality) {
          gain += quality - state.cell_quality[cells[position]];
          return quality > 0.0;
        });
    return valid && gain > 0.0;
  }

  QualityGainStopping stopping_;
  std::vector<Point<spacedim>> positions_;  ///< of the free nodes, after the step
};

const RegisteredMethod registered({.name = "smart-laplace",
                                   .title = "Smart Laplace",
                                   .description = "Laplacian movements that are accepted only if "
                                                  "they raise the mean quality around the node",
                                   .source = "Section 1.3.2; Freitag (1997)"},
                                  single_stage_also_on_surfaces<SmartLaplace>());

}  // namespace
}  // namespace smoothfem
