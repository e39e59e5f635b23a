#include "smoothing/loop/catalogue.h"
#include "smoothing/smoothers/gauss_seidel_sweep.h"

namespace smoothfem {
namespace {

/// Each free node moves to the mean of its edge neighbours (thesis, Eq. 1.1).
class Laplace final : public Smoother<2> {
 public:
  std::string_view name() const override { return "laplace"; }
  Parameters parameters() override { return stopping_.parameters(); }
  SmoothingRule rule() const override { return stopping_.rule(); }

  StepReport step(SmoothingState<2>& state) override {
    const auto& topology = state.mesh.topology();
    const auto& x = state.mesh.coordinates();
    return gauss_seidel_sweep(state.mesh, [&](NodeIndex i) -> Point<2> {
      const auto neighbours = topology.node_neighbours(i);
      Point<2> sum = Point<2>::Zero();
      for (const NodeIndex j : neighbours) sum += x[j];
      return sum / static_cast<double>(neighbours.size()) - x[i];
    });
  }

 private:
  DisplacementStopping stopping_;
};

const RegisteredMethod registered({.name = "laplace",
                                   .title = "Laplace",
                                   .description = "each node moves to the mean of its edge "
                                                  "neighbours; no quality control",
                                   .source = "Section 1.3.2, Eq. (1.1)"},
                                  single_stage<Laplace>);

}  // namespace
}  // namespace smoothfem
