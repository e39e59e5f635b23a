// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/base/parallel.h"
#include "smoothing/getme/element_pass.h"
#include "smoothing/getme/simultaneous_elements.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/invalid_node_reset.h"
#include "smoothing/mesh/node_constraints.h"
#include "smoothing/parts/shared_coordinates.h"

namespace smoothfem {
namespace {

/// Transforms every element; each free node moves to the weighted mean of its positions in its
/// transformed elements (thesis, Section 4.2, Eq. 4.2 and Fig. 4.2). One pass over the elements
/// computes their quality and the sums for the next iteration, so that each element is loaded once.
/// The pass after an iteration's movements therefore starts the next iteration.
template <int dim, int spacedim>
class GetmeSimultaneous final : public Smoother<dim, spacedim> {
 public:
  std::string_view name() const override { return "simultaneous"; }

  Parameters parameters() override {
    Parameters all = element_.parameters();
    all.push_back({"eta", "exponent of the weights (1 - q)^eta; 0 takes the plain mean (Eq. 4.2)",
                   &eta_, 0.0, 1e3});
    for (auto& parameter : stopping_.parameters()) all.push_back(std::move(parameter));
    return all;
  }
  SmootherTraits traits() const override {
    return {.quality_use = QualityUse::smoother,
            .keeps_constraints = true,
            .takes_targets = true,
            .works_in_parts = !element_.fits_neighbours()};
  }
  StoppingRule stopping() const override { return stopping_.rule(); }

  void initialize(const SmoothingState<dim, spacedim>& state) override {
    pass_.prepare(state.mesh, element_);
    previous_.resize(state.mesh.n_nodes());
    is_transformed_ = false;
  }

  StepReport step(SmoothingState<dim, spacedim>& state) override {
    if (!is_transformed_) pass_.transform_all(state, eta_);
    is_transformed_ = true;
    move_nodes(state.mesh);
    StepReport report{.quality = pass_.transform_all(state, eta_)};
    report.n_made_invalid = report.quality->n_invalid;
    if (report.quality->n_invalid > 0 || has_facet_bound(state.mesh)) {
      const auto nodes = reset_nodes_of_invalid_cells(state.mesh, previous_, state.cell_quality);
      report.n_reset = count_in_whole(state.mesh.topology(), nodes);
      if (report.n_reset > 0) report.quality = pass_.transform_around(state, nodes, eta_);
    }
    return report;
  }

 private:
  /// p_i = sum of w_j p'_ij over the elements j around node i, divided by the sum of w_j (Eq. 4.2).
  /// If all weights are zero, the elements are regular already: the node stays.
  void move_nodes(Mesh<dim, spacedim>& mesh) {
    constexpr std::size_t grain = 512;
    const auto move = [&](const auto& place) {
      parallel_for_ranges(mesh.n_nodes(), grain, [&](std::size_t first, std::size_t last) {
        for (auto i = static_cast<NodeIndex>(first); i < last; ++i) {
          const bool moves = !mesh.topology().is_fixed(i) && pass_.has_mean(i);
          previous_[i] = moves ? place(i) : mesh.coordinates()[i];
        }
      });
    };
    if (mesh.constraints() == nullptr)
      move([&](NodeIndex i) -> Point<spacedim> { return pass_.mean(i); });
    else
      move([&](NodeIndex i) { return allowed_position(mesh, i, pass_.mean(i)); });
    mesh.swap_coordinates(previous_);
    update_copies(mesh);
  }

  ElementParameters<dim> element_ = simultaneous_elements<dim>();
  double eta_ = 0.0;
  QualityGainStopping stopping_;
  ElementPass<dim, spacedim> pass_;
  std::vector<Point<spacedim>> previous_;
  bool is_transformed_ = false;  ///< true if the sums of pass_ are those of the present mesh
};

const RegisteredMethod registered({.name = "getme-simultaneous",
                                   .title = "GETMe simultaneous",
                                   .description = "transforms all elements at once and averages; "
                                                  "first stage of GETMe",
                                   .source = "Section 4.2, Fig. 4.2; parameters of Chapter 6"},
                                  single_stage_also_on_surfaces<GetmeSimultaneous>());

}  // namespace
}  // namespace smoothfem
