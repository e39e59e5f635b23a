// SPDX-License-Identifier: GPL-3.0-or-later
// A second smoother like that of README, for volume meshes only, with its own parameters.
#include <cmath>

#include "smoothing/loop/catalogue.h"

namespace smoothfem {
namespace {

/// Moves each free node part of the way to the mean of its edge neighbours. Powers of the edges'
/// lengths are the weights: long edges pull more.
template <int dim>
class ShortEdgeLaplace final : public Smoother<dim> {
 public:
  std::string_view name() const override { return "short-edge-laplace"; }
  Parameters parameters() override {
    Parameters all = stopping_.parameters();
    all.push_back({"exponent", "of the edge lengths in the weights; 0 takes the plain mean",
                   &exponent_, 0.0, 4.0});
    all.push_back({"relaxation", "part of the way, in (0, 1]", &relaxation_, 0.0, 1.0});
    return all;
  }
  StoppingRule stopping() const override { return stopping_.rule(); }

  StepReport step(SmoothingState<dim>& state) override {
    const auto old = state.mesh.copied_coordinates();
    for (const NodeIndex i : state.mesh.topology().free_nodes()) {
      Point<dim> pull = Point<dim>::Zero();
      double sum = 0.0;
      for (const NodeIndex j : state.mesh.topology().node_neighbours(i)) {
        const Point<dim> edge = old[j] - old[i];
        const double weight = std::pow(edge.norm(), exponent_);
        pull += weight * edge;
        sum += weight;
      }
      if (sum > 0.0) state.mesh.coordinates()[i] += relaxation_ / sum * pull;
    }
    return {};
  }

 private:
  double exponent_ = 1.0, relaxation_ = 0.5;
  QualityGainStopping stopping_;
};

const RegisteredMethod registered({.name = "short-edge-laplace",
                                   .title = "Short-edge Laplace",
                                   .description = "Laplace weighted by the lengths of edges",
                                   .source = "a test of this program"},
                                  {.volume = make_single_stage<ShortEdgeLaplace<3>, 3>});

}  // namespace
}  // namespace smoothfem
