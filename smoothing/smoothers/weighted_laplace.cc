// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/geometry/cell_size.h"
#include "smoothing/laplacian/gauss_seidel_sweep.h"
#include "smoothing/loop/catalogue.h"

namespace smoothfem {
namespace {

/// Where the centroids of some cells are on average, weighted by the cells' sizes, seen from a
/// node.
template <int dim>
class WeightedCentroids {
 public:
  explicit WeightedCentroids(const Point<dim>& node) : node_(vector_of(node)) {}

  /// Adds the first `count` of several cells. Sizes are absolute: signed ones let a tangled mesh
  /// explode.
  template <class Corner, std::size_t extent>
  void add(std::span<const Corner, extent> corners, std::size_t count) {
    using Real = decltype(Corner::x);
    Corner corner_sum{};
    for (const auto& corner : corners) corner_sum = corner_sum + corner;
    const auto centroid = corner_sum / static_cast<double>(corners.size());
    const Real signed_size = signed_cell_size(corners);
    const Real size = signed_size < 0.0 ? -signed_size : signed_size;
    const auto weighted = size * (centroid - node_);
    for (std::size_t l = 0; l < count; ++l) {
      sum_ += lane(weighted, l);
      total_size_ += lane(size, l);
    }
  }

  Point<dim> mean() const {
    return total_size_ > 0.0 ? Point<dim>(sum_ / total_size_) : Point<dim>::Zero();
  }

 private:
  Vector<dim, double> node_;
  Point<dim> sum_ = Point<dim>::Zero();
  double total_size_ = 0.0;
};

/// Each free node moves to the mean of the centroids of its cells, weighted by their areas or
/// volumes (thesis, Eq. 1.2).
template <int dim>
class WeightedLaplace final : public Smoother<dim> {
 public:
  std::string_view name() const override { return "weighted-laplace"; }
  Parameters parameters() override { return stopping_.parameters(); }
  SmootherTraits traits() const override { return uncontrolled_sweeps; }
  StoppingRule stopping() const override { return stopping_.rule(); }

  StepReport step(SmoothingState<dim>& state) override {
    return gauss_seidel_sweep(state.mesh, [&](NodeIndex i) {
      return movement(state.mesh.topology(), state.mesh.coordinates().data(), i);
    });
  }

 private:
  static Point<dim> movement(const Topology& topology, const Point<dim>* x, NodeIndex node) {
    WeightedCentroids<dim> centroids(x[node]);
    const auto cells = topology.node_cells(node);
    prefetch_corners(topology, cells, x);
    for_each_batch<dim>(
        topology, cells,
        [&]<std::size_t n>(const CellBatch<n>& batch) {
          const auto corners = batch.template corners<dim>(x);
          centroids.add(std::span<const Vector<dim, Lanes>, n>(corners), batch.count);
          return true;
        },
        [&](std::size_t position) {
          with_corners<dim>(topology.cell_nodes(cells[position]), x,
                            [&](auto corners) { centroids.add(corners, 1); });
          return true;
        });
    return centroids.mean();
  }

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
