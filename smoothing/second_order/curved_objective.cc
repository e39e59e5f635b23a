// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/second_order/curved_objective.h"

#include <algorithm>
#include <array>
#include <limits>

#include "smoothing/base/parallel.h"
#include "smoothing/second_order/bending.h"
#include "smoothing/second_order/jacobian_bounds.h"
#include "smoothing/second_order/nodes_on_facets.h"
#include "smoothing/simd/inverse_root.h"

namespace smoothfem {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr std::size_t cell_grain = 256;  // cells that one thread takes at a time

/// S = sum_i x_i grad N_i' at a group of points, by columns, and its determinant.
template <int dim>
struct ShapeMatrix {
  std::array<Vector<dim, Lanes>, dim> columns{};
  Lanes determinant;

  ShapeMatrix(const CellRule<dim>& rule, std::size_t group, const CellNodes<dim>& nodes) {
    for (std::size_t i = 0; i < nodes.x.size(); ++i)
      for (std::size_t d = 0; d < dim; ++d) add(rule.gradient(group, i, d), nodes.x[i], columns[d]);
    if constexpr (dim == 2)
      determinant = cross(columns[0], columns[1]);
    else
      determinant = dot(columns[0], cross(columns[1], columns[2]));
  }

  Lanes squared_norm() const {
    Lanes sum{};
    for (const auto& column : columns) sum += squared_length(column);
    return sum;
  }

  /// Returns det(S) (S^-1)', by columns: the derivative of the determinant.
  std::array<Vector<dim, Lanes>, dim> cofactors() const {
    if constexpr (dim == 2)
      return {Vector2<Lanes>{columns[1].y, -columns[1].x},
              Vector2<Lanes>{-columns[0].y, columns[0].x}};
    else
      return {cross(columns[1], columns[2]), cross(columns[2], columns[0]),
              cross(columns[0], columns[1])};
  }

 private:
  static void add(Lanes factor, Vector2<double> x, Vector2<Lanes>& sum) {
    sum.x += factor * x.x;
    sum.y += factor * x.y;
  }
  static void add(Lanes factor, Vector3<double> x, Vector3<Lanes>& sum) {
    sum.x += factor * x.x;
    sum.y += factor * x.y;
    sum.z += factor * x.z;
  }
};

/// Returns f^2 at points with positive determinants.
template <int dim>
Lanes squared_inverse_mean_ratio(Lanes squared_norm, Lanes determinant) {
  const Lanes square = squared_norm * squared_norm;
  if constexpr (dim == 2) return 0.25 * square / (determinant * determinant);
  const Lanes root = inverse_root<3>(determinant), power = root * root;
  return (1.0 / 9.0) * square * (power * power);
}

/// Factors in the second derivatives of h = f^2 at a group of points. With u_p = S grad N_p and
/// c_p = (S^-1)' grad N_p, the gradients of |S|^2 / 2 and of log det(S) by node p, the gradient is
/// of_u u_p + of_c c_p, and the Hessian has the blocks
///
///   uu u_p u_q' + uc (u_p c_q' + c_p u_q') + cc c_p c_q' + turned c_q c_p'
///     + (unit grad N_p . grad N_q + strain c_p . c_q) I.
///
/// The term `turned` follows from the second derivative of log det(S). The convex models are those
/// of CellDerivatives, at each point: in the plane h Hess(log h) without its concave part; in space
/// 2 f Hess(f) without the second derivative of det(S) and a part of grad(f) grad(f)', but with the
/// strain.
template <int dim>
struct PointDerivatives {
  Lanes of_u, of_c, uu, uc, cc, turned, unit, strain{};

