// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/delaunay.h"

#include <gmsh.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>

#include "meshes/tools/gmsh_session.h"
#include "smoothing/quality/mean_ratio.h"

namespace smoothfem {

VolumeCells delaunay_mesh(
    std::vector<Point<3>> nodes, const std::string& name,
    const std::function<bool(const Point<3>& centre, double quality)>& keeps) {
  std::vector<double> xyz;
  for (const auto& p : nodes) xyz.insert(xyz.end(), p.begin(), p.end());
  std::vector<std::size_t> corners;
  const GmshSession session;
  session.run(name + " cannot be meshed", [&] { gmsh::model::mesh::tetrahedralize(xyz, corners); });
  VolumeCells mesh{std::move(nodes), {}};
  // The order of Gmsh's cells and of their nodes changes from run to run.
  std::vector<std::array<NodeIndex, 4>> rows(corners.size() / 4);
  for (std::size_t k = 0; k < corners.size(); ++k)
    rows[k / 4][k % 4] = static_cast<NodeIndex>(corners[k] - 1);
  for (auto& row : rows) std::sort(row.begin(), row.end());
  std::sort(rows.begin(), rows.end());
  for (auto& row : rows) {
    const auto at = [&](std::size_t l) -> const Point<3>& { return mesh.coordinates[row[l]]; };
    if ((at(1) - at(0)).cross(at(2) - at(0)).dot(at(3) - at(0)) < 0.0) std::swap(row[2], row[3]);
    std::array<Vector3<double>, 4> corners_of_cell;
    Point<3> centre = Point<3>::Zero();
    for (std::size_t l = 0; l < 4; ++l) {
      corners_of_cell[l] = vector_of(at(l));
      centre += 0.25 * at(l);
    }
    if (keeps(centre, mean_ratio(std::span<const Vector3<double>, 4>(corners_of_cell))))
      mesh.cells.append(row);
  }
  return mesh;
}

}  // namespace smoothfem
