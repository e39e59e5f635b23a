// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/geometry/cell_size.h"
#include "smoothing/laplacian/gauss_seidel_sweep.h"
#include "smoothing/loop/catalogue.h"

namespace smoothfem {
namespace {

/// Each free node moves to the mean of the centroids of its cells, weighted by their areas or
/// volumes (thesis, Eq. 1.2). These are absolute: signed ones let a tangled mesh explode.
template <int dim>
class WeightedLaplace final : public Smoother<dim> {
 public:
  std::string_view name() const override { return "weighted-laplace"; }
  Parameters parameters() override { return stopping_.parameters(); }
  SmootherTraits traits() const override { return uncontrolled_sweeps; }
  StoppingRule stopping() const override { return stopping_.rule(); }

  StepReport step(SmoothingState<dim>& state) override {
    const auto& topology = state.mesh.topology();
    const auto x = state.mesh.coordinates();
    return gauss_seidel_sweep(state.mesh, [&](NodeIndex i) -> Point<dim> {
      Point<dim> movement = Point<dim>::Zero();
      double total_size = 0.0;
      for (const CellIndex c : topology.node_cells(i)) {
        const auto nodes = topology.cell_nodes(c);
        Point<dim> centroid = Point<dim>::Zero();
        for (const NodeIndex node : nodes) centroid += x[node];
        centroid /= static_cast<double>(nodes.size());
        const double size = std::abs(signed_cell_size(state.mesh, c));
        movement += size * (centroid - x[i]);
        total_size += size;
      }
      return total_size > 0.0 ? Point<dim>(movement / total_size) : Point<dim>::Zero();
    });
  }

 private:
  DisplacementStopping stopping_;
};

const RegisteredMethod registered(
    {.name = "weighted-laplace",
     .title = "Weighted Laplace",
     .description = "each node moves to the mean of its cells' centroids, "
                    "weighted by their areas or volumes; no quality control",
     .source = "Section 1.3.2, Eq. (1.2)"},
    single_stage<WeightedLaplace>());

}  // namespace
}  // namespace smoothfem