  PointDerivatives() = default;
  PointDerivatives(Lanes weight, Lanes squared_norm, Lanes determinant, HessianModel model) {
    const Lanes square = squared_inverse_mean_ratio<dim>(squared_norm, determinant);
    const Lanes h = weight * square, inverse = 1.0 / squared_norm;
    constexpr double n = dim;
    of_u = 4.0 * h * inverse;
    of_c = (-4.0 / n) * h;
    unit = of_u;
    if (model == HessianModel::exact) {
      uu = 8.0 * h * inverse * inverse;
      uc = (-16.0 / n) * h * inverse;
      cc = (16.0 / (n * n)) * h;
      turned = (4.0 / n) * h;
    } else if constexpr (dim == 2) {
      // f (f - 1) times 2 f |dS|^2 / |S|^2 + 2 det(dS) / det(S) replaces the concave part.
      const Lanes f = 0.5 * squared_norm / determinant, excess = weight * f * (f - 1.0);
      uu = -8.0 * h * inverse * inverse;
      uc = Lanes{};
      cc = excess;
      turned = 2.0 * h - excess;
      unit += 2.0 * f * excess * inverse;
    } else {
      uu = (-20.0 / 9.0) * h * inverse * inverse;
      uc = (-52.0 / 27.0) * h * inverse;
      cc = (160.0 / 81.0) * h;
      turned = Lanes{};
      strain = (1.0 / 3.0) * h;
    }
  }
};

double sum_of(Lanes lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}
Vector2<double> sum_of(Vector2<Lanes> v) {
  return {sum_of(v.x), sum_of(v.y)};
}
Vector3<double> sum_of(Vector3<Lanes> v) {
  return {sum_of(v.x), sum_of(v.y), sum_of(v.z)};
}

/// An array of vectors in lanes. (Lanes themselves are for local variables only.)
template <int dim>
class LaneVectors {
 public:
  explicit LaneVectors(std::size_t n) : numbers_(n * dim * n_lanes) {}

  void set(std::size_t i, Vector<dim, Lanes> v) {
    double* const at = &numbers_[i * dim * n_lanes];
    store_lanes(v.x, at);
    store_lanes(v.y, at + n_lanes);
    if constexpr (dim == 3) store_lanes(v.z, at + 2 * n_lanes);
  }
  Vector<dim, Lanes> operator[](std::size_t i) const {
    const double* const at = &numbers_[i * dim * n_lanes];
    if constexpr (dim == 2)
      return {load_lanes(at), load_lanes(at + n_lanes)};
    else
      return {load_lanes(at), load_lanes(at + n_lanes), load_lanes(at + 2 * n_lanes)};
  }

 private:
  std::vector<double> numbers_;
};

/// Gradient and Hessian of one cell's part of the objective.
template <int dim>
class CurvedCellDerivatives {
 public:
  using NodeBlocks = CellArray<Block<dim, double>, std::dynamic_extent>;  ///< one for each node

  std::vector<Vector<dim, double>> gradient;
  std::vector<Block<dim, double>> hessian;

  /// bending_weight: 0 for linear cells.
  CurvedCellDerivatives(const CellRule<dim>& rule, const CellNodes<dim>& nodes,
                        double bending_weight, HessianModel model, HessianBlocks blocks)
      : gradient(rule.n_nodes()),
        hessian(n_node_pairs(rule.n_nodes())),
        rule_(rule),
        u_(rule.n_groups() * rule.n_nodes()),
        c_(rule.n_groups() * rule.n_nodes()) {
    std::array<PointDerivatives<dim>, max_groups> factors;
    const std::size_t n = rule.n_nodes();
    for (std::size_t first = 0; first < rule.n_groups(); first += max_groups) {
      const std::size_t last = std::min(first + max_groups, rule.n_groups());
      for (std::size_t group = first; group < last; ++group)
        factors[group - first] = add_gradients(group, nodes, model);
      for (std::size_t p = 0; p < n; ++p)
        for (std::size_t q = p; q < (blocks == HessianBlocks::all ? n : p + 1); ++q) {
          Block<dim, Lanes> sum;
          for (std::size_t group = first; group < last; ++group)
            add_block(factors[group - first], group, p, q, sum);
          for (std::size_t e = 0; e < sum.entries.size(); ++e)
            hessian[node_pair(n, p, q)].entries[e] += sum_of(sum.entries[e]);
        }
    }
    if (bending_weight > 0.0)
      Bending<dim>(rule, nodes).add_derivatives(bending_weight, model, blocks, gradient, hessian);
  }

 private:
  static constexpr std::size_t max_groups = 8;  // of all rules but those of large polygons

  /// Sets u and c of all nodes at a group of points, adds the gradients, and returns the factors.
  PointDerivatives<dim> add_gradients(std::size_t group, const CellNodes<dim>& nodes,
                                      HessianModel model) {
    const ShapeMatrix<dim> shape(rule_, group, nodes);
    const auto cofactors = shape.cofactors();
    const Lanes inverse = 1.0 / shape.determinant;
    const PointDerivatives<dim> factors(rule_.weights(group), shape.squared_norm(),
                                        shape.determinant, model);
    const std::size_t n = rule_.n_nodes();
    for (std::size_t i = 0; i < n; ++i) {
      Vector<dim, Lanes> u{}, c{};
      for (std::size_t d = 0; d < dim; ++d) {
        const Lanes g = rule_.gradient(group, i, d);
        u = u + g * shape.columns[d];
        c = c + (g * inverse) * cofactors[d];
      }
      u_.set(group * n + i, u);
      c_.set(group * n + i, c);
      gradient[i] = gradient[i] + sum_of(factors.of_u * u + factors.of_c * c);
    }
    return factors;
  }

