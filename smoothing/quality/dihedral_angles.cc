// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/quality/dihedral_angles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "smoothing/base/parallel.h"
#include "smoothing/geometry/extreme_size.h"
#include "smoothing/mesh/volume_elements.h"
#include "smoothing/quality/warpage.h"

namespace smoothfem {

namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

/// Grows with every angle; in degrees.
struct Extremes {
  double min = std::numeric_limits<double>::infinity(), max = -min;

  void add(double angle) {
    min = std::min(min, angle);
    max = std::max(max, angle);
  }
  void add(const Extremes& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
  }
};

/// add(cell, extremes) for every cell; smallest and largest do not depend on the order.
template <class Add>
AngleRange range_over_cells(const Topology& topology, const Add& add) {
  std::vector<Extremes> parts(topology.blocks().size());
  parallel_for(parts.size(), [&](std::size_t b) {
    const CellBlock& block = topology.blocks()[b];
    for (CellIndex c = block.first; c < block.last; ++c) add(topology.cell_nodes(c), parts[b]);
  });
  Extremes all;
  for (const Extremes& part : parts) all.add(part);
  return {all.min, all.max};
}

/// An edge of an element with its two faces; the first one runs from `from` to `to`.
struct EdgeFaces {
  LocalIndex from, to;
  std::size_t first, second;
};

bool has_side(const LocalFace& face, LocalIndex from, LocalIndex to) {
  for (std::size_t k = 0; k < face.size; ++k)
    if (face.nodes[k] == from && face.nodes[k + 1 == face.size ? 0 : k + 1] == to) return true;
  return false;
}

std::vector<EdgeFaces> make_edge_faces(const VolumeElementTables& element) {
  std::vector<EdgeFaces> result;
  for (const auto& [a, b] : element.edges) {
    EdgeFaces edge{a, b, 0, 0};
    for (std::size_t f = 0; f < element.faces.size(); ++f) {
      if (has_side(element.faces[f], a, b)) edge.first = f;
      if (has_side(element.faces[f], b, a)) edge.second = f;
    }
    result.push_back(edge);
  }
  return result;
}

const std::vector<EdgeFaces>& edge_faces(std::size_t n_nodes) {
  static const std::array<std::vector<EdgeFaces>, 9> tables = [] {
    std::array<std::vector<EdgeFaces>, 9> result;
    for (const std::size_t n : {4, 5, 6, 8}) result[n] = make_edge_faces(volume_element(n));
    return result;
  }();
  return tables[n_nodes];
}

/// Twice the area vector, outwards.
Point<3> area_vector(std::span<const Point<3>> x, std::span<const NodeIndex> nodes,
                     const LocalFace& face) {
  const auto p = [&](std::size_t k) -> const Point<3>& { return x[nodes[face.nodes[k]]]; };
  if (face.size == 3) return (p(1) - p(0)).cross(p(2) - p(0));
  return (p(2) - p(0)).cross(p(3) - p(1));
}

}  // namespace

AngleRange angle_range(const PlanarMesh& mesh) {
  const auto& x = mesh.coordinates();
  return range_over_cells(
      mesh.topology(), [&](std::span<const NodeIndex> nodes, Extremes& extremes) {
        const std::size_t n = nodes.size();
        for (std::size_t k = 0; k < n; ++k) {
          const Point<2> next = x[nodes[(k + 1) % n]] - x[nodes[k]];
          const Point<2> previous = x[nodes[(k + n - 1) % n]] - x[nodes[k]];
          const double angle = degrees * std::atan2(cross(next, previous), next.dot(previous));
          extremes.add(angle < 0.0 ? angle + 360.0 : angle);
        }
      });
}

AngleRange angle_range(const VolumeMesh& mesh) {
  std::vector<Point<3>> scaled;
  const auto x = at_ordinary_size(mesh.coordinates(), scaled);
  return range_over_cells(
      mesh.topology(), [&](std::span<const NodeIndex> nodes, Extremes& extremes) {
        const auto& faces = volume_element(nodes.size()).faces;
        std::array<Point<3>, 6> normals;
        for (std::size_t f = 0; f < faces.size(); ++f) normals[f] = area_vector(x, nodes, faces[f]);
        for (const auto& [from, to, first, second] : edge_faces(nodes.size())) {
          // Between the outward normals; positive where the cell is convex.
          const Point<3> edge = (x[nodes[to]] - x[nodes[from]]).stableNormalized();
          const Point<3>&a = normals[first], &b = normals[second];
          extremes.add(180.0 - degrees * std::atan2(a.cross(b).dot(edge), a.dot(b)));
        }
      });
}

MeshWarpage mesh_warpage(const VolumeMesh& mesh) {
  std::vector<Point<3>> scaled;
  const auto x = at_ordinary_size(mesh.coordinates(), scaled);
  double sum = 0.0;
  std::size_t n = 0;
  MeshWarpage result;
  const auto add = [&](const auto& node_of) {
    const std::array<Vector3<double>, 4> corners{vector_of(x[node_of(0)]), vector_of(x[node_of(1)]),
                                                 vector_of(x[node_of(2)]),
                                                 vector_of(x[node_of(3)])};
    const double warpage = face_warpage(std::span<const Vector3<double>, 4>(corners));
    result.max = std::max(result.max, warpage);
    sum += warpage;
    ++n;
  };
  // Every inner face comes twice, from its two cells; so boundary faces are added once more.
  const Topology& topology = mesh.topology();
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const auto nodes = topology.cell_nodes(c);
    for (const LocalFace& face : volume_element(nodes.size()).faces)
      if (face.size == 4) add([&](std::size_t k) { return nodes[face.nodes[k]]; });
  }
  const auto& boundary = topology.boundary_facets();
  for (std::size_t f = 0; f < boundary.size(); ++f)
    if (boundary[f].size() == 4) add([&](std::size_t k) { return boundary[f][k]; });
  result.n_faces = n / 2;
  if (n > 0) result.mean = sum / static_cast<double>(n);
  return result;
}

}  // namespace smoothfem
