// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/geometry/cell_size.h"
#include "smoothing/laplacian/cells_around_nodes.h"
#include "smoothing/laplacian/sweep_stopping.h"
#include "smoothing/loop/catalogue.h"

namespace smoothfem {
namespace {

/// Sums of cells' sizes and of their centroids weighted by size, relative to a node. Sizes are
/// absolute: with signed sizes a tangled mesh explodes.
template <int dim>
class WeightedCentroids {
 public:
  explicit WeightedCentroids(const Point<dim>& node) : node_(vector_of(node)) {}

  /// Adds a cell.
  template <std::size_t extent>
  void add(std::span<const Vector<dim, double>, extent> corners) {
    const auto [centroid, size] = weighted(corners);
    if constexpr (dim == 2)
      sums_ += Lanes{centroid.x, centroid.y, size};
    else
      sums_ += Lanes{centroid.x, centroid.y, centroid.z, size};
  }
  /// Adds the first `count` of several cells, one after the other.
  template <std::size_t extent>
  void add(std::span<const Vector<dim, Lanes>, extent> corners, std::size_t count) {
    const auto [centroid, size] = weighted(corners);
    std::array<Lanes, n_lanes> of_cells;
    if constexpr (dim == 2)
      of_cells = transposed(centroid.x, centroid.y, size, Lanes{});
    else
      of_cells = transposed(centroid.x, centroid.y, centroid.z, size);
    for (std::size_t l = 0; l < count; ++l) sums_ += of_cells[l];
  }

  Point<dim> mean() const {
    if (!(sums_[dim] > 0.0)) return Point<dim>::Zero();
    Point<dim> mean;
    for (int d = 0; d < dim; ++d) mean[d] = sums_[d] / sums_[dim];
    return mean;
  }

 private:
  template <class Corner, std::size_t extent>
  auto weighted(std::span<const Corner, extent> corners) const {
    Corner sum{};
    for (const auto& corner : corners) sum = sum + corner;
    const auto centroid = sum / static_cast<double>(corners.size());
    const auto signed_size = signed_cell_size(corners);
    const auto size = signed_size < 0.0 ? -signed_size : signed_size;
    return std::pair(size * (centroid - node_), size);
  }

  Vector<dim, double> node_;
  Lanes sums_{};  ///< weighted coordinates, followed by the sizes
};

/// Moves each free node to the mean of the centroids of its cells, weighted by their areas or
/// volumes (thesis, Eq. 1.2).
template <int dim>
class WeightedLaplace final : public Smoother<dim> {
 public:
  std::string_view name() const override { return "weighted-laplace"; }
  Parameters parameters() override { return stopping_.parameters(); }
  SmootherTraits traits() const override { return stopping_.traits(); }
  StoppingRule stopping() const override { return stopping_.rule(); }

  void initialize(const SmoothingState<dim>& state) override {
    cells_around_.prepare(state.mesh.shared_topology());
  }

  StepReport step(SmoothingState<dim>& state) override {
    return laplacian_sweep(state.mesh, [&](std::size_t position, NodeIndex i) {
      return cells_around_.with_cells(position, [&](const auto& cells) {
        return movement(cells, state.mesh.coordinates().data(), i);
      });
    });
  }

 private:
  template <class Cells>
  static Point<dim> movement(const Cells& cells, const Point<dim>* x, NodeIndex node) {
    WeightedCentroids<dim> centroids(x[node]);
    for_each_batch<dim>(
        cells,
        [&]<std::size_t n>(const CellBatch<n>& batch) {
          const auto corners = batch.template corners<dim>(x);
          centroids.add(std::span<const Vector<dim, Lanes>, n>(corners), batch.count);
          return true;
        },
        [&](std::size_t position) {
          with_corners<dim>(cells.nodes(position), x,
                            [&](auto corners) { centroids.add(corners); });
          return true;
        });
    return centroids.mean();
  }

  SweepStopping stopping_;
  CellsAroundNodes cells_around_;
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
