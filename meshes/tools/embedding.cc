// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/embedding.h"

#include <Eigen/Geometry>
#include <array>
#include <limits>

#include "meshes/tools/unit_vector.h"

namespace smoothfem {

CompressedRows<NodeIndex> append_pyramids(VolumeCells& mesh, const CompressedRows<NodeIndex>& bases,
                                          double height) {
  CompressedRows<NodeIndex> triangles;
  for (std::size_t b = 0; b < bases.size(); ++b) {
    const auto base = bases[b];
    const auto at = [&](std::size_t k) -> const Point<3>& { return mesh.coordinates[base[k % 4]]; };
    Point<3> centre = Point<3>::Zero();
    double edge_length = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      centre += 0.25 * at(k);
      edge_length += 0.25 * length(vector_of(Point<3>(at(k + 1) - at(k))));
    }
    const Point<3> normal = unit_vector((at(2) - at(0)).cross(at(3) - at(1)));
    const auto apex = static_cast<NodeIndex>(mesh.coordinates.size());
    mesh.coordinates.push_back(centre + height * edge_length * normal);
    mesh.cells.append(std::array<NodeIndex, 5>{base[0], base[1], base[2], base[3], apex});
    for (std::size_t k = 0; k < 4; ++k)
      triangles.append(std::array<NodeIndex, 3>{base[k], base[(k + 1) % 4], apex});
  }
  return triangles;
}

void append_tetrahedra(VolumeCells& mesh, const std::vector<CompressedRows<NodeIndex>>& surfaces,
                       double edge_length, const std::string& name, double optimization_threshold) {
  // Only the nodes of the surfaces take part; their numbers are mapped there and back.
  constexpr NodeIndex none = std::numeric_limits<NodeIndex>::max();
  std::vector<NodeIndex> own(mesh.coordinates.size(), none), back;
  std::vector<Point<3>> points;
  std::vector<CompressedRows<NodeIndex>> renumbered;
  for (const auto& surface : surfaces) {
    auto& rows = renumbered.emplace_back();
    for (std::size_t t = 0; t < surface.size(); ++t) {
      std::array<NodeIndex, 3> row{};
      for (std::size_t k = 0; k < 3; ++k) {
        const NodeIndex node = surface[t][k];
        if (own[node] == none) {
          own[node] = static_cast<NodeIndex>(points.size());
          points.push_back(mesh.coordinates[node]);
          back.push_back(node);
        }
        row[k] = own[node];
      }
      rows.append(row);
    }
  }
  const VolumeCells filling =
      fill_with_tetrahedra(name, points, renumbered, edge_length, optimization_threshold);
  for (std::size_t i = points.size(); i < filling.coordinates.size(); ++i) {
    back.push_back(static_cast<NodeIndex>(mesh.coordinates.size()));
    mesh.coordinates.push_back(filling.coordinates[i]);
  }
  for (std::size_t c = 0; c < filling.cells.size(); ++c) {
    std::array<NodeIndex, 4> row{};
    for (std::size_t k = 0; k < 4; ++k) row[k] = back[filling.cells[c][k]];
    mesh.cells.append(row);
  }
}

}  // namespace smoothfem
