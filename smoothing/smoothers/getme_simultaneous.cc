#include <cmath>

#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/node_sums.h"
#include "smoothing/mesh/cell_blocks.h"
#include "smoothing/smoothers/element_regularization.h"
#include "smoothing/smoothers/quality_gain_stopping.h"

namespace smoothfem {
namespace {

/// (1 - q)^eta. The exponents of the thesis by square roots, which have the same bits on every
/// machine; others as the mathematical library has them.
SMOOTHFEM_INLINE double quality_weight(double quality, double eta) {
  const double base = std::max(1.0 - quality, 0.0);
  if (eta == 0.0) return 1.0;
  if (eta == 0.5) return std::sqrt(base);
  if (eta == 0.25) return std::sqrt(std::sqrt(base));
  if (eta == 1.0) return base;
  return std::pow(base, eta);
}
SMOOTHFEM_INLINE Lanes quality_weight(Lanes quality, double eta) {
  if (eta == 0.0) return Lanes{} + 1.0;
  Lanes weight;
  for (std::size_t l = 0; l < n_lanes; ++l) weight[l] = quality_weight(quality[l], eta);
  return weight;
}

/// Adds each element's transformed nodes, in the order of the elements.
template <int dim>
SMOOTHFEM_INLINE void add_transformed_elements(const SmoothingState<dim>& state,
                                               const ElementRegularization<dim>& element,
                                               double eta, const CellBlock& block, double* sums) {
  const auto& cells = state.mesh.topology().cells();
  for_each_block<dim>(
      state.mesh.topology(), state.mesh.coordinates(), block.first, block.last,
      [&]<std::size_t n>(CellIndex c, const std::array<Vector<dim, Lanes>, n>& corners)
          SMOOTHFEM_INLINE_LAMBDA {
            std::array<Vector<dim, Lanes>, n> result;
            const Lanes quality = load_lanes(&state.cell_quality[c]);
            element.regularize(quality, std::span<const Vector<dim, Lanes>, n>(corners),
                               std::span<Vector<dim, Lanes>, n>(result));
            const Lanes weight = quality_weight(quality, eta);
            const NodeIndex* const nodes = cells[c].data();
            for (std::size_t k = 0; k < n; ++k) {
              const auto places = weighted_places(result[k], weight);
              for (std::size_t l = 0; l < n_lanes; ++l)
                NodeSums::add(sums, nodes[l * n + k], places[l]);
            }
          },
      [&](CellIndex c, auto corners) SMOOTHFEM_INLINE_LAMBDA {
        with_room_for_result(corners, [&](auto result) SMOOTHFEM_INLINE_LAMBDA {
          element.regularize(state.cell_quality[c], corners, result);
          const double weight = quality_weight(state.cell_quality[c], eta);
          for (std::size_t k = 0; k < result.size(); ++k)
            NodeSums::add(sums, cells[c][k], weighted_place(result[k], weight));
        });
      });
}
// Templates cannot be compiled for several kinds of registers; these can.
SMOOTHFEM_VECTOR_CLONES
void add_elements(const SmoothingState<2>& state, const ElementRegularization<2>& element,
                  double eta, const CellBlock& block, double* sums) {
  add_transformed_elements<2>(state, element, eta, block, sums);
}
SMOOTHFEM_VECTOR_CLONES
void add_elements(const SmoothingState<3>& state, const ElementRegularization<3>& element,
                  double eta, const CellBlock& block, double* sums) {
  add_transformed_elements<3>(state, element, eta, block, sums);
}

ElementRegularization<2> default_element(std::integral_constant<int, 2>) {
  ElementRegularization<2> element;
  element.lambda = 7.0 / 20.0;
  element.theta_degrees = 15.0;
  element.rho = 1.0;
  return element;
}
/// Tetrahedra and hexahedra as in Section 6.3, pyramids and prisms, which do not settle for large
/// sigma, as in Section 5.4.
ElementRegularization<3> default_element(std::integral_constant<int, 3>) {
  ElementRegularization<3> element;
  element.tetrahedron = element.hexahedron = {0.7, 50.7};
  element.pyramid = {1.86, 1.86};
  element.prism = {1.59, 1.59};
  element.rho = 1.0;
  return element;
}

/// Transforms every element; each free node moves to the weighted mean of its places in its
/// transformed elements (thesis, Section 4.2, Eq. 4.2 and Fig. 4.2).
template <int dim>
class GetmeSimultaneous final : public Smoother<dim> {
 public:
  std::string_view name() const override { return "simultaneous"; }

  Parameters parameters() override {
    Parameters all = element_.parameters();
    all.push_back({"eta", "exponent of the weights (1 - q)^eta; 0 takes the plain mean (Eq. 4.2)",
                   &eta_, 0.0, 1e3});
    for (auto& parameter : stopping_.parameters()) all.push_back(std::move(parameter));
    return all;
  }

  SmoothingRule rule() const override { return stopping_.rule(); }

  void initialize(const SmoothingState<dim>& state) override {
    element_.prepare();
    sums_.prepare(state.mesh.topology());
  }

  StepReport step(SmoothingState<dim>& state) override {
    const Topology& topology = state.mesh.topology();
    parallel_for(topology.blocks().size(), [&](std::size_t b) {
      add_elements(state, element_, eta_, topology.blocks()[b], sums_.start_block(b));
    });
    // Where all weights are zero the node's elements are regular already: it stays.
    sums_.for_each_node([&](NodeIndex i, const double* sums) {
      if (!topology.is_fixed(i) && sums[dim] > 0.0)
        state.mesh.coordinates()[i] = mean_place<dim>(sums);
    });
    return {};
  }

 private:
  ElementRegularization<dim> element_ = default_element(std::integral_constant<int, dim>{});
  double eta_ = 0.0;
  QualityGainStopping stopping_;
  NodeSums sums_;
};

const RegisteredMethod registered({.name = "getme-simultaneous",
                                   .title = "GETMe simultaneous",
                                   .description = "transforms all elements at once and averages; "
                                                  "first stage of GETMe",
                                   .source = "Section 4.2, Fig. 4.2; parameters of Chapter 6"},
                                  single_stage<GetmeSimultaneous>());

}  // namespace
}  // namespace smoothfem
