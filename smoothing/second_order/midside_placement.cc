// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/second_order/midside_placement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "smoothing/base/parallel.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/second_order/curved_quality.h"
#include "smoothing/second_order/nodes_on_facets.h"
#include "smoothing/second_order/transfinite.h"

namespace smoothfem {

namespace {

constexpr std::size_t grain = 1024;

/// Turns and scales a vector as an edge: from `before` to `after`.
template <int dim>
Point<dim> moved_with(const Point<dim>& vector, const Point<dim>& before, const Point<dim>& after) {
  const double length = before.norm(), scale = after.norm() / length;
  if (vector.isZero(0.0) || length == 0.0 || scale == 0.0) return Point<dim>::Zero();
  if constexpr (dim == 2) {
    const double c = before.dot(after) / (length * length),
                 s = (before.x() * after.y() - before.y() * after.x()) / (length * length);
    return {c * vector.x() - s * vector.y(), s * vector.x() + c * vector.y()};
  } else {
    return scale * (Eigen::Quaterniond::FromTwoVectors(before, after) * vector);
  }
}

/// Returns the cells that are worse than the worst one asked for, or not proven to be valid.
std::vector<CellIndex> bad_cells(std::span<const double> quality, double floor) {
  std::vector<CellIndex> bad;
  for (CellIndex c = 0; c < quality.size(); ++c)
    if (!(quality[c] > 0.0) || quality[c] < floor) bad.push_back(c);
  return bad;
}

}  // namespace

template <int dim>
MidsidePlacement<dim>::MidsidePlacement(const Mesh<dim>& initial)
    : initial_(initial.copied_coordinates()),
      topology_(initial.shared_topology()),
      without_midside_(topology_->without_midside()),
      constraints_(initial.shared_constraints()) {
  const Topology& topology = *topology_;
  std::vector<std::uint8_t> is_known(initial.n_nodes(), 0);
  std::vector<MiddleNode> of_cells;
  edges_.reserve(initial.n_nodes());
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const auto corners = topology.cell_nodes(c), midside = topology.midside_nodes(c);
    const auto counts = midside_counts(dim, corners.size(), midside.size());
    std::size_t k = 0;
    for_each_midside_place(dim, corners, midside, [&](const MidsidePlace& place, NodeIndex node) {
      const std::size_t position = k++;
      if (is_known[node]) return;
      is_known[node] = 1;
      if (position < counts.edges)
        edges_.push_back({node, place[0], place[1]});
      else if (position < counts.edges + counts.faces)
        middles_.push_back(middle_of_face(node, corners, midside, position - counts.edges));
      else
        of_cells.push_back({node,
                            {corners.begin(), corners.end()},
                            {midside.begin(), midside.begin() + counts.edges},
                            {midside.begin() + counts.edges, midside.end() - 1}});
    });
  }
  middles_.insert(middles_.end(), of_cells.begin(), of_cells.end());
  find_bent_nodes();
}

template <int dim>
void MidsidePlacement<dim>::find_bent_nodes() {
  constexpr double rounding = 1e-9;  // of coordinates in files, relative to the edge
  is_bent_.assign(initial_.size(), 0);
  const Points x(initial_);
  for_each_node_in_parallel([&](const auto& node) {
    is_bent_[node.node] =
        (x[node.node] - straight(node, x)).norm() > rounding * direction(node, x).norm();
  });
  std::vector<std::uint8_t> is_straight(topology_->n_cells());
  parallel_for_ranges(is_straight.size(), grain, [&](std::size_t first, std::size_t last) {
    for (auto c = static_cast<CellIndex>(first); c < last; ++c)
      is_straight[c] = topology_->midside_nodes(c).empty() ||
                       (is_straight_simplex(c, is_bent_) && !any_slides(c));
  });
  curved_cells_.clear();
  for (CellIndex c = 0; c < is_straight.size(); ++c)
    if (!is_straight[c]) curved_cells_.push_back(c);
}

