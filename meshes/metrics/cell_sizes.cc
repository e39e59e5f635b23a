// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/metrics/cell_sizes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "meshes/metrics/metric.h"
#include "smoothing/base/parallel.h"
#include "smoothing/geometry/cell_size.h"

namespace smoothfem {

namespace {

template <int dim, int spacedim>
std::vector<double> signed_sizes(const Mesh<dim, spacedim>& mesh) {
  const auto& blocks = mesh.topology().blocks();
  std::vector<double> sizes(mesh.n_cells());
  parallel_for(blocks.size(), [&](std::size_t b) {
    for (CellIndex c = blocks[b].first; c < blocks[b].last; ++c)
      sizes[c] = signed_cell_size(mesh, c);
  });
  return sizes;
}

/// A facet of one of its cells.
struct SortedFacet {
  std::array<NodeIndex, 4> nodes;  ///< ascending, so that both cells have the same
  CellIndex cell;

  auto operator<=>(const SortedFacet&) const = default;
};

SortedFacet sorted_facet(CellIndex cell, std::span<const NodeIndex> nodes, const auto& local) {
  SortedFacet facet{{}, cell};
  facet.nodes.fill(std::numeric_limits<NodeIndex>::max());
  std::size_t n = 0;
  for (const std::size_t k : local) facet.nodes[n++] = nodes[k];
  std::sort(facet.nodes.begin(), facet.nodes.end());
  return facet;
}

/// Returns the facets of all cells, sorted so that the two of a facet are adjacent.
std::vector<SortedFacet> sorted_facets(const Topology& topology) {
  std::vector<SortedFacet> facets;
  facets.reserve(2 * topology.n_facets());
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const auto nodes = topology.cell_nodes(c);
    if (topology.dimension() == 3)
      for (const LocalFace& face : volume_element(nodes.size()).faces)
        facets.push_back(sorted_facet(c, nodes, face.indices()));
    else
      for (std::size_t k = 0; k < nodes.size(); ++k)
        facets.push_back(sorted_facet(c, nodes, std::array{k, (k + 1) % nodes.size()}));
  }
  std::sort(facets.begin(), facets.end());
  return facets;
}

double ratio(double a, double b) {
  const double larger = std::max(std::abs(a), std::abs(b));
  const double smaller = std::min(std::abs(a), std::abs(b));
  return larger < infinite_metric * smaller ? larger / smaller : infinite_metric;
}

}  // namespace

template <int dim, int spacedim>
std::vector<double> relative_sizes_squared(const Mesh<dim, spacedim>& mesh) {
  constexpr std::size_t n_types = static_cast<std::size_t>(ElementType::hexahedron) + 1;
  const Topology& topology = mesh.topology();
  const auto type_of = [&](CellIndex c) { return static_cast<std::size_t>(topology.cell_type(c)); };
  std::vector<double> values = signed_sizes(mesh);
  std::array<double, n_types> sums{}, counts{};
  for (CellIndex c = 0; c < values.size(); ++c) {
    sums[type_of(c)] += std::abs(values[c]);
    counts[type_of(c)] += 1.0;
  }
  for (CellIndex c = 0; c < values.size(); ++c) {
    const double mean = sums[type_of(c)] / counts[type_of(c)];
    const double least = values[c] > 0.0 ? 1.0 / ratio(values[c], mean) : 0.0;
    values[c] = least * least;
  }
  return values;
}

template <int dim, int spacedim>
std::vector<double> size_gradations(const Mesh<dim, spacedim>& mesh) {
  const std::vector<double> sizes = signed_sizes(mesh);
  const std::vector<SortedFacet> facets = sorted_facets(mesh.topology());
  std::vector<double> values(mesh.n_cells(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t f = 1; f < facets.size(); ++f) {
    const SortedFacet &a = facets[f - 1], &b = facets[f];
    if (a.nodes != b.nodes) continue;
    const double between = ratio(sizes[a.cell], sizes[b.cell]);
    for (const CellIndex c : {a.cell, b.cell}) values[c] = std::fmax(values[c], between);
  }
  return values;
}

#define SMOOTHFEM_INSTANTIATE(...)                                               \
  template std::vector<double> relative_sizes_squared(const Mesh<__VA_ARGS__>&); \
  template std::vector<double> size_gradations(const Mesh<__VA_ARGS__>&);
SMOOTHFEM_INSTANTIATE(2, 2)
SMOOTHFEM_INSTANTIATE(3, 3)
SMOOTHFEM_INSTANTIATE(2, 3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
