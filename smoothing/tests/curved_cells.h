// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "smoothing/mesh/midside_nodes.h"
#include "smoothing/second_order/shape_functions.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {

inline std::string name_of(const SecondOrderType& type) {
  constexpr const char* planar[] = {"TRI", "QUAD"};
  constexpr const char* volume[] = {"TET", "PYRAMID", "PRISM", "", "HEX"};
  return (type.dim == 2 ? planar[type.n_corners - 3] : volume[type.n_corners - 4]) +
         std::to_string(type.n_nodes);
}
inline void PrintTo(const SecondOrderType& type, std::ostream* out) {
  *out << name_of(type);
}

namespace test {

/// The first coordinates of points.
template <int dim>
std::vector<Point<dim>> in_dimension(const std::vector<Point<3>>& points) {
  std::vector<Point<dim>> result;
  for (const auto& point : points) result.emplace_back(point.template head<dim>());
  return result;
}

/// The reference element: all coordinates are in [0, 1].
template <int dim>
std::vector<Point<dim>> reference_cell(const SecondOrderType& type) {
  return in_dimension<dim>(shape_functions(type.dim, type.n_nodes).nodes());
}

/// The reference element with all coordinates moved by up to `radius`.
template <int dim>
std::vector<Point<dim>> random_cell(const SecondOrderType& type, double radius, Random& random) {
  auto points = reference_cell<dim>(type);
  for (auto& point : points)
    for (int d = 0; d < dim; ++d) point[d] += radius * random();
  return points;
}

/// A cell with straight edges between these corners, and flat or bilinear faces: its midside nodes
/// are in the middle.
template <int dim>
std::vector<Point<dim>> straight_cell(const SecondOrderType& type,
                                      std::vector<Point<dim>> corners) {
  const std::size_t n = type.n_corners;
  const auto counts = midside_counts(dim, n, type.n_nodes - n);
  auto points = corners;
  for_each_edge(dim, n, [&](std::size_t a, std::size_t b) {
    points.push_back(0.5 * (corners[a] + corners[b]));
  });
  if (counts.faces > 0)
    for_each_quadrilateral_face(n, [&](const LocalFace& face) {
      Point<dim> sum = Point<dim>::Zero();
      for (const auto k : face.indices()) sum += corners[k];
      points.push_back(0.25 * sum);
    });
  if (counts.cell > 0) {
    Point<dim> sum = Point<dim>::Zero();
    for (const auto& corner : corners) sum += corner;
    points.push_back(sum / static_cast<double>(n));
  }
  return points;
}

/// A straight cell whose corners are those of the reference element, moved by up to `radius`.
template <int dim>
std::vector<Point<dim>> random_straight_cell(const SecondOrderType& type, double radius,
                                             Random& random) {
  auto corners = random_cell<dim>(type, radius, random);
  corners.resize(type.n_corners);
  return straight_cell(type, std::move(corners));
}

/// Points of the reference element: all corners, and random points inside.
inline std::vector<Point<3>> reference_samples(const SecondOrderType& type, std::size_t n_inside,
                                               Random& random) {
  const ShapeFunctions& functions = shape_functions(type.dim, type.n_nodes);
  std::vector<Point<3>> samples(functions.nodes().begin(),
                                functions.nodes().begin() + static_cast<int>(type.n_corners));
  for (std::size_t i = 0; i < n_inside; ++i) {  // convex combinations of the corners
    Point<3> sum = Point<3>::Zero();
    double sum_of_weights = 0.0;
    for (std::size_t k = 0; k < type.n_corners; ++k) {
      const double weight = std::pow(0.5 + 0.5 * random(), 4);  // also close to the boundary
      sum += weight * samples[k];
      sum_of_weights += weight;
    }
    samples.emplace_back(sum / sum_of_weights);
  }
  return samples;
}

/// The gradients of the shape functions at points.
using Gradients = std::vector<std::vector<Point<3>>>;
inline Gradients gradients_at(const SecondOrderType& type, const std::vector<Point<3>>& points) {
  Gradients gradients;
  for (const auto& x : points)
    gradients.push_back(shape_functions(type.dim, type.n_nodes).gradients(x));
  return gradients;
}

/// det J from the gradients of the shape functions at a point. (Not by matrices of Eigen, which are
/// slow in tests.)
template <int dim>
double jacobian(const std::vector<Point<dim>>& nodes, const std::vector<Point<3>>& gradients) {
  double j[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int c = 0; c < dim; ++c)
    for (int d = 0; d < dim; ++d) {
      j[c][d] = 0.0;
      for (std::size_t k = 0; k < nodes.size(); ++k)
        j[c][d] += nodes[k].data()[c] * gradients[k].data()[d];
    }
  return j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1]) -
         j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0]) +
         j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]);
}

}  // namespace test
}  // namespace smoothfem