template <int dim>
typename MidsidePlacement<dim>::MiddleNode MidsidePlacement<dim>::middle_of_face(
    NodeIndex node, std::span<const NodeIndex> corners, std::span<const NodeIndex> midside,
    std::size_t face) {
  MiddleNode result{node, {}, {}, {}};
  std::size_t f = 0;
  for_each_quadrilateral_face(corners.size(), [&](const LocalFace& local) {
    if (f++ != face) return;
    std::size_t e = 0;
    for_each_edge(dim, corners.size(), [&](std::size_t a, std::size_t b) {
      const auto is_of_face = [&](std::size_t corner) {
        return std::find(local.nodes.begin(), local.nodes.end(), corner) != local.nodes.end();
      };
      if (is_of_face(a) && is_of_face(b)) result.edges.push_back(midside[e]);
      ++e;
    });
    for (const LocalIndex k : local.nodes) result.corners.push_back(corners[k]);
  });
  return result;
}

template <int dim>
Point<dim> MidsidePlacement<dim>::straight(const MiddleNode& middle, Points x) const {
  Point<dim> result = Point<dim>::Zero();
  const auto add = [&](double weight, const std::vector<NodeIndex>& nodes) {
    Point<dim> sum = Point<dim>::Zero();
    for (const NodeIndex node : nodes) sum += x[node];
    if (!nodes.empty()) result += weight / static_cast<double>(nodes.size()) * sum;
  };
  const TransfiniteWeights weights = transfinite_weights(middle.corners.size());
  add(weights.corners, middle.corners);
  add(weights.edges, middle.edges);
  add(weights.faces, middle.faces);
  return result;
}

template <int dim>
bool MidsidePlacement<dim>::has_moved(const MiddleNode& middle, Points x) const {
  return std::any_of(middle.corners.begin(), middle.corners.end(),
                     [&](NodeIndex node) { return x[node] != initial_[node]; });
}

template <int dim>
template <class Visit>
void MidsidePlacement<dim>::for_each_node(const Visit& visit) const {
  for (const EdgeNode& edge : edges_) visit(edge);
  for (const MiddleNode& middle : middles_) visit(middle);
}

template <int dim>
template <class Visit>
void MidsidePlacement<dim>::for_each_node_in_parallel(const Visit& visit) const {
  parallel_for_ranges(edges_.size(), grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) visit(edges_[i]);
  });
  for (const MiddleNode& middle : middles_) visit(middle);
}

template <int dim>
template <class Node>
Point<dim> MidsidePlacement<dim>::bent(const Node& node, Points x, double part) const {
  const Points before(initial_);
  const Point<dim> offset = before[node.node] - straight(node, before);
  return straight(node, x) +
         part * moved_with<dim>(offset, direction(node, before), direction(node, x));
}

template <int dim>
std::vector<std::uint8_t> MidsidePlacement<dim>::place_all(
    Mesh<dim>& mesh, std::span<const std::uint8_t> quarters) const {
  const auto x = mesh.coordinates();
  auto is_bent = is_bent_;
  for_each_node_in_parallel([&](const auto& node) {
    const std::uint8_t n = quarters[node.node];
    if (!has_moved(node, x)) {
      x[node.node] = initial_[node.node];
    } else {
      const bool on_surface = slides(node.node);
      x[node.node] = n == 0 ? straight(node, x) : bent(node, x, 0.25 * n);
      if (on_surface)
        x[node.node] = constraints_->project(node.node, a_corner_of(node, x), x[node.node]);
      is_bent[node.node] = n > 0 || on_surface;
    }
  });
  return is_bent;
}

template <int dim>
std::vector<double> MidsidePlacement<dim>::qualities(
    const Mesh<dim>& mesh, const std::vector<std::uint8_t>& is_bent) const {
  if (mesh.targets()) return curved_mean_ratios(mesh);
  // Straight simplices have the quality of their corners.
  std::vector<double> quality = corner_mean_ratios(mesh);
  std::vector<CellIndex> others;
  for (CellIndex c = 0; c < quality.size(); ++c)
    if (!(quality[c] > well_above_rounding_errors) && !topology_->midside_nodes(c).empty())
      others.push_back(c);
  for (const CellIndex c : curved_cells_)
    if (quality[c] > well_above_rounding_errors && !is_straight_simplex(c, is_bent))
      others.push_back(c);
  parallel_for_ranges(others.size(), grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      quality[others[i]] = curved_mean_ratio(mesh, others[i]);
  });
  return quality;
}

