// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "meshes/domains/catalogue.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {

/// Expects a valid mesh in which exactly the boundary nodes are fixed.
template <int dim>
void expect_valid(const Mesh<dim>& mesh) {
  EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    ASSERT_EQ(mesh.topology().is_fixed(i), mesh.topology().on_boundary()[i]) << i;
}

/// Returns the numbers of nodes - edges + facets - volume cells.
template <int dim, int spacedim>
long euler_characteristic(const Mesh<dim, spacedim>& mesh) {
  const Topology& topology = mesh.topology();
  const long n = static_cast<long>(mesh.n_nodes()) - static_cast<long>(topology.n_edges());
  if (dim == 2) return n + static_cast<long>(mesh.n_cells());
  return n + static_cast<long>(topology.n_facets()) - static_cast<long>(mesh.n_cells());
}

/// Returns the volume by the divergence theorem from the boundary facets. It is independent of the
/// cells and differs from their sum if cells overlap or leave gaps.
inline double volume_inside(const VolumeMesh& mesh) {
  double six_times = 0.0;
  const auto& facets = mesh.topology().boundary_facets();
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto point = [&](std::size_t k) { return mesh.coordinates()[facets[f][k]]; };
    for (std::size_t k = 2; k < facets[f].size(); ++k)
      six_times += point(0).dot(point(k - 1).cross(point(k)));
  }
  return six_times / 6.0;
}

/// Numbers of cells that use a node: extremes and mean over all nodes, and the fraction of inner
/// nodes whose number is not `regular`.
struct Adjacency {
  std::size_t least = 1000, most = 0;
  double mean = 0.0, irregular_fraction = 0.0;
};

template <int dim, int spacedim>
Adjacency adjacency(const Mesh<dim, spacedim>& mesh, std::size_t regular) {
  Adjacency result;
  std::size_t n_inner = 0, n_irregular = 0;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    const std::size_t n = mesh.topology().node_cells(i).size();
    result.least = std::min(result.least, n);
    result.most = std::max(result.most, n);
    result.mean += static_cast<double>(n) / static_cast<double>(mesh.n_nodes());
    if (mesh.topology().on_boundary()[i]) continue;
    ++n_inner;
    n_irregular += n != regular;
  }
  result.irregular_fraction = static_cast<double>(n_irregular) / static_cast<double>(n_inner);
  return result;
}

/// Expects that edge scales outside of the range are refused, with the range in the message.
inline void expect_edge_scales(const std::string& domain, int most) {
  for (const double scale : {0.99, most + 0.01, std::nan("")})
    EXPECT_THAT(input_error_of([&] { find_domain(domain).generate({.edge_scale = scale}); }),
                ::testing::HasSubstr(most > 1 ? "between 1 and " + std::to_string(most)
                                              : std::string("must be 1, as it has one size only")))
        << domain;
}

template <int dim>
Mesh<dim> mesh_of_domain(const std::string& domain, const DomainParameters& parameters = {}) {
  return std::get<Mesh<dim>>(find_domain(domain).generate(parameters));
}

}  // namespace smoothfem
