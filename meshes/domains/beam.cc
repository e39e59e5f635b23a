// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmsh.h>

#include <cmath>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/gmsh_tetrahedra.h"
#include "meshes/tools/tensor_grid.h"

namespace smoothfem {
namespace {

/// The axis is that of x. The section is a square with its centre on the axis.
constexpr double length = 6.0, half_width = 0.5;
constexpr int edges_a_width = 8;  ///< with edge scale 1

/// Returns n + 1 equal steps of a range.
std::vector<double> planes(double first, double last, int n) {
  std::vector<double> at;
  for (int i = 0; i <= n; ++i) at.push_back(std::lerp(first, last, i / double(n)));
  return at;
}

/// Names the two ends and the four sides of the boundary.
Mesh<3> with_named_ends(const Mesh<3>& mesh) {
  enum Tag { held = 1, loaded, sides };
  MeshLabels labels;
  labels.names = {{{2, held}, "held"}, {{2, loaded}, "loaded"}, {{2, sides}, "sides"}};
  labels.facets = mesh.topology().boundary_facets();
  for (std::size_t f = 0; f < labels.facets.size(); ++f) {
    const auto facet = labels.facets[f];
    double x = 0.0;
    for (const NodeIndex node : facet) x += mesh.coordinates()[node].x();
    const double along = x / static_cast<double>(facet.size()) / length;
    constexpr double rounding = 1e-9;
    labels.facet_tags.push_back(along < rounding ? held : along > 1.0 - rounding ? loaded : sides);
  }
  auto topology = std::make_shared<const Topology>(3, mesh.n_nodes(), mesh.topology().cells(),
                                                   std::nullopt, std::move(labels));
  return {std::move(topology), mesh.copied_coordinates()};
}

AnyMesh generate(const DomainParameters& p) {
  const std::string name = "beam";
  constexpr int largest_edge_scale = 4;
  require_edge_scale(name, p.edge_scale, largest_edge_scale);
  const int n = static_cast<int>(std::lround(edges_a_width / p.edge_scale));
  const auto across = planes(-half_width, half_width, n);
  VolumeCells cells =
      p.elements == "hexahedra"
          ? tensor_grid({planes(0.0, length, static_cast<int>(length) * n), across, across})
          : mesh_with_tetrahedra("the " + name, [&](GmshSession& session) {
              const double width = 2.0 * half_width;
              gmsh::model::occ::addBox(0.0, -half_width, -half_width, length, width, width);
              gmsh::model::occ::synchronize();
              set_edge_length(session, width / n);
            });
  return with_named_ends(mesh_of(std::move(cells), "generated " + name));
}

const RegisteredDomain beam(
    {.name = "beam",
     .description = "beam of length 6 with a unit square section, 8 edges across, and the groups "
                    "held, loaded and sides of its boundary",
     .dimension = 3,
     .elements = {"tetrahedra", "hexahedra"},
     .has_groups = true,
     .make = generate});

}  // namespace
}  // namespace smoothfem
