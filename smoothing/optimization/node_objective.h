// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>

#include "smoothing/mesh/topology.h"
#include "smoothing/optimization/node_terms.h"
#include "smoothing/simd/cells.h"

/// The shape objective of the cells of one node, as a function of its position; several cells of
/// one kind at a time.

namespace smoothfem {

/// Returns the nodes of a cell, reordered so that the node at `position` comes first. The cell is
/// turned; the top of a pyramid keeps its place.
template <int dim, std::size_t n>
constexpr std::array<LocalIndex, n> turned(std::size_t position) {
  std::array<LocalIndex, n> order{};
  const auto set = [&](std::size_t k, std::size_t node) {
    order[k] = static_cast<LocalIndex>(node);
  };
  if constexpr (dim == 2) {
    for (std::size_t k = 0; k < n; ++k) set(k, (position + k) % n);
  } else if constexpr (n == 4) {
    for (std::size_t k = 0; k < n; ++k) set(k, position ^ k);
  } else if constexpr (n == 5) {
    for (std::size_t k = 0; k < 4; ++k) set(k, (position + k) % 4);
    set(4, 4);
  } else {
    constexpr std::size_t m = n / 2;  // upside down if the node is above
    const bool above = position >= m;
    for (std::size_t k = 0; k < m; ++k) {
      const std::size_t turn = (position + (above ? m - k : k)) % m;
      set(k, above ? m + turn : turn);
      set(m + k, above ? turn : m + turn);
    }
  }
  return order;
}
template <int dim, std::size_t n>
inline constexpr auto turned_orders = [] {
  std::array<std::array<LocalIndex, n>, n> orders{};
  for (std::size_t p = 0; p < n; ++p) orders[p] = turned<dim, n>(p);
  return orders;
}();

inline std::size_t position_of(NodeIndex node, std::span<const NodeIndex> nodes) {
  return static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
}

/// Calls visit(nodes, slot, lanes) for the cells of a node, several of one kind at a time. The node
/// itself is at `slot` (a std::integral_constant); `lanes` counts the lanes in use.
template <int dim, class Visit>
inline void for_each_cell_of_node(const Topology& topology, std::span<const Point<dim>> x,
                                  NodeIndex node, const Point<dim>& position, const Visit& visit) {
  const auto cells = topology.node_cells(node);
  const auto coordinates_of = [&](NodeIndex i) -> const Point<dim>& {
    return i == node ? position : x[i];
  };
  const auto is_top = [&](std::span<const NodeIndex> nodes) {
    return dim == 3 && nodes.size() == 5 && nodes[4] == node;
  };
  for (std::size_t first = 0; first < cells.size();) {
    const auto nodes = topology.cell_nodes(cells[first]);
    const bool top = is_top(nodes);
    std::size_t count = 1;
    while (count < n_lanes && first + count < cells.size()) {
      const auto others = topology.cell_nodes(cells[first + count]);
      if (others.size() != nodes.size() || is_top(others) != top) break;
      ++count;
    }
    with_cell_size<dim>(nodes.size(), [&](auto size) {
      constexpr std::size_t n = decltype(size)::value;
      if constexpr (dim == 2) {  // clang compiles the following lines for every n
        if constexpr (n == 0) {
          count = 1;
          std::vector<Vector<dim, double>> corners;
          const std::size_t at = position_of(node, nodes);
          for (std::size_t k = 0; k < nodes.size(); ++k)
            corners.push_back(vector_of(coordinates_of(nodes[(at + k) % nodes.size()])));
          visit(std::span<const Vector<dim, double>>(corners),
                std::integral_constant<std::size_t, 0>{}, count);
        }
      }
      if constexpr (n > 0) {
        std::array<std::array<NodeIndex, n>, n_lanes> turned_nodes;
        std::array<const NodeIndex*, n_lanes> rows;
        for (std::size_t l = 0; l < n_lanes; ++l) {
          const auto row = topology.cell_nodes(cells[first + std::min(l, count - 1)]);
          const auto& order = turned_orders<dim, n>[position_of(node, row)];
          for (std::size_t k = 0; k < n; ++k) turned_nodes[l][k] = row[order[k]];
          rows[l] = turned_nodes[l].data();
        }
        const CellBatch<n> batch{first, count, {}, rows};
        const auto corners = batch.template corners_at<dim>(coordinates_of);
        const std::span<const Vector<dim, Lanes>, n> span(corners);
        if constexpr (dim == 3 && n == 5) {
          if (top) {
            visit(span, std::integral_constant<std::size_t, 4>{}, count);
            return;
          }
        }
        visit(span, std::integral_constant<std::size_t, 0>{}, count);
      }
    });
    first += count;
  }
}

template <int dim>
struct LocalObjective {
  double value = 0.0;
  Point<dim> gradient = Point<dim>::Zero();
  Eigen::Matrix<double, dim, dim> hessian = Eigen::Matrix<double, dim, dim>::Zero();
};

/// Objective of the cells of a node that is moved to `position`.
template <bool with_derivatives, int dim>
inline LocalObjective<dim> local_objective(const Topology& topology, std::span<const Point<dim>> x,
                                           NodeIndex node, const Point<dim>& position,
                                           double softness) {
  LocalObjective<dim> sum;
  for_each_cell_of_node<dim>(
      topology, x, node, position, [&](auto nodes, auto slot, std::size_t count) {
        const auto terms = node_terms<slot, with_derivatives>(nodes, softness);
        sum.value += sum_of_lanes(terms.value, count);
        if constexpr (with_derivatives) {
          sum.gradient += sum_of_lanes(terms.gradient, count);
          for (int i = 0; i < dim * dim; ++i)
            sum.hessian.data()[i] +=
                sum_of_lanes(terms.hessian.entries[static_cast<std::size_t>(i)], count);
        }
      });
  return sum;
}

/// Mean |det(S)| of the corners of a node's cells. If all are flat: a small fraction of the value
/// for regular corners with their |S|^2.
template <int dim>
inline double mean_size(const Topology& topology, std::span<const Point<dim>> x, NodeIndex node) {
  constexpr double min_fraction = 1e-3;
  double size = 0.0, squared_length = 0.0, n = 0.0;
  for_each_cell_of_node<dim>(
      topology, x, node, x[node], [&](auto nodes, auto slot, std::size_t count) {
        for_each_corner<slot>(nodes, [&](const auto& corner, int) {
          const auto determinant =
              (1.0 / corner.regular_determinant) * frame_determinant(corner.edges);
          size += sum_of_lanes(determinant > 0.0 ? determinant : -determinant, count);
          for (std::size_t i = 0; i < dim; ++i)
            squared_length += sum_of_lanes(dot(corner.edges[i], corner.half_gradient(i)), count);
          n += static_cast<double>(count);
        });
      });
  const double length = std::sqrt(squared_length / (dim * n));
  return std::max(size / n, min_fraction * (dim == 2 ? length * length : length * length * length));
}

}  // namespace smoothfem
