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
#include "smoothing/geometry/cell_size.h"
#include "smoothing/geometry/extreme_size.h"
#include "smoothing/mesh/volume_elements.h"
#include "smoothing/quality/warpage.h"

namespace smoothfem {

namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

/// Range of no angles; add() extends it.
constexpr AngleRange no_angles{std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity()};

void add(AngleRange& range, const AngleRange& other) {
  range.min = std::min(range.min, other.min);
  range.max = std::max(range.max, other.max);
}
void add(AngleRange& range, double angle) {
  add(range, AngleRange{angle, angle});
}

/// Calls add_angles(nodes, range) for every cell.
template <class AddAngles>
std::vector<AngleRange> ranges_of_cells(const Topology& topology, const AddAngles& add_angles) {
  std::vector<AngleRange> ranges(topology.n_cells(), no_angles);
  parallel_for(topology.blocks().size(), [&](std::size_t b) {
    const CellBlock& block = topology.blocks()[b];
    for (CellIndex c = block.first; c < block.last; ++c)
      add_angles(topology.cell_nodes(c), ranges[c]);
  });
  return ranges;
}

/// Adds the angles from each side of a polygon, around its corner, to the side before it.
/// turn(next, previous) is the sine and next . previous the cosine, both times their lengths.
template <int spacedim, class Turn>
void add_corners(std::span<const Point<spacedim>> x, std::span<const NodeIndex> nodes,
                 const Turn& turn, AngleRange& range) {
  const std::size_t n = nodes.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Point<spacedim> next = x[nodes[(k + 1) % n]] - x[nodes[k]];
    const Point<spacedim> previous = x[nodes[(k + n - 1) % n]] - x[nodes[k]];
    const double angle = degrees * std::atan2(turn(next, previous), next.dot(previous));
    add(range, angle < 0.0 ? angle + 360.0 : angle);
  }
}

/// An edge of an element with its two faces; the first face runs from `from` to `to`.
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

std::vector<AngleRange> cell_angle_ranges(const PlanarMesh& mesh) {
  return ranges_of_cells(mesh.topology(), [&](std::span<const NodeIndex> nodes, AngleRange& range) {
    add_corners<2>(
        mesh.coordinates(), nodes,
        [](const Point<2>& next, const Point<2>& previous) { return cross(next, previous); },
        range);
  });
}

std::vector<AngleRange> cell_angle_ranges(const SurfaceMesh& mesh) {
  return ranges_of_cells(mesh.topology(), [&](std::span<const NodeIndex> nodes, AngleRange& range) {
    const Point<3> normal = facet_normal(nodes, mesh.coordinates());
    add_corners<3>(
        mesh.coordinates(), nodes,
        [&](const Point<3>& next, const Point<3>& previous) {
          return normal.dot(next.cross(previous));
        },
        range);
  });
}

std::vector<AngleRange> cell_angle_ranges(const VolumeMesh& mesh) {
  std::vector<Point<3>> scaled;
  const auto x = at_ordinary_size(mesh.coordinates(), scaled);
  return ranges_of_cells(mesh.topology(), [&](std::span<const NodeIndex> nodes, AngleRange& range) {
    const auto& faces = volume_element(nodes.size()).faces;
    std::array<Point<3>, 6> normals;
    for (std::size_t f = 0; f < faces.size(); ++f) normals[f] = area_vector(x, nodes, faces[f]);
    for (const auto& [from, to, first, second] : edge_faces(nodes.size())) {
      // Angle between the outward normals; positive where the cell is convex.
      const Point<3> edge = (x[nodes[to]] - x[nodes[from]]).stableNormalized();
      const Point<3>&a = normals[first], &b = normals[second];
      add(range, 180.0 - degrees * std::atan2(a.cross(b).dot(edge), a.dot(b)));
    }
  });
}

template <int dim>
AngleRange angle_range(const Mesh<dim>& mesh) {
  AngleRange range = no_angles;
  for (const AngleRange& of_cell : cell_angle_ranges(mesh)) add(range, of_cell);
  return range;
}
template AngleRange angle_range(const Mesh<2>&);
template AngleRange angle_range(const Mesh<3>&);

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
  // Every inner face appears twice, once for each of its cells; so boundary faces are added once
  // more.
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