template <int dim>
bool MidsidePlacement<dim>::is_straight_simplex(CellIndex c,
                                                std::span<const std::uint8_t> is_bent) const {
  const auto midside = topology_->midside_nodes(c);
  return topology_->cell_nodes(c).size() == dim + 1 &&
         std::none_of(midside.begin(), midside.end(),
                      [&](NodeIndex node) { return is_bent[node] != 0; });
}

template <int dim>
MidsideReport MidsidePlacement<dim>::place(Mesh<dim>& mesh, double floor,
                                           std::vector<double>& cell_quality) const {
  constexpr std::uint8_t whole = 4, once = 1, done = 2;  // in a round
  MidsideReport report;
  std::vector<std::uint8_t> quarters(mesh.n_nodes(), 0);
  const auto x = mesh.coordinates();
  bool has_bent = false;
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    cell_quality = qualities(mesh, place_all(mesh, quarters));
    const auto bad = bad_cells(cell_quality, floor);
    if (bad.empty()) break;
    std::vector<std::uint8_t> may_bend(mesh.n_nodes(), 0);
    for_each_node([&](const auto& node) {
      const NodeIndex i = node.node;
      may_bend[i] =
          is_bent_[i] && quarters[i] < whole && has_moved(node, x) && !slides(i) ? once : 0;
    });
    for (const CellIndex c : bad) {
      bool can_bend = false;
      for (const NodeIndex node : topology_->midside_nodes(c))
        if (may_bend[node]) {
          can_bend = has_bent = has_changed = true;
          if (may_bend[node] == once) {
            ++quarters[node];
            may_bend[node] = done;
          }
        }
      if (can_bend) continue;
      for (const NodeIndex node : topology_->cell_nodes(c))
        if (x[node] != initial_[node]) {
          x[node] = initial_[node];
          ++report.n_reset;
          has_changed = true;
        }
    }
  }
  if (has_bent)
    for_each_node(
        [&](const auto& node) { report.n_bent += quarters[node.node] > 0 && has_moved(node, x); });
  return report;
}

template <int dim>
MidsideReport MidsidePlacement<dim>::repair(Mesh<dim>& mesh, std::vector<double>& cell_quality) {
  constexpr std::uint8_t whole = 8;
  MidsideReport report;
  cell_quality = qualities(mesh, is_bent_);
  auto bad = bad_cells(cell_quality, 0.0);
  if (bad.empty()) return report;
  const auto of_corners = corner_mean_ratios(mesh);
  std::erase_if(bad, [&](CellIndex c) { return !(of_corners[c] > 0.0); });
  report.n_repaired = bad.size();
  std::vector<std::uint8_t> eighths(mesh.n_nodes(), whole);
  const auto x = mesh.coordinates();
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (const CellIndex c : bad)
      for (const NodeIndex node : topology_->midside_nodes(c))
        if (is_bent_[node] && eighths[node] > 0) {
          --eighths[node];
          has_changed = true;
        }
    if (!has_changed) break;
    for_each_node([&](const auto& node) {
      const double part = static_cast<double>(eighths[node.node]) / whole;
      if (part < 1.0) {
        const Point<dim> place = straight(node, x);
        x[node.node] = place + part * (initial_[node.node] - place);
      }
    });
    cell_quality = curved_mean_ratios(mesh);
    bad = bad_cells(cell_quality, 0.0);
    std::erase_if(bad, [&](CellIndex c) { return !(of_corners[c] > 0.0); });
  }
  report.n_repaired -= bad.size();
  const auto on_boundary = midside_nodes_on_facets(*topology_);
  for_each_node([&](const auto& node) {
    const bool is_relaxed = eighths[node.node] < whole;
    report.n_relaxed += is_relaxed;
    report.n_relaxed_on_boundary += is_relaxed && on_boundary[node.node];
  });
  initial_.assign(x.begin(), x.end());
  find_bent_nodes();
  return report;
}

template class MidsidePlacement<2>;
template class MidsidePlacement<3>;

}  // namespace smoothfem
