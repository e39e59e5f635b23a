// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/curved_cells.h"

#include <algorithm>
#include <array>

#include "smoothing/mesh/volume_elements.h"
#include "smoothing/second_order/transfinite.h"

namespace smoothfem {

namespace {

using Place = std::vector<std::size_t>;

bool contains(const Place& place, const Place& part) {
  return std::includes(place.begin(), place.end(), part.begin(), part.end());
}

}  // namespace

std::size_t MappingPoints::find(const Place& place) const {
  return static_cast<std::size_t>(std::find(places.begin(), places.end(), place) - places.begin());
}

MappingPoints mapping_points(int dim, std::size_t n_vertices, bool curved) {
  MappingPoints points;
  auto& places = points.places;
  for (std::size_t v = 0; v < n_vertices; ++v) places.push_back({v});
  points.substitutes.resize(n_vertices);
  if (!curved) return points;
  const auto add = [&](Place place) {
    for (std::size_t& v : place) v = deal_ii_position(dim, n_vertices, v);
    std::sort(place.begin(), place.end());
    auto& sum = points.substitutes.emplace_back();
    const TransfiniteWeights transfinite = transfinite_weights(place.size());
    const std::array weights{transfinite.corners, transfinite.edges, transfinite.faces};
    constexpr std::array<std::size_t, 3> n_of_parts{1, 2, 4};
    for (std::size_t kind = 0; kind < n_of_parts.size(); ++kind) {
      if (weights[kind] == 0.0) continue;
      std::vector<std::size_t> parts;
      for (std::size_t k = 0; k < places.size(); ++k)
        if (places[k].size() == n_of_parts[kind] && contains(place, places[k])) parts.push_back(k);
      for (const std::size_t part : parts)
        sum.emplace_back(part, weights[kind] / static_cast<double>(parts.size()));
    }
    places.push_back(std::move(place));
  };
  if (dim > 1) for_each_edge(dim, n_vertices, [&](std::size_t a, std::size_t b) { add({a, b}); });
  if (dim == 3)
    for_each_quadrilateral_face(n_vertices, [&](const LocalFace& face) {
      add({face.nodes.begin(), face.nodes.end()});
    });
  if (dim < 3 || n_vertices == 8) {
    Place all(n_vertices);
    for (std::size_t v = 0; v < n_vertices; ++v) all[v] = v;
    add(std::move(all));
  }
  return points;
}

}  // namespace smoothfem
