#include "smoothing/loop/catalogue.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/smoothers/gauss_seidel_sweep.h"

namespace smoothfem {
namespace {

/// Each free node moves to the mean of the centroids of its cells, weighted by their areas (thesis,
/// Eq. 1.2). The areas are absolute: signed ones let a tangled mesh explode.
class WeightedLaplace final : public Smoother<2> {
 public:
  std::string_view name() const override { return "weighted-laplace"; }
  Parameters parameters() override { return stopping_.parameters(); }
  SmoothingRule rule() const override { return stopping_.rule(); }

  StepReport step(SmoothingState<2>& state) override {
    const auto& topology = state.mesh.topology();
    const auto& x = state.mesh.coordinates();
    return gauss_seidel_sweep(state.mesh, [&](NodeIndex i) -> Point<2> {
      Point<2> movement = Point<2>::Zero();
      double total_area = 0.0;
      for (const CellIndex c : topology.node_cells(i)) {
        const auto nodes = topology.cell_nodes(c);
        Point<2> centroid = Point<2>::Zero();
        double twice_area = 0.0;
        for (std::size_t k = 0; k < nodes.size(); ++k) {
          const auto& here = x[nodes[k]];
          centroid += here;
          twice_area +=
              cross(vector_of(here), vector_of(x[nodes[k + 1 < nodes.size() ? k + 1 : 0]]));
        }
        centroid /= static_cast<double>(nodes.size());
        const double area = 0.5 * std::abs(twice_area);
        movement += area * (centroid - x[i]);
        total_area += area;
      }
      return total_area > 0.0 ? Point<2>(movement / total_area) : Point<2>::Zero();
    });
  }

 private:
  DisplacementStopping stopping_;
};

const RegisteredMethod registered(
    {.name = "weighted-laplace",
     .title = "Area-weighted Laplace",
     .description = "each node moves to the mean of its cells' centroids, "
                    "weighted by their areas; no quality control",
     .source = "Section 1.3.2, Eq. (1.2)"},
    single_stage<WeightedLaplace>);

}  // namespace
}  // namespace smoothfem
