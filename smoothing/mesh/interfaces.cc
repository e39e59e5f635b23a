// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/mesh/interfaces.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>

#include "smoothing/mesh/sorted_nodes.h"
#include "smoothing/mesh/volume_elements.h"

namespace smoothfem {

namespace {

std::set<std::vector<NodeIndex>> boundary_keys(const Topology& topology) {
  std::set<std::vector<NodeIndex>> keys;
  const auto& facets = topology.boundary_facets();
  for (std::size_t f = 0; f < facets.size(); ++f) keys.insert(sorted_nodes(facets[f]));
  return keys;
}

/// Returns the numbers of the labelled facets that are not facets of the boundary.
std::vector<std::size_t> inner_labelled_facets(const Topology& topology) {
  const auto& facets = topology.labels().facets;
  std::vector<std::size_t> inner;
  if (facets.empty()) return inner;
  const auto boundary = boundary_keys(topology);
  for (std::size_t f = 0; f < facets.size(); ++f)
    if (!boundary.contains(sorted_nodes(facets[f]))) inner.push_back(f);
  return inner;
}

/// Calls use(nodes) for each element that a field of this name marks with another number than 0.
template <class Use>
void for_each_marked_element(const Topology& topology, std::string_view name, const Use& use) {
  const MeshLabels& labels = topology.labels();
  for (const MeshField& field : labels.content->element_fields) {
    if (field.name != name || field.n_components != 1) continue;
    std::size_t row = 0;
    const auto visit = [&](const CompressedRows<NodeIndex>& rows) {
      for (std::size_t e = 0; e < rows.size() && row < field.n_rows(); ++e)
        if (field.number(row++) != 0.0) use(rows[e]);
    };
    visit(topology.cells());
    visit(labels.facets);
    for (int d = topology.dimension() - 1; d >= 0; --d) visit(labels.content->others[d].nodes);
  }
}

/// Sides of a facet, each with its direction: the nodes of an edge, or the edges of a face. Of two
/// facets that run alike, one has their common side in the other direction.
template <class Visit>
void for_each_directed_side(std::span<const NodeIndex> facet, const Visit& visit) {
  if (facet.size() == 2) {
    visit(std::array{facet[0], facet[0]}, false);
    visit(std::array{facet[1], facet[1]}, true);
    return;
  }
  for (std::size_t k = 0; k < facet.size(); ++k) {
    const NodeIndex a = facet[k], b = facet[k + 1 < facet.size() ? k + 1 : 0];
    visit(std::array{std::min(a, b), std::max(a, b)}, a < b);
  }
}

/// Turns facets over so that neighbours run alike. Neighbours have a side in common that no third
/// facet has. The first facet of each connected part keeps its direction.
void direct_alike(CompressedRows<NodeIndex>& facets) {
  struct Side {
    std::size_t facet;
    bool forward;
  };
  std::map<std::array<NodeIndex, 2>, std::vector<Side>> sides;
  for (std::size_t f = 0; f < facets.size(); ++f)
    for_each_directed_side(facets[f], [&](const std::array<NodeIndex, 2>& side, bool forward) {
      sides[side].push_back({f, forward});
    });
  std::vector<std::uint8_t> is_done(facets.size(), 0), is_turned(facets.size(), 0);
  for (std::size_t first = 0; first < facets.size(); ++first) {
    if (is_done[first]) continue;
    std::vector<std::size_t> front{first};
    is_done[first] = 1;
    while (!front.empty()) {
      const std::size_t f = front.back();
      front.pop_back();
      for_each_directed_side(facets[f], [&](const std::array<NodeIndex, 2>& side, bool forward) {
        const auto& both = sides.at(side);
        if (both.size() != 2) return;
        const Side& other = both[0].facet == f ? both[1] : both[0];
        if (is_done[other.facet]) return;
        is_done[other.facet] = 1;
        is_turned[other.facet] = is_turned[f] ^ static_cast<int>(other.forward == forward);
        front.push_back(other.facet);
      });
    }
  }
  CompressedRows<NodeIndex> result;
  std::vector<NodeIndex> row;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    row.assign(facets[f].begin(), facets[f].end());
    if (is_turned[f]) std::reverse(row.begin(), row.end());
    result.append(row);
  }
  facets = std::move(result);
}

}  // namespace

int MaterialNumbers::of(std::vector<int> groups) {
  std::sort(groups.begin(), groups.end());
  return numbers_.try_emplace(std::move(groups), static_cast<int>(numbers_.size())).first->second;
}

std::vector<int> cell_materials(const Topology& topology) {
  const MeshLabels& labels = topology.labels();
  const FileContent* content = labels.content.get();
  const bool has_entities = content && !content->cell_entities.empty();
  if (labels.cell_tags.empty()) return {};
  MaterialNumbers numbers;
  std::map<std::pair<int, int>, int> of_labels;
  std::vector<int> materials(topology.n_cells());
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const std::pair label(labels.cell_tags[c], has_entities ? content->cell_entities[c] : 0);
    const auto [known, is_new] = of_labels.try_emplace(label, 0);
    if (is_new)
      known->second =
          numbers.of(groups_of(content, topology.dimension(), label.second, label.first));
    materials[c] = known->second;
  }
  if (numbers.all().size() < 2) materials.clear();
  return materials;
}