  void add_block(const PointDerivatives<dim>& factors, std::size_t group, std::size_t p,
                 std::size_t q, Block<dim, Lanes>& block) const {
    const std::size_t n = rule_.n_nodes();
    const auto u_p = u_[group * n + p], u_q = u_[group * n + q];
    const auto c_p = c_[group * n + p], c_q = c_[group * n + q];
    block.add_product(u_p, factors.uu * u_q + factors.uc * c_q);
    block.add_product(c_p, factors.uc * u_q + factors.cc * c_q);
    block.add_product(factors.turned * c_q, c_p);
    Lanes of_gradients{};
    for (std::size_t d = 0; d < dim; ++d)
      of_gradients += rule_.gradient(group, p, d) * rule_.gradient(group, q, d);
    block.add_unit(factors.unit * of_gradients + factors.strain * dot(c_p, c_q));
  }

  const CellRule<dim>& rule_;
  LaneVectors<dim> u_, c_;  ///< by group and node
};

}  // namespace

std::vector<NodeIndex> free_nodes_of_second_order(const Topology& topology) {
  std::vector<NodeIndex> nodes = topology.free_nodes();
  if (topology.midside() == nullptr) return nodes;
  const auto stays_otherwise = [&](NodeIndex i) {
    constexpr FixedReasons of_facets = bit(FixedReason::boundary) | bit(FixedReason::interface);
    return (topology.reasons_to_stay(i) & ~of_facets) != 0;
  };
  const auto is_on_facet = midside_nodes_on_facets(topology);
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    for_each_midside_place(topology.dimension(), topology.cell_nodes(c), topology.midside_nodes(c),
                           [&](const MidsidePlace& place, NodeIndex node) {
                             bool all_fixed = true, any_otherwise = false;
                             for (const NodeIndex corner : place) {
                               if (corner == no_corner) continue;
                               all_fixed = all_fixed && topology.is_fixed(corner);
                               any_otherwise = any_otherwise || stays_otherwise(corner);
                             }
                             if (!is_on_facet[node] && topology.reasons_to_stay(node) == 0 &&
                                 !(all_fixed && any_otherwise))
                               nodes.push_back(node);
                           });
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

namespace {

CompressedRows<NodeIndex> all_nodes_of_cells(const Topology& topology) {
  CompressedRows<NodeIndex> rows;
  std::vector<NodeIndex> nodes;
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const auto corners = topology.cell_nodes(c), midside = topology.midside_nodes(c);
    nodes.assign(corners.begin(), corners.end());
    nodes.insert(nodes.end(), midside.begin(), midside.end());
    rows.append(nodes);
  }
  return rows;
}

}  // namespace

template <int dim>
CurvedObjective<dim>::CurvedObjective(std::shared_ptr<const Topology> topology, double straightness)
    : topology_(std::move(topology)),
      straightness_(straightness),
      cells_(all_nodes_of_cells(*topology_)),
      sums_(*topology_, free_nodes_of_second_order(*topology_), cells_) {
  rule_of_cells_.reserve(topology_->n_cells());
  for (CellIndex c = 0; c < topology_->n_cells(); ++c) {
    const std::size_t n_corners = topology_->cell_nodes(c).size(),
                      n_midside = cells_[c].size() - n_corners;
    rule_of_cells_.push_back(
        &rules_.try_emplace({n_corners, n_midside}, n_corners, n_midside).first->second);
  }
}

template <int dim>
BlockMatrix<dim> CurvedObjective<dim>::make_hessian() {
  const auto node_cells = rows_by_entry(cells_, topology_->n_nodes());
  return sums_.make_hessian([&](NodeIndex i) { return node_cells[i]; });
}

