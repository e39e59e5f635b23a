// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/quality/cell_targets.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "smoothing/base/option_text.h"
#include "smoothing/simd/cells.h"
#include "smoothing/transformations/scaling.h"

namespace smoothfem {

namespace {

/// Returns the nodes of a regular element of any size.
template <int dim>
std::vector<Point<dim>> regular_nodes(std::size_t n) {
  using std::numbers::pi, std::numbers::sqrt3;
  std::vector<Point<dim>> nodes;
  if constexpr (dim == 2) {
    for (std::size_t k = 0; k < n; ++k) {
      const double angle = 2.0 * pi * static_cast<double>(k) / static_cast<double>(n);
      nodes.emplace_back(std::cos(angle), std::sin(angle));
    }
  } else {
    const std::vector<Point<3>> triangle{{0, 0, 0}, {1, 0, 0}, {0.5, 0.5 * sqrt3, 0}},
        square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    nodes = n == 4 || n == 6 ? triangle : square;
    if (n == 4) nodes.emplace_back(0.5, sqrt3 / 6.0, std::sqrt(2.0 / 3.0));
    if (n == 5) nodes.emplace_back(0.5, 0.5, std::sqrt(0.5));
    const std::size_t n_base = nodes.size();
    for (std::size_t k = 0; k < n_base && n >= 6; ++k)
      nodes.emplace_back(nodes[k] + Point<3>::UnitZ());
  }
  return nodes;
}

/// Returns the mean node simplex of a cell.
template <int dim>
double size_of(const std::vector<Point<dim>>& corners) {
  std::vector<NodeIndex> all(corners.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<NodeIndex>(k);
  double size = 0.0;
  with_corners<dim>(all, corners.data(), [&](auto x) { size = node_simplex_size<dim>(x); });
  return size;
}

/// Returns the linear map from the regular element that is closest to a cell (least squares).
template <int dim>
typename CellTargets<dim>::Matrix closest_map(const std::vector<Point<dim>>& corners) {
  using Matrix = typename CellTargets<dim>::Matrix;
  const auto regular = regular_nodes<dim>(corners.size());
  const double n = static_cast<double>(corners.size());
  Point<dim> centre = Point<dim>::Zero(), regular_centre = Point<dim>::Zero();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    centre += corners[k] / n;
    regular_centre += regular[k] / n;
  }
  Matrix both = Matrix::Zero(), of_regular = Matrix::Zero();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Point<dim> r = regular[k] - regular_centre;
    both += (corners[k] - centre) * r.transpose();
    of_regular += r * r.transpose();
  }
  return both * of_regular.inverse();
}

template <int dim>
typename CellTargets<dim>::Matrix target_of(const std::vector<Point<dim>>& corners,
                                            TargetKind kind) {
  using Matrix = typename CellTargets<dim>::Matrix;
  const auto root = [](double size) { return dim == 2 ? std::sqrt(size) : std::cbrt(size); };
  if (kind == TargetKind::size) return root(size_of<dim>(corners)) * Matrix::Identity();
  const Matrix map = closest_map<dim>(corners);
  const Matrix inverse = map.inverse();
  std::vector<Point<dim>> seen;
  for (const Point<dim>& corner : corners) seen.emplace_back(inverse * corner);
  return root(size_of<dim>(seen)) * map;
}

}  // namespace

template <int dim>
CellTargets<dim>::CellTargets(const std::vector<Matrix>& maps, double size_bound)
    : size_bound_(size_bound) {
  const auto entries = [](const Matrix& matrix) {
    Entries result;
    std::copy(matrix.data(), matrix.data() + matrix.size(), result.begin());
    return result;
  };
  for (const Matrix& map : maps) {
    to_target_.push_back(entries(map));
    to_regular_.push_back(entries(map.inverse()));
  }
}

template <int dim>
std::shared_ptr<const CellTargets<dim>> targets_of(const Mesh<dim>& reference, TargetKind kind,
                                                   double size_bound) {
  std::vector<typename CellTargets<dim>::Matrix> maps;
  maps.reserve(reference.n_cells());
  std::vector<Point<dim>> corners;
  for (CellIndex c = 0; c < reference.n_cells(); ++c) {
    corners.clear();
    for (const NodeIndex i : reference.topology().cell_nodes(c))
      corners.push_back(reference.coordinates()[i]);
    const auto map = size_of<dim>(corners) > 0.0 ? target_of<dim>(corners, kind)
                                                 : CellTargets<dim>::Matrix::Zero();
    if (!map.allFinite() || !(map.determinant() > 0.0))
      throw InputError("cell " + std::to_string(reference.topology().labels().cell_number(c)) +
                       " is invalid, so that it cannot be a target; repair the mesh (" +
                       option_text("untangle") + ")");
    maps.push_back(map);
  }
  return std::make_shared<const CellTargets<dim>>(maps, size_bound);
}

std::optional<TargetKind> initial_target(std::string_view name) {
  for (std::size_t k = 0; k < initial_target_names.size(); ++k)
    if (initial_target_names[k] == name) return static_cast<TargetKind>(k);
  return {};
}

template <int dim>
Mesh<dim> with_targets(const Mesh<dim>& mesh, std::shared_ptr<const CellTargets<dim>> targets) {
  if (targets && targets->n_cells() != mesh.n_cells())
    throw InputError("there are " + std::to_string(targets->n_cells()) + " target cells, but " +
                     std::to_string(mesh.n_cells()) +
                     " cells; the meshes must have the same cells");
  return {mesh.shared_topology(), mesh.copied_coordinates(), mesh.shared_constraints(),
          std::move(targets)};
}

#define SMOOTHFEM_INSTANTIATE(dim)                                                          \
  template class CellTargets<dim>;                                                          \
  template std::shared_ptr<const CellTargets<dim>> targets_of(const Mesh<dim>&, TargetKind, \
                                                              double);                      \
  template Mesh<dim> with_targets(const Mesh<dim>&, std::shared_ptr<const CellTargets<dim>>);
SMOOTHFEM_INSTANTIATE(2)
SMOOTHFEM_INSTANTIATE(3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