Interfaces inner_interfaces(const Topology& topology) {
  Interfaces found;
  const MeshLabels& labels = topology.labels();
  const auto materials = cell_materials(topology);
  std::map<std::vector<NodeIndex>, int> tags;  // of labelled inner facets, until they are found
  for (const std::size_t f : inner_labelled_facets(topology))
    tags[sorted_nodes(labels.facets[f])] = labels.facet_tags[f];
  if (materials.empty() && tags.empty()) return found;
  // Of the two cells of a facet, the one with the lower material gives the direction; between cells
  // of one material the first cell does.
  std::map<std::vector<NodeIndex>, CellIndex> first_cells;
  std::vector<NodeIndex> row;
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const auto nodes = topology.cell_nodes(c);
    for_each_facet(topology.dimension(), nodes.size(), [&](std::span<const std::size_t> at) {
      row.clear();
      for (const std::size_t k : at) row.push_back(nodes[k]);
      auto key = sorted_nodes(row);
      const bool is_between =
          !materials.empty() && std::any_of(row.begin(), row.end(), [&](NodeIndex i) {
            const auto cells = topology.node_cells(i);
            return std::any_of(cells.begin(), cells.end(),
                               [&](CellIndex other) { return materials[other] != materials[c]; });
          });
      const auto tag = tags.find(key);
      if (!is_between && tag == tags.end()) return;
      const auto [first, is_first] = first_cells.try_emplace(std::move(key), c);
      if (is_first) return;
      const CellIndex other = first->second;
      const bool is_interface = !materials.empty() && materials[other] != materials[c];
      if (!is_interface && tag == tags.end()) return;
      const bool this_one = is_interface && materials[c] < materials[other];
      if (!this_one) std::reverse(row.begin(), row.end());  // the other cell's direction
      found.facets.append(row);
      found.tags.push_back(tag == tags.end() ? 0 : tag->second);
    });
  }
  direct_alike(found.facets);
  return found;
}

std::vector<bool> interface_nodes(const Topology& topology) {
  const MeshLabels& labels = topology.labels();
  std::vector<bool> flags(topology.n_nodes(), false);
  bool any = false;
  const auto mark = [&](std::span<const NodeIndex> nodes) {
    for (const NodeIndex node : nodes) flags[node] = any = true;
  };
  if (const auto materials = cell_materials(topology); !materials.empty()) {
    constexpr int none = -1, several = -2;
    std::vector<int> of_node(topology.n_nodes(), none);
    for (CellIndex c = 0; c < topology.n_cells(); ++c)
      for (const NodeIndex node : topology.cell_nodes(c))
        of_node[node] =
            of_node[node] == none || of_node[node] == materials[c] ? materials[c] : several;
    for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
      if (of_node[i] == several) flags[i] = any = true;
  }
  for (const std::size_t f : inner_labelled_facets(topology)) mark(labels.facets[f]);
  if (labels.content) {
    const auto& others = labels.content->others;
    const auto& on_boundary = topology.on_boundary();
    for (std::size_t e = 0; topology.dimension() == 3 && e < others[1].nodes.size(); ++e) {
      const auto nodes = others[1].nodes[e];
      const bool is_inner =
          std::any_of(nodes.begin(), nodes.end(), [&](NodeIndex i) { return !on_boundary[i]; });
      if (others[1].tags[e] != 0 && is_inner) mark(nodes);
    }
    const auto points = labelled_points(topology);
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i]) flags[i] = any = true;
  }
  if (!any) flags.clear();
  return flags;
}

std::vector<bool> labelled_points(const Topology& topology) {
  const FileContent* content = topology.labels().content.get();
  std::vector<bool> flags;
  if (!content) return flags;
  const OtherElements& points = content->others[0];
  for (std::size_t e = 0; e < points.nodes.size(); ++e) {
    if (points.tags[e] == 0) continue;
    if (flags.empty()) flags.resize(topology.n_nodes(), false);
    flags[points.nodes[e][0]] = true;
  }
  return flags;
}

std::vector<bool> required_nodes(const Topology& topology) {
  const FileContent* content = topology.labels().content.get();
  if (!content) return {};
  std::vector<bool> flags(topology.n_nodes(), false);
  bool any = false;
  for (const MeshField& field : content->node_fields) {
    if ((field.name != required_field && field.name != corner_field) || field.n_components != 1)
      continue;
    for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
      if (field.number(i) != 0.0) flags[i] = any = true;
  }
  for (const char* name : {required_field, ridge_field})
    for_each_marked_element(topology, name, [&](std::span<const NodeIndex> nodes) {
      for (const NodeIndex node : nodes) flags[node] = any = true;
    });
  if (!any) flags.clear();
  return flags;
}

}  // namespace smoothfem
