// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "meshes/domains/flange.h"
#include "meshes/tests/domain_tests.h"
#include "smoothing/mesh/volume_elements.h"

namespace smoothfem {

/// Nodes, edges and faces of some facets, counted by their sets of nodes.
class IncidenceCount {
 public:
  void add_facet(const std::vector<NodeIndex>& nodes) {
    Face face;
    face.fill(-1);
    std::copy(nodes.begin(), nodes.end(), face.begin());
    std::sort(face.begin(), face.end());
    faces_.push_back(face);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      nodes_.push_back(nodes[k]);
      edges_.push_back(std::minmax(nodes[k], nodes[(k + 1) % nodes.size()]));
    }
  }
  long euler_characteristic() {
    return n_different(nodes_) - n_different(edges_) + n_different(faces_);
  }

 private:
  using Face = std::array<std::int64_t, 4>;

  template <class Item>
  static long n_different(std::vector<Item>& items) {
    std::sort(items.begin(), items.end());
    items.erase(std::unique(items.begin(), items.end()), items.end());
    return static_cast<long>(items.size());
  }

  std::vector<NodeIndex> nodes_;
  std::vector<std::pair<NodeIndex, NodeIndex>> edges_;
  std::vector<Face> faces_;
};

inline void expect_genus_nine(const VolumeMesh& mesh) {
  const Topology& topology = mesh.topology();
  IncidenceCount surface, volume;
  for (std::size_t f = 0; f < topology.boundary_facets().size(); ++f) {
    const auto facet = topology.boundary_facets()[f];
    surface.add_facet({facet.begin(), facet.end()});
  }
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = topology.cell_nodes(c);
    for_each_facet(3, nodes.size(), [&](const auto& positions) {
      std::vector<NodeIndex> facet;
      for (const auto k : positions) facet.push_back(nodes[k]);
      volume.add_facet(facet);
    });
  }
  EXPECT_EQ(surface.euler_characteristic(), -16);
  EXPECT_EQ(volume.euler_characteristic() - static_cast<long>(mesh.n_cells()), -8);
}

/// Distance of a point from the nearest of the flange's planes and cylinders.
inline double distance_from_surfaces(const Point<3>& p) {
  using Shape = FlangeShape;
  const double r = std::hypot(p.x(), p.y());
  double distance = std::min(std::abs(p.z()), std::abs(r - Shape::bore_radius));
  const double side = p.z() > Shape::disc_height ? Shape::hub_radius : Shape::radius;
  distance = std::min(distance, std::abs(r - side));
  const double top = r > Shape::hub_radius - 1e-9 ? Shape::disc_height : Shape::height;
  distance = std::min(distance, std::abs(p.z() - top));
  for (int i = 0; i < Shape::n_bolts && p.z() <= Shape::disc_height; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / Shape::n_bolts;
    const double x = p.x() - Shape::bolt_circle_radius * std::cos(angle);
    const double y = p.y() - Shape::bolt_circle_radius * std::sin(angle);
    distance = std::min(distance, std::abs(std::hypot(x, y) - Shape::bolt_radius));
  }
  return distance;
}

inline double analytic_volume() {
  using Shape = FlangeShape;
  const auto square = [](double x) { return x * x; };
  const double ring = square(Shape::radius) - square(Shape::bore_radius) -
                      Shape::n_bolts * square(Shape::bolt_radius);
  const double hub = square(Shape::hub_radius) - square(Shape::bore_radius);
  return std::numbers::pi *
         (ring * Shape::disc_height + hub * (Shape::height - Shape::disc_height));
}

/// Checks properties of every mesh of the flange. n_cells: met within the fraction `tolerance`.
/// volume_error: effect of flat facets instead of round ones, as a fraction.
inline void expect_flange(const VolumeMesh& mesh, ElementType type, double n_cells,
                          double tolerance, double volume_error) {
  EXPECT_NEAR(static_cast<double>(mesh.n_cells()), n_cells, tolerance * n_cells);
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_EQ(quality.n_invalid, 0u);
  EXPECT_GT(quality.q_min, 0.05);
  const Topology& topology = mesh.topology();
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) ASSERT_EQ(topology.cell_type(c), type);
  Point<3> low = mesh.coordinates()[0], high = low;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    const Point<3>& point = mesh.coordinates()[i];
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
    ASSERT_EQ(topology.is_fixed(i), topology.on_boundary()[i]);
    if (topology.on_boundary()[i]) {
      ASSERT_LT(distance_from_surfaces(point), 1e-9);
    }
  }
  EXPECT_LT((low - Point<3>(-8, -8, 0)).norm(), 1e-12);
  EXPECT_LT((high - Point<3>(8, 8, 9)).norm(), 1e-12);
  EXPECT_NEAR(volume_inside(mesh) / analytic_volume(), 1.0, volume_error);
  expect_genus_nine(mesh);
}

}  // namespace smoothfem
