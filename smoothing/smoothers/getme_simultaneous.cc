#include <cmath>

#include "smoothing/loop/catalogue.h"
#include "smoothing/mesh/cell_blocks.h"
#include "smoothing/smoothers/polygon_regularization.h"
#include "smoothing/smoothers/quality_gain_stopping.h"

namespace smoothfem {
namespace {

/// Transforms every element; each free node moves to the weighted mean of its places in its
/// transformed elements (thesis, Section 4.2, Eq. 4.2 and Fig. 4.2).
class GetmeSimultaneous final : public Smoother<2> {
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

  /// Free nodes have the number of their elements as weight sum when every element counts the same.
  void initialize(const SmoothingState<2>& state) override {
    const auto& topology = state.mesh.topology();
    counts_.resize(topology.n_nodes());
    for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
      counts_[i] = static_cast<double>(topology.node_cells(i).size());
  }

  StepReport step(SmoothingState<2>& state) override {
    sums_.assign(state.mesh.n_nodes(), Point<2>::Zero());
    if (eta_ == 0.0) {
      add_with_equal_weights(state);
    } else {
      weights_.assign(state.mesh.n_nodes(), 0.0);
      add_with_quality_weights(state);
    }
    const auto& weights = eta_ == 0.0 ? counts_ : weights_;
    // Where all weights are zero the node's elements are regular already: it stays.
    for (const NodeIndex i : state.mesh.topology().free_nodes())
      if (weights[i] > 0.0) state.mesh.coordinates()[i] = sums_[i] / weights[i];
    return {};
  }

 private:
  template <bool weighted>
  SMOOTHFEM_INLINE void add_node(const SmoothingState<2>& state, CellIndex cell, NodeIndex node,
                                 const Point<2>& place) {
    if constexpr (weighted) {
      const double weight = std::pow(1.0 - state.cell_quality[cell], eta_);
      sums_[node] += weight * place;
      weights_[node] += weight;
    } else {
      sums_[node] += place;
    }
  }

  template <bool weighted>
  void add_transformed_elements(const SmoothingState<2>& state);
  // Templates cannot be compiled for several kinds of registers; these can.
  void add_with_equal_weights(const SmoothingState<2>& state);
  void add_with_quality_weights(const SmoothingState<2>& state);

  PolygonRegularization element_{.lambda = 7.0 / 20.0, .theta_degrees = 15.0, .rho = 1.0};
  double eta_ = 0.0;
  QualityGainStopping stopping_;
  std::vector<Point<2>> sums_;
  std::vector<double> weights_;
  std::vector<double> counts_;
};

/// Adds each element's nodes in the order of the elements, so every node's sum has one order.
template <bool weighted>
SMOOTHFEM_INLINE void GetmeSimultaneous::add_transformed_elements(const SmoothingState<2>& state) {
  const PolygonTransformation transformation = element_.transformation();
  const double rho = element_.rho;
  const auto& cells = state.mesh.topology().cells();
  for_each_block(
      state.mesh.topology(), state.mesh.coordinates(),
      [&]<std::size_t n>(CellIndex c,
                         const std::array<Vector2<Lanes>, n>& corners) SMOOTHFEM_INLINE_LAMBDA {
        std::array<Vector2<Lanes>, n> result;
        regularize(transformation, rho, std::span(corners), std::span(result));
        const NodeIndex* nodes = cells[c].data();
        for (std::size_t l = 0; l < n_lanes; ++l)
          for (std::size_t k = 0; k < n; ++k)
            add_node<weighted>(state, c + l, nodes[l * n + k], {result[k].x[l], result[k].y[l]});
      },
      [&](CellIndex c, auto corners) SMOOTHFEM_INLINE_LAMBDA {
        with_room_for_result(corners, [&](auto result) SMOOTHFEM_INLINE_LAMBDA {
          regularize(transformation, rho, corners, result);
          for (std::size_t k = 0; k < result.size(); ++k)
            add_node<weighted>(state, c, cells[c][k], point_of(result[k]));
        });
      });
}

SMOOTHFEM_VECTOR_CLONES
void GetmeSimultaneous::add_with_equal_weights(const SmoothingState<2>& state) {
  add_transformed_elements<false>(state);
}
SMOOTHFEM_VECTOR_CLONES
void GetmeSimultaneous::add_with_quality_weights(const SmoothingState<2>& state) {
  add_transformed_elements<true>(state);
}

const RegisteredMethod registered({.name = "getme-simultaneous",
                                   .title = "GETMe simultaneous",
                                   .description = "transforms all elements at once and averages; "
                                                  "first stage of GETMe",
                                   .source = "Section 4.2, Fig. 4.2; parameters of Section 6.2"},
                                  single_stage<GetmeSimultaneous>);

}  // namespace
}  // namespace smoothfem
