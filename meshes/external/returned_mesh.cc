// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/external/returned_mesh.h"

#include <algorithm>
#include <array>
#include <unordered_map>

#include "meshes/io/mesh_file.h"
#include "smoothing/loop/smoother.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/second_order/curved_objective.h"

namespace smoothfem {

namespace {

/// Node of the mesh for each node of the file.
using NodeMap = std::vector<NodeIndex>;

std::string count_text(std::size_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

NodeMap matching_nodes(const Topology& given, const Topology& returned) {
  if (given.n_nodes() != returned.n_nodes())
    throw SmootherFailure("its mesh has " + count_text(returned.n_nodes(), "node") +
                          " in place of " + std::to_string(given.n_nodes()) +
                          ": nodes are matched by their numbers, so none may be added or dropped");
  NodeMap map(given.n_nodes());
  const auto& ids = given.labels().node_ids;
  const auto& returned_ids = returned.labels().node_ids;
  if (returned_ids.empty()) {
    for (NodeIndex i = 0; i < map.size(); ++i) map[i] = i;
    return map;
  }
  std::unordered_map<std::size_t, NodeIndex> by_id;
  for (NodeIndex i = 0; i < map.size(); ++i) by_id[ids.empty() ? i + 1 : ids[i]] = i;
  for (NodeIndex i = 0; i < map.size(); ++i) {
    const auto found = by_id.find(returned_ids[i]);
    if (found == by_id.end())
      throw SmootherFailure("its mesh has a node with the number " +
                            std::to_string(returned_ids[i]) +
                            ", which the given mesh does not have: nodes must keep their numbers");
    map[i] = found->second;
  }
  return map;
}

/// A cell, independent of its first node and direction: up to eight nodes, or a hash of more.
using CellKey = std::array<NodeIndex, 8>;

template <class Number>
std::vector<CellKey> sorted_keys(const Topology& topology, const Number& number) {
  std::vector<CellKey> keys;
  keys.reserve(topology.n_cells());
  std::vector<NodeIndex> nodes;
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    nodes.clear();
    for (const NodeIndex i : topology.cell_nodes(c)) nodes.push_back(number(i));
    std::sort(nodes.begin(), nodes.end());
    CellKey key;
    key.fill(UINT32_MAX);
    for (std::size_t i = 0; i < nodes.size(); ++i)  // polygons of many nodes: all of them count
      key[i % 8] = i < 8 ? nodes[i] : 31 * key[i % 8] + nodes[i];
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

void require_same_cells(const Topology& given, const Topology& returned, const NodeMap& map) {
  if (given.n_cells() != returned.n_cells())
    throw SmootherFailure("its mesh has " + count_text(returned.n_cells(), "cell") +
                          " in place of " + std::to_string(given.n_cells()) +
                          ": only nodes may move");
  const auto given_keys = sorted_keys(given, [](NodeIndex i) { return i; });
  const auto returned_keys = sorted_keys(returned, [&](NodeIndex i) { return map[i]; });
  std::size_t n_changed = 0;
  for (auto a = given_keys.begin(), b = returned_keys.begin();
       a != given_keys.end() && b != returned_keys.end();)
    if (*a == *b) {
      ++a;
      ++b;
    } else if (*a < *b) {
      ++a;
      ++n_changed;
    } else {
      ++b;
    }
  if (given_keys != returned_keys)
    throw SmootherFailure("its mesh has other cells (" +
                          count_text(std::max<std::size_t>(1, n_changed), "cell") +
                          " changed): only nodes may move, edges and faces must not be swapped");
}

/// The place of each midside node, and the node.
using PlacedNodes = std::vector<std::pair<MidsidePlace, NodeIndex>>;

template <class Number>
PlacedNodes sorted_midside_nodes(const Topology& topology, const Number& number) {
  PlacedNodes placed;
  std::vector<NodeIndex> corners, midside;
  const auto set_numbers = [&](std::span<const NodeIndex> nodes, std::vector<NodeIndex>& numbers) {
    numbers.clear();
    for (const NodeIndex i : nodes) numbers.push_back(number(i));
  };
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    set_numbers(topology.cell_nodes(c), corners);
    set_numbers(topology.midside_nodes(c), midside);
    for_each_midside_place(
        topology.dimension(), corners, midside,
        [&](const MidsidePlace& place, NodeIndex node) { placed.emplace_back(place, node); });
  }
  std::sort(placed.begin(), placed.end());
  placed.erase(std::unique(placed.begin(), placed.end()), placed.end());
  return placed;
}

void require_same_midside_nodes(const Topology& given, const Topology& returned,
                                const NodeMap& map) {
  if (sorted_midside_nodes(given, [](NodeIndex i) { return i; }) !=
      sorted_midside_nodes(returned, [&](NodeIndex i) { return map[i]; }))
    throw SmootherFailure(returned.midside()
                              ? "its mesh has other midside nodes in its cells: only nodes may move"
                              : "its mesh has linear cells in place of cells of second order");
}

/// Returns flags of the nodes that must stay.
std::vector<bool> fixed_nodes(const Topology& topology) {
  std::vector<bool> is_fixed(topology.n_nodes(), true);
  for (const NodeIndex i : free_nodes_of_second_order(topology)) is_fixed[i] = false;
  return is_fixed;
}

/// Text files may have no more than six digits.
template <int dim>
void keep_fixed_nodes(const Mesh<dim>& mesh, std::vector<Point<dim>>& points) {
  constexpr double digits = 1e-6;
  double largest = 0.0;
  for (const auto& p : mesh.coordinates()) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  std::size_t n_moved = 0;
  double farthest = 0.0;
  const auto is_fixed = fixed_nodes(mesh.topology());
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    if (!is_fixed[i]) continue;
    const double moved = (points[i] - mesh.coordinates()[i]).norm();
    farthest = std::max(farthest, moved);
    if (moved > digits * largest) ++n_moved;
    points[i] = mesh.coordinates()[i];
  }
  if (n_moved > 0)
    throw SmootherFailure("it has moved " + count_text(n_moved, "fixed node") + ", by up to " +
                          std::to_string(farthest) +
                          ": fixed nodes, for example those of the boundary, must stay");
}

/// A linear mesh may have invalid cells, which its record counts. Curved cells must have a proof.
template <int dim>
void require_proven_cells(const Mesh<dim>& mesh, const std::vector<Point<dim>>& points) {
  if (!mesh.topology().midside()) return;
  Mesh<dim> moved = mesh;
  moved.set_coordinates(points);
  const std::size_t n_invalid = mesh_quality(moved).n_invalid;
  if (n_invalid > 0)
    throw SmootherFailure("its mesh has " + count_text(n_invalid, "curved cell") + " of " +
                          std::to_string(mesh.n_cells()) +
                          " without a proof that det J is positive: cells must stay valid");
}

MeshFile read_returned(const std::filesystem::path& file) {
  try {
    return read_mesh(file, {.turns_over = false});
  } catch (const InputError& error) {
    std::string reason = error.what();  // without the temporary folder
    if (const auto at = reason.find(file.string()); at != std::string::npos)
      reason.replace(at, file.string().size(), file.filename().string());
    throw SmootherFailure("its mesh cannot be read: " + reason);
  }
}

}  // namespace

template <int dim>
std::vector<Point<dim>> returned_coordinates(const std::filesystem::path& file,
                                             const Mesh<dim>& mesh) {
  const MeshFile read = read_returned(file);
  const auto* returned = std::get_if<Mesh<dim>>(&read.mesh);
  if (returned == nullptr)
    throw SmootherFailure("its mesh is a " + std::string(kind_name(read.mesh)) +
                          " mesh, but was given as a " + mesh_kind_name(dim, dim) + " mesh");
  const NodeMap map = matching_nodes(mesh.topology(), returned->topology());
  require_same_cells(mesh.topology(), returned->topology(), map);
  require_same_midside_nodes(mesh.topology(), returned->topology(), map);
  std::vector<Point<dim>> points(mesh.n_nodes());
  for (NodeIndex i = 0; i < map.size(); ++i) points[map[i]] = returned->coordinates()[i];
  keep_fixed_nodes(mesh, points);
  require_proven_cells(mesh, points);
  return points;
}

template std::vector<Point<2>> returned_coordinates(const std::filesystem::path&, const Mesh<2>&);
template std::vector<Point<3>> returned_coordinates(const std::filesystem::path&, const Mesh<3>&);

}  // namespace smoothfem
