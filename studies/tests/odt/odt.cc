// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/LU>

#include "smoothing/loop/catalogue.h"

namespace {
using namespace smoothfem;

/// Each free node moves to the mean of the circumcentres of its simplices, weighted by volume.
template <int dim>
struct Odt final : Smoother<dim> {
  QualityGainStopping stopping_;
  std::string_view name() const override { return "odt"; }
  Parameters parameters() override { return stopping_.parameters(); }
  StoppingRule stopping() const override { return stopping_.rule(); }

  StepReport step(SmoothingState<dim>& state) override {
    const auto& topology = state.mesh.topology();
    const auto x = state.mesh.copied_coordinates();
    std::vector<Point<dim>> moments(x.size(), Point<dim>::Zero());
    std::vector<double> volumes(x.size(), 0.0);
    for (CellIndex c = 0; c < topology.n_cells(); ++c) {
      const auto i = topology.cell_nodes(c);
      Eigen::Matrix<double, dim, dim> edges;
      for (int k = 0; k < dim; ++k) edges.row(k) = x[i[k + 1]] - x[i[0]];
      const double volume = edges.determinant();
      const Point<dim> centre = x[i[0]] + edges.inverse() * edges.rowwise().squaredNorm() / 2;
      for (const NodeIndex j : i) moments[j] += volume * centre, volumes[j] += volume;
    }
    for (const NodeIndex j : topology.free_nodes())
      state.mesh.coordinates()[j] = moments[j] / volumes[j];
    return {};
  }
};
const RegisteredMethod registered({"odt", "ODT", "optimal Delaunay triangulation", "Chen 2004"},
                                  single_stage<Odt>());

}  // namespace