template <int dim>
double CurvedObjective<dim>::cell_value(CellIndex cell,
                                        std::span<const Point<dim>> coordinates) const {
  const CellRule<dim>& rule = *rule_of_cells_[cell];
  const CellNodes<dim> nodes(cells_[cell], coordinates);
  Lanes sum{};
  for (std::size_t group = 0; group < rule.n_groups(); ++group) {
    const ShapeMatrix<dim> shape(rule, group, nodes);
    const Lanes square = squared_inverse_mean_ratio<dim>(shape.squared_norm(), shape.determinant);
    sum += shape.determinant > 0.0 ? rule.weights(group) * square : Lanes{} + infinite;
  }
  double total = sum_of(sum);
  if (!(total < infinite)) return infinite;
  if (!is_curved(cell)) return total;
  if (straightness_ > 0.0) total += straightness_ * Bending<dim>(rule, nodes).value();
  std::vector<Point<dim>> points;
  for (const NodeIndex i : cells_[cell]) points.push_back(coordinates[i]);
  return is_proven_valid(std::span<const Point<dim>>(points)) ? total : infinite;
}

template <int dim>
double CurvedObjective<dim>::value(std::span<const Point<dim>> coordinates) const {
  const auto& blocks = topology_->blocks();
  std::vector<double> parts(blocks.size());
  parallel_for(parts.size(), [&](std::size_t b) {
    for (CellIndex c = blocks[b].first; c < blocks[b].last && parts[b] < infinite; ++c)
      parts[b] += cell_value(c, coordinates);
  });
  double sum = 0.0;
  for (const double part : parts) sum += part;
  return sum;
}

template <int dim>
void CurvedObjective<dim>::derivatives(std::span<const Point<dim>> coordinates, HessianModel model,
                                       BlockVector<dim>& gradient,
                                       BlockMatrix<dim>& hessian) const {
  sums_.derivatives(
      [&](const CellBlock& block, auto sums) {
        for (CellIndex c = block.first; c < block.last; ++c)
          sums.add(
              SingleCell{cells_[c]},
              CurvedCellDerivatives<dim>(*rule_of_cells_[c], CellNodes<dim>(cells_[c], coordinates),
                                         is_curved(c) ? straightness_ : 0.0, model, sums.blocks));
      },
      gradient, hessian);
}

template <int dim>
double CurvedObjective<dim>::cell_limit(CellIndex cell, std::span<const Point<dim>> from,
                                        std::span<const Point<dim>> to, double fraction) const {
  constexpr int max_halvings = 10;
  const auto nodes = cells_[cell];
  if (std::all_of(nodes.begin(), nodes.end(), [&](NodeIndex i) { return from[i] == to[i]; }))
    return 1.0;
  const CellRule<dim>& rule = *rule_of_cells_[cell];
  const CellNodes<dim> before(nodes, from);
  std::vector<Point<dim>> points(nodes.size());
  const auto is_far_enough_from_invalid = [&](double t) {
    for (std::size_t k = 0; k < nodes.size(); ++k)
      points[k] = from[nodes[k]] + t * (to[nodes[k]] - from[nodes[k]]);
    const CellNodes<dim> after(points);
    for (std::size_t group = 0; group < rule.n_groups(); ++group) {
      const Lanes least = (1.0 - fraction) * ShapeMatrix<dim>(rule, group, before).determinant;
      const auto is_less = !(ShapeMatrix<dim>(rule, group, after).determinant >= least);
      for (std::size_t l = 0; l < n_lanes; ++l)
        if (is_less[l]) return false;
    }
    return !is_curved(cell) || is_proven_valid(std::span<const Point<dim>>(points));
  };
  double t = 1.0;
  for (int k = 0; k <= max_halvings; ++k, t *= 0.5)
    if (is_far_enough_from_invalid(t)) return t;
  return 0.0;
}

template <int dim>
double CurvedObjective<dim>::limits(std::span<const Point<dim>> from,
                                    std::span<const Point<dim>> to, double fraction,
                                    std::vector<double>& limits) const {
  std::vector<double> of_cells(topology_->n_cells());
  parallel_for_ranges(of_cells.size(), cell_grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c)
      of_cells[c] = cell_limit(static_cast<CellIndex>(c), from, to, fraction);
  });
  limits.assign(topology_->n_nodes(), 1.0);
  double smallest = 1.0;
  for (CellIndex c = 0; c < of_cells.size(); ++c)
    if (of_cells[c] < 1.0) {
      smallest = std::min(smallest, of_cells[c]);
      for (const NodeIndex i : cells_[c]) limits[i] = std::min(limits[i], of_cells[c]);
    }
  return smallest;
}

template class CurvedObjective<2>;
template class CurvedObjective<3>;

}  // namespace smoothfem
