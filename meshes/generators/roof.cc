#include "meshes/generators/roof.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "meshes/generators/mesh_cells.h"
#include "smoothing/surface/node_constraints.h"

namespace smoothfem {

namespace {

/// The plan as a grid of squares: those of the frames are left out. With lengths of a square's
/// side.
class Plan {
 public:
  explicit Plan(double edge_scale) : edge_(edge_scale) {
    const auto count = [&](int n) { return static_cast<int>(std::lround(n / edge_scale)); };
    // Of the few grids with two such holes that have the numbers of the thesis.
    size_ = {count(172), count(140)};
    frame_ = {std::max(count(18), 1), std::max(count(39), 1)};
    first_[0] = {size_[0] / 4 - frame_[0] / 2, (size_[1] - frame_[1]) / 2};
    first_[1] = {size_[0] - first_[0][0] - frame_[0], first_[0][1]};
  }

  int size(int d) const { return size_[d]; }
  bool has_square(int i, int j) const {
    return std::none_of(first_.begin(), first_.end(), [&](const auto& first) {
      return i >= first[0] && i < first[0] + frame_[0] && j >= first[1] && j < first[1] + frame_[1];
    });
  }

  Point<3> place(int i, int j) const {
    constexpr double sag = 0.03;
    const Point<2> p = edge_ * Point<2>(i - 0.5 * size_[0], j - 0.5 * size_[1]);
    const double u = 2.0 * i / size_[0] - 1.0, v = 2.0 * j / size_[1] - 1.0;
    return {p.x() * (1.0 - sag * (1.0 - v * v)), p.y() * (1.0 - sag * (1.0 - u * u)), height(i, j)};
  }

 private:
  /// Like a soap film drawn up to the frames. Both numbers are such that the mesh has the lowest
  /// and the mean quality of the thesis.
  double height(int i, int j) const {
    constexpr double steepness = 4.5, rounding = 0.22;
    double sum = 0.0;
    for (const auto& first : first_)
      sum -= std::log((distance({i, j}, first) + rounding) / (edge_ * size_[0]));
    return steepness * sum;
  }

  /// From a frame, in plan.
  double distance(const std::array<int, 2>& node, const std::array<int, 2>& first) const {
    double square = 0.0;
    for (const int d : {0, 1}) {
      const int outside = std::max({first[d] - node[d], node[d] - first[d] - frame_[d], 0});
      square += outside * outside;
    }
    return edge_ * std::sqrt(square);
  }

  double edge_;
  std::array<int, 2> size_, frame_;
  std::array<std::array<int, 2>, 2> first_;  ///< lower corners of the frames
};

}  // namespace

SurfaceMesh generate_roof(double edge_scale) {
  require_edge_scale("roof", edge_scale, 4);
  constexpr NodeIndex none = std::numeric_limits<NodeIndex>::max();
  const Plan plan(edge_scale);
  const std::size_t n_rows = plan.size(1) + 1;
  std::vector<NodeIndex> nodes((plan.size(0) + 1) * n_rows, none);
  MeshCells<3> mesh;
  const auto node_at = [&](int i, int j) {
    NodeIndex& node = nodes[i * n_rows + j];
    if (node == none) {
      node = static_cast<NodeIndex>(mesh.coordinates.size());
      mesh.coordinates.push_back(plan.place(i, j));
    }
    return node;
  };
  for (int i = 0; i < plan.size(0); ++i)
    for (int j = 0; j < plan.size(1); ++j)
      if (plan.has_square(i, j))
        mesh.cells.append(
            std::array{node_at(i, j), node_at(i + 1, j), node_at(i + 1, j + 1), node_at(i, j + 1)});
  // Cells at the frames' corners turn by 45 degrees, and are no features.
  return make_surface_mesh(std::move(mesh.cells), std::move(mesh.coordinates), {}, {},
                           {.angle_degrees = 60.0});
}

}  // namespace smoothfem
