// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/bench/formula_times.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <vector>

#include "smoothing/geometry/cell_size.h"
#include "smoothing/getme/regularize.h"
#include "smoothing/optimization/volume_cell_derivatives.h"
#include "smoothing/simd/cells.h"

namespace smoothfem::bench {

namespace {

constexpr std::size_t n_batches = 32;  ///< of n_lanes cells

template <std::size_t n>
using Corners = std::array<Vector3<Lanes>, n>;
template <std::size_t n>
using Nodes = std::span<const Vector3<Lanes>, n>;

/// The first cells of a mesh, with separate nodes: about 10 KiB.
template <std::size_t n>
class FewCells {
 public:
  explicit FewCells(const VolumeMesh& mesh) {
    std::map<NodeIndex, NodeIndex> numbers;
    for (CellIndex c = 0; c < n_batches * n_lanes; ++c)
      for (const NodeIndex node : mesh.topology().cell_nodes(c)) {
        const auto [at, is_new] =
            numbers.emplace(node, static_cast<NodeIndex>(coordinates_.size()));
        if (is_new) coordinates_.push_back(mesh.coordinates()[node]);
        nodes_.push_back(at->second);
      }
  }
  Corners<n> operator[](std::size_t batch) const {
    CellBatch<n> cells{n_lanes * batch, n_lanes, {}, {}};
    for (std::size_t l = 0; l < n_lanes; ++l)
      cells.nodes[l] = nodes_.data() + n * (n_lanes * batch + l);
    return cells.template corners<3>(coordinates_.data());
  }
  /// Nodes of the cells, one cell after the other.
  const std::vector<NodeIndex>& nodes() const { return nodes_; }
  const std::vector<Point<3>>& coordinates() const { return coordinates_; }

