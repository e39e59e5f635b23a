#include <algorithm>
#include <cmath>
#include <utility>

#include "smoothing/getme/element_pass.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/invalid_node_reset.h"
#include "smoothing/loop/quality_gain_stopping.h"

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

/// Weights of Eq. 4.2; every element is transformed.
struct QualityWeighting {
  double eta;

  template <class Cells, class Real>
  SMOOTHFEM_INLINE Real weight(const Cells&, Real quality) const {
    return quality_weight(quality, eta);
  }
  template <class Real>
  SMOOTHFEM_INLINE AllTransformed transforms(Real) const {
    return {};
  }
};
template <int dim, int spacedim = dim>
using Pass = ElementPass<dim, QualityWeighting, spacedim>;

void add_block(const Pass<2>& pass, const CellBlock& block, double* quality, double* sums) {
  add_whole_block(pass, block, quality, sums);
}
void add_block(const Pass<3>& pass, const CellBlock& block, double* quality, double* sums) {
  add_whole_block(pass, block, quality, sums);
}
void add_block(const Pass<2, 3>& pass, const CellBlock& block, double* quality, double* sums) {
  add_whole_block(pass, block, quality, sums);
}
void add_some(const Pass<2>& pass, std::span<const CellIndex> cells,
              const std::vector<std::uint8_t>& marked, double* sums) {
  add_to_marked(pass, cells, marked, sums);
}
void add_some(const Pass<3>& pass, std::span<const CellIndex> cells,
              const std::vector<std::uint8_t>& marked, double* sums) {
  add_to_marked(pass, cells, marked, sums);
}
void add_some(const Pass<2, 3>& pass, std::span<const CellIndex> cells,
              const std::vector<std::uint8_t>& marked, double* sums) {
  add_to_marked(pass, cells, marked, sums);
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
/// transformed elements (thesis, Section 4.2, Eq. 4.2 and Fig. 4.2). One pass over the elements
/// gives their quality and the sums for the next iteration, so that each is fetched and looked at
/// once: the pass after an iteration's movements starts the next one.
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

  SmoothingRule rule() const override {
    SmoothingRule rule = stopping_.rule();
    rule.quality_use = QualityUse::smoother;
    rule.keeps_constraints = true;
    return rule;
  }

  void initialize(const SmoothingState<dim, spacedim>& state) override {
    element_.prepare();
    sums_.prepare(state.mesh.topology());
    parts_.resize(state.mesh.topology().blocks().size());
    ready_ = false;
  }

  StepReport step(SmoothingState<dim, spacedim>& state) override {
    const Topology& topology = state.mesh.topology();
    if (!ready_) pass_over_all(state);
    ready_ = true;
    // Where all weights are zero the node's elements are regular already: it stays.
    previous_.resize(topology.n_nodes());
    sums_.for_each_node([&](NodeIndex i, const double* sums) {
      const bool moves = !topology.is_fixed(i) && sums[spacedim] > 0.0;
      previous_[i] = moves ? allowed_place(state.mesh, i, mean_place<spacedim>(sums))
                           : state.mesh.coordinates()[i];
    });
    previous_.swap(state.mesh.coordinates());
    StepReport report;
    report.quality = pass_over_all(state);
    if (report.quality->n_invalid > 0 || has_facet_bound(state.mesh)) {
      const auto nodes = reset_nodes_of_invalid_cells(state.mesh, previous_, state.cell_quality);
      if (!nodes.empty()) report.quality = pass_around(state, nodes);
      report.n_reset = nodes.size();
    }
    return report;
  }

 private:
  MeshQuality pass_over_all(SmoothingState<dim, spacedim>& state) {
    const Topology& topology = state.mesh.topology();
    const Pass<dim, spacedim> pass{state.mesh, element_, {eta_}};
    sums_.compute([&](std::size_t b, double* sums) {
      const CellBlock& block = topology.blocks()[b];
      add_block(pass, block, state.cell_quality.data(), sums);
      parts_[b] = PartialQuality(topology, state.cell_quality, block);
    });
    return mesh_quality(parts_, topology.n_cells());
  }

  /// Makes the sums those of the present mesh again after some nodes were put back: the sums of the
  /// nodes of their cells, from all cells around those. Same bits as a pass over all cells.
  MeshQuality pass_around(SmoothingState<dim, spacedim>& state,
                          const std::vector<NodeIndex>& nodes) {
    const Topology& topology = state.mesh.topology();
    marked_nodes_.assign(topology.n_nodes(), 0);
    marked_cells_.assign(topology.n_cells(), 0);
    std::vector<NodeIndex> changed_sums;
    for (const NodeIndex i : nodes)
      for (const CellIndex c : topology.node_cells(i))
        for (const NodeIndex j : topology.cell_nodes(c))
          if (!std::exchange(marked_nodes_[j], 1)) changed_sums.push_back(j);
    if (4 * changed_sums.size() > topology.n_nodes()) return pass_over_all(state);
    std::sort(changed_sums.begin(), changed_sums.end());
    for (const NodeIndex i : changed_sums)
      for (const CellIndex c : topology.node_cells(i)) marked_cells_[c] = 1;
    std::vector<CellIndex> cells;
    for (CellIndex c = 0; c < topology.n_cells(); ++c)
      if (marked_cells_[c]) cells.push_back(c);

    const Pass<dim, spacedim> pass{state.mesh, element_, {eta_}};
    sums_.compute_some(changed_sums, cells,
                       [&](std::size_t b, std::span<const CellIndex> cells_of_block, double* sums) {
                         add_some(pass, cells_of_block, marked_nodes_, sums);
                         parts_[b] =
                             PartialQuality(topology, state.cell_quality, topology.blocks()[b]);
                       });
    return mesh_quality(parts_, topology.n_cells());
  }

  ElementRegularization<dim, spacedim> element_ =
      default_element(std::integral_constant<int, dim>{});
  double eta_ = 0.0;
  QualityGainStopping stopping_;
  NodeSums sums_;
  std::vector<PartialQuality> parts_;  ///< of each block of cells
  std::vector<Point<spacedim>> previous_;
  std::vector<std::uint8_t> marked_nodes_;  ///< whose sums have to be added again
  std::vector<std::uint8_t> marked_cells_;  ///< that add to them
  bool ready_ = false;                      ///< sums_ are those of the present mesh
};

const RegisteredMethod registered({.name = "getme-simultaneous",
                                   .title = "GETMe simultaneous",
                                   .description = "transforms all elements at once and averages; "
                                                  "first stage of GETMe",
                                   .source = "Section 4.2, Fig. 4.2; parameters of Chapter 6"},
                                  single_stage_also_on_surfaces<GetmeSimultaneous>());

}  // namespace
}  // namespace smoothfem
