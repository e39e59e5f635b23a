// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/laplacian/sweep_stopping.h"
#include "smoothing/loop/catalogue.h"

namespace smoothfem {
namespace {

/// Moves each free node to the mean of its edge neighbours (thesis, Eq. 1.1).
template <int dim, int spacedim>
class Laplace final : public Smoother<dim, spacedim> {
 public:
  std::string_view name() const override { return "laplace"; }
  Parameters parameters() override { return stopping_.parameters(); }
  SmootherTraits traits() const override { return stopping_.traits(); }
  StoppingRule stopping() const override { return stopping_.rule(); }

  void initialize(const SmoothingState<dim, spacedim>& state) override {
    state.mesh.topology().build_node_neighbours();
  }

  StepReport step(SmoothingState<dim, spacedim>& state) override {
    return laplacian_sweep(state.mesh, [&](std::size_t, NodeIndex i) -> Point<spacedim> {
      return mean_of_neighbours(state.mesh, i) - state.mesh.coordinates()[i];
    });
  }

 private:
  SweepStopping stopping_;
};

const RegisteredMethod registered({.name = "laplace",
                                   .title = "Laplace",
                                   .description = "each node moves to the mean of its edge "
                                                  "neighbours; no quality control",
                                   .source = "Section 1.3.2, Eq. (1.1)"},
                                  single_stage_also_on_surfaces<Laplace>());

}  // namespace
}  // namespace smoothfem