 private:
  std::vector<Point<3>> coordinates_;
  std::vector<NodeIndex> nodes_;
};

/// Shortest time of several runs over all batches, for one of `n_each` items in a batch.
template <class Work>
double seconds_per(std::size_t n_each, const Work& work) {
  constexpr int n_runs = 400;
  double shortest = 1e300;
  for (int run = 0; run < n_runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    work();
    benchmark::ClobberMemory();
    shortest = std::min(
        shortest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return shortest / static_cast<double>(n_batches * n_each);
}

/// Calls formula(corners) for each batch; keeps the sum of the results.
template <std::size_t n, class Formula>
[[gnu::flatten]] void sum_over(const FewCells<n>& cells, double* result, const Formula& formula) {
  Lanes sum{};
  for (std::size_t b = 0; b < n_batches; ++b) {
    const auto corners = cells[b];
    sum += formula(Nodes<n>(corners));
  }
  store_lanes(sum, result);
}

template <std::size_t n>
Lanes weighted_centroid(Nodes<n> corners) {
  Vector3<Lanes> sum{};
  for (const auto& corner : corners) sum = sum + corner;
  const Lanes size = signed_cell_size(corners);
  const auto weighted = (size < 0.0 ? -size : size) * (sum / static_cast<double>(n));
  return weighted.x + weighted.y + weighted.z + size;
}

/// Adds one cell's weight times position, and its weight (here 1), to the sums of its nodes.
template <std::size_t n>
Lanes transformed(const ElementRegularization<3>& element, Nodes<n> corners, double* sums) {
  Corners<n> moved;
  const Lanes quality = element.regularize(corners, std::span<Vector3<Lanes>, n>(moved));
  unrolled<n>([&](auto k) {
    const auto terms = transposed(moved[k].x, moved[k].y, moved[k].z, Lanes{} + 1.0);
    unrolled<n_lanes>([&](auto l) {
      double* const node = sums + n_lanes * (n_lanes * k + l);
      store_lanes(load_lanes(node) + terms[l], node);
    });
  });
  return quality;
}

/// Time in seconds for a single cell, as in GETMe sequential.
template <std::size_t n>
double alone_seconds(const ElementRegularization<3>& element, const FewCells<n>& cells) {
  std::array<Vector3<double>, n> corners, moved;
  for (std::size_t k = 0; k < n; ++k) corners[k] = vector_of(cells.coordinates()[cells.nodes()[k]]);
  return seconds_per(1, [&] {
    for (std::size_t i = 0; i < n_batches; ++i) {
      benchmark::DoNotOptimize(corners);
      element.regularize(std::span<const Vector3<double>, n>(corners),
                         std::span<Vector3<double>, n>(moved));
      benchmark::DoNotOptimize(moved);
    }
  });
}

template <std::size_t n>
Lanes derivatives(Nodes<n> corners) {
  const CellDerivatives<3, Lanes, n> cell(corners, HessianModel::convex);
  Lanes sum{};
  for (const auto& entry : cell.gradient) sum += entry.x + entry.y + entry.z;
  for (const auto& block : cell.hessian)
    for (const Lanes& entry : block.entries) sum += entry;
  return sum;
}

template <std::size_t n>
double neighbour_seconds(const FewCells<n>& cells, std::size_t n_each) {
  const NodeIndex* const nodes = cells.nodes().data();
  Point<3> result;
  return seconds_per(n_each, [&] {
    for (std::size_t i = 0; i < n_batches; ++i) {
      Point<3> sum = Point<3>::Zero();
      for (std::size_t k = 0; k < n_each; ++k) sum += cells.coordinates()[nodes[i * n_each + k]];
      result = sum / static_cast<double>(n_each);
      benchmark::DoNotOptimize(result);
    }
  });
}
double weight_seconds(std::size_t n_each) {
  std::vector<double> qualities(n_batches * n_each, 0.5);
  return seconds_per(n_each, [&] {
    for (std::size_t i = 0; i < n_batches; ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < n_each; ++k) sum += qualities[i * n_each + k];
      benchmark::DoNotOptimize(sum);
    }
  });
}
double product_seconds(std::size_t n_each) {
  std::vector<float> blocks(9 * n_batches * n_each + n_lanes, 0.5f);
  std::vector<Point<3>> x(n_each, Point<3>::Constant(0.5));
  return seconds_per(n_each, [&] {
    const float* block = blocks.data();
    for (std::size_t row = 0; row < n_batches; ++row) {
      Lanes sum{};
      for (std::size_t k = 0; k < n_each; ++k, block += 9)
        for (int d = 0; d < 3; ++d)
          sum += __builtin_convertvector(load_lanes(block + 3 * d), Lanes) * x[k][d];
      benchmark::DoNotOptimize(sum);
    }
  });
}

template <std::size_t n>
FormulaTimes times_of(const VolumeMesh& mesh) {
  constexpr std::size_t n_around = 14;  ///< neighbours, or blocks of a row
  const FewCells<n> cells(mesh);
  const ElementRegularization<3> element({.tetrahedron = {0.7, 50.7},
                                          .pyramid = {1.86, 1.86},
                                          .prism = {1.59, 1.59},
                                          .hexahedron = {0.7, 50.7},
                                          .rho = 1.0});
  std::vector<double> result(n_lanes), sums(n_lanes * n_lanes * n, 0.0);
  const auto seconds = [&](const auto& formula) {
    return seconds_per(n_lanes, [&] { sum_over(cells, result.data(), formula); });
  };
  return {
      .neighbour = neighbour_seconds(cells, n_around),
      .centroid = seconds([](Nodes<n> x) { return weighted_centroid<n>(x); }),
      .mean_ratio = seconds([](Nodes<n> x) { return mean_ratio(x); }),
      .transformed = seconds([&](Nodes<n> x) { return transformed<n>(element, x, sums.data()); }),
      .transformed_alone = alone_seconds<n>(element, cells),
      .weight = weight_seconds(n_around),
      .objective = seconds([](Nodes<n> x) { return mean_inverse_mean_ratio(x); }),
      .derivatives = seconds([](Nodes<n> x) { return derivatives<n>(x); }),
      .product = product_seconds(n_around)};
}

}  // namespace

FormulaTimes formula_times(const VolumeMesh& mesh) {
  return mesh.topology().cell_nodes(0).size() == 4 ? times_of<4>(mesh) : times_of<8>(mesh);
}

}  // namespace smoothfem::bench
