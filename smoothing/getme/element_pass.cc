// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/getme/element_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "smoothing/geometry/cell_edges.h"
#include "smoothing/getme/neighbour_sizes.h"
#include "smoothing/getme/node_sums.h"
#include "smoothing/getme/regularize.h"
#include "smoothing/parts/mesh_part.h"
#include "smoothing/quality/target_corners.h"

namespace smoothfem {

namespace {

/// Returns (1 - q)^eta. The exponents of the thesis are computed by square roots, which are bitwise
/// identical on every machine. Other exponents use std::pow.
double quality_weight(double quality, double eta) {
  const double base = std::max(1.0 - quality, 0.0);
  if (eta == 0.0) return 1.0;
  if (eta == 0.5) return std::sqrt(base);
  if (eta == 0.25) return std::sqrt(std::sqrt(base));
  if (eta == 1.0) return base;
  return std::pow(base, eta);
}
Lanes quality_weight(Lanes quality, double eta) {
  if (eta == 0.0) return Lanes{} + 1.0;
  Lanes weight;
  for (std::size_t l = 0; l < n_lanes; ++l) weight[l] = quality_weight(quality[l], eta);
  return weight;
}

/// Weights of Eq. 4.2; every element is transformed.
struct QualityWeighting {
  double eta;

  template <class Cells, class Real>
  Real weight(const Cells&, Real quality) const {
    return quality_weight(quality, eta);
  }
  template <class Real, class Vector>
  Vector chosen(Real, Vector transformed, Vector) const {
    return transformed;
  }
};

/// Transforms elements of at most this quality; weights are given for each element.
struct ThresholdWeighting {
  const double* weights;
  double threshold;

  double weight(CellIndex cell, double) const { return weights[cell]; }
  Lanes weight(const std::array<CellIndex, n_lanes>& cells, Lanes) const {
    return Lanes{weights[cells[0]], weights[cells[1]], weights[cells[2]], weights[cells[3]]};
  }
  template <class Real>
  Vector2<Real> chosen(Real quality, Vector2<Real> transformed, Vector2<Real> original) const {
    const auto transforms = quality <= threshold;
    return {transforms ? transformed.x : original.x, transforms ? transformed.y : original.y};
  }
  template <class Real>
  Vector3<Real> chosen(Real quality, Vector3<Real> transformed, Vector3<Real> original) const {
    const auto transforms = quality <= threshold;
    return {transforms ? transformed.x : original.x, transforms ? transformed.y : original.y,
            transforms ? transformed.z : original.z};
  }
};

/// Returns w p' and w of n_lanes elements, in the layout that NodeSums adds.
std::array<Lanes, n_lanes> weighted(Vector2<Lanes> position, Lanes weight) {
  return transposed(weight * position.x, weight * position.y, weight, Lanes{});
}
std::array<Lanes, n_lanes> weighted(Vector3<Lanes> position, Lanes weight) {
  return transposed(weight * position.x, weight * position.y, weight * position.z, weight);
}
/// Returns w p' and w of one element.
Lanes weighted(Vector2<double> position, double weight) {
  return Lanes{weight * position.x, weight * position.y, weight, 0.0};
}
Lanes weighted(Vector3<double> position, double weight) {
  return Lanes{weight * position.x, weight * position.y, weight * position.z, weight};
}

/// Rounds the sums' terms in a part of a mesh, so that sums are exact: they do not depend on the
/// order of the cells. Terms are weighted movements there. Source: Demmel, Nguyen, Fast
/// reproducible floating-point summation, ARITH 2013.
class TermRounding {
 public:
  /// length, weight: limits of sums of movements and of weights. dim: of the space.
  TermRounding(double length, double weight, int dim) {
    for (int d = 0; d < dim; ++d) shift_[d] = shift_of(length);
    shift_[dim] = shift_of(weight);
  }

  Lanes operator()(Lanes terms) const { return (terms + shift_) - shift_; }
  std::array<Lanes, n_lanes> operator()(std::array<Lanes, n_lanes> terms) const {
    for (Lanes& term : terms) term = (*this)(term);
    return terms;
  }

 private:
  /// Adding this number rounds smaller ones to multiples that the sum of all holds exactly.
  static double shift_of(double limit) { return std::ldexp(1.5, std::ilogb(limit) + 2); }

  Lanes shift_{};
};

/// Limits of the sums of a node if no weight is above 1.
struct SumLimits {
  double length = 0.0, weight = 0.0;
};

/// Returns the limits for the elements of all parts. Collective.
template <int dim, int spacedim>
SumLimits limits_of_sums(const Mesh<dim, spacedim>& mesh) {
  constexpr double longest_movement = 16.0;  // in lengths of the longest edge, with a margin
  double longest = 0.0, most_cells = 0.0;
  const auto x = mesh.coordinates();
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = mesh.topology().cell_nodes(c);
    for_each_edge(dim, nodes.size(), [&](std::size_t a, std::size_t b) {
      longest = std::max(longest, (x[nodes[a]] - x[nodes[b]]).squaredNorm());
    });
  }
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    most_cells = std::max(most_cells, static_cast<double>(mesh.topology().node_cells(i).size()));
  std::array largest{std::sqrt(longest), most_cells};
  mesh.topology().part()->max(std::span<double>(largest));
  return {longest_movement * largest[0] * largest[1], 2.0 * largest[1]};
}

/// Weight of an element with a target: the inverse square of the target's width, so that deviations
/// count in units of each element's own width. Otherwise small elements would follow large ones.
template <int dim, class Real>
Real target_weight(const LinearMap<dim, Real>& map) {
  const Real root = inverse_root<dim>(map.determinant());
  return root * root;
}

/// Fits: std::true_type or std::false_type in the plane: whether element steps take a target size.
/// HasTargets: std::false_type or bool: code for targets would keep corners out of registers.
template <int dim, int spacedim, class Weighting, class Fits = bool, class HasTargets = bool>
struct Pass {
  const Mesh<dim, spacedim>& mesh;
  const ElementRegularization<dim, spacedim>& element;
  const NeighbourSizes<dim, spacedim>& sizes;  ///< up to date if the element step needs them
  const double* prescribed;  ///< prescribed size of each cell, used in their place; or null
  Weighting weighting;
  Fits fits;
  HasTargets has_targets;
  const TermRounding* rounding = nullptr;  ///< of parts of a mesh

  const CellTargets<dim>* targets() const { return has_targets ? mesh.targets() : nullptr; }

  /// Adds w_j p'_i to sums[i] for the elements of a batch and their nodes where wanted(i) holds.
  /// Returns the quality of the elements. The order of the sums: first node 0 of all elements, one
  /// element after the other, then node 1, and so on.
  template <std::size_t n, class Wanted>
  Lanes add(const CellBatch<n>& batch, const Wanted& wanted, double* sums) const {
    const Point<spacedim>* const x = mesh.coordinates().data();
    const auto corners = target_corners<dim>(targets(), batch, coordinates_at(x));
    std::array<Vector<dim, Lanes>, n> transformed;
    const Lanes quality =
        within_size_bound<dim>(targets(), std::span<const Vector<dim, Lanes>, n>(corners),
                               regularized(batch, corners, transformed));
    Lanes weight = weighting.weight(batch.cells, quality);
    unrolled<n>(
        [&](auto k) { transformed[k] = weighting.chosen(quality, transformed[k], corners[k]); });
    if (targets() != nullptr) [[unlikely]] {
      const auto map = linear_map<TargetMap::to_target>(*targets(), batch.cells);
      for (auto& node : transformed) node = map(node);
      weight = weight * target_weight(map);
    }
    if (rounding) [[unlikely]]
      unrolled<n>([&](auto k) { transformed[k] = transformed[k] - corners[k]; });
    unrolled<n>([&](auto k) {
      const auto terms = rounded(weighted(transformed[k], weight));
      batch.for_each_lane([&](std::size_t l) {
        if (wanted(batch.nodes[l][k])) NodeSums::add(sums, batch.nodes[l][k], terms[l]);
      });
    });
    return quality;
  }

  template <class Terms>
  Terms rounded(Terms terms) const {
    return rounding ? (*rounding)(terms) : terms;
  }

  template <std::size_t n>
  Lanes size_of(const CellBatch<n>& batch) const {
    if (prescribed == nullptr) return sizes.of(batch);
    return Lanes{prescribed[batch.cells[0]], prescribed[batch.cells[1]], prescribed[batch.cells[2]],
                 prescribed[batch.cells[3]]};
  }

  template <std::size_t n>
  Lanes regularized(const CellBatch<n>& batch, const std::array<Vector<dim, Lanes>, n>& corners,
                    std::array<Vector<dim, Lanes>, n>& transformed) const {
    const Lanes size = fits ? size_of(batch) : Lanes{};
    const std::span<const Vector<dim, Lanes>, n> from(corners);
    const std::span<Vector<dim, Lanes>, n> to(transformed);
    if constexpr (dim == 2)
      return element.regularize(from, to, size, fits);
    else
      return element.regularize(from, to, size);
  }

  /// Does the same for one polygon or one cell of a surface.
  template <class Wanted>
  double add_cell(CellIndex cell, const Wanted& wanted, double* sums) const {
    const auto nodes = mesh.topology().cell_nodes(cell);
    const Point<spacedim>* const x = mesh.coordinates().data();
    double quality = 0.0;
    with_target_corners(mesh, cell, coordinates_at(x), [&](auto corners) {
      with_result(corners, [&](auto transformed) {
        const double size = !fits ? 0.0 : prescribed ? prescribed[cell] : sizes.of(nodes);
        quality = regularize(element, upper_side(mesh, cell), corners, transformed, size);
        if constexpr (dim == spacedim)
          quality = within_size_bound<dim>(mesh.targets(), corners, quality);
        double weight = weighting.weight(cell, quality);
        if constexpr (dim == spacedim)
          if (mesh.targets() != nullptr)
            weight *= target_weight(linear_map<TargetMap::to_target>(*mesh.targets(), cell));
        for (std::size_t k = 0; k < nodes.size(); ++k)
          transformed[k] = weighting.chosen(quality, transformed[k], corners[k]);
        map_to_target(mesh, cell, transformed);
        if (rounding)
          for (std::size_t k = 0; k < nodes.size(); ++k)
            transformed[k] = transformed[k] - vector_of(x[nodes[k]]);
        for (std::size_t k = 0; k < nodes.size(); ++k)
          if (wanted(nodes[k]))
            NodeSums::add(sums, nodes[k], rounded(weighted(transformed[k], weight)));
      });
    });
    return quality;
  }
};

/// Calls visit(fits); in the plane `fits` is a type, std::true_type or std::false_type.
template <int dim, int spacedim, class Visit>
void with_scaling(bool fits, const Visit& visit) {
  if constexpr (dim == 2 && spacedim == 2) {
    if (fits)
      visit(std::true_type{});
    else
      visit(std::false_type{});
  } else {
    visit(fits);
  }
}

/// Adds all cells of a block in their order; writes their quality.
template <int dim, int spacedim, class... Rules>
void add_block(const Pass<dim, spacedim, Rules...>& pass, const CellBlock& block,
               double* cell_quality, double* sums) {
  const auto every_node = [](NodeIndex) { return true; };
  for_each_batch<dim, spacedim>(
      pass.mesh.topology(), block.first, block.last,
      [&](const auto& batch) { batch.store(pass.add(batch, every_node, sums), cell_quality); },
      [&](CellIndex c) { cell_quality[c] = pass.add_cell(c, every_node, sums); });
}

/// Adds some cells (ascending) to the sums of marked nodes only. The qualities of these cells are
/// known.
template <int dim, int spacedim, class... Rules>
void add_to_marked(const Pass<dim, spacedim, Rules...>& pass, std::span<const CellIndex> cells,
                   const std::vector<std::uint8_t>& marked, double* sums) {
  const auto wanted = [&](NodeIndex i) { return marked[i] != 0; };
  for_each_batch<dim, spacedim>(
      ListedCells(pass.mesh.topology(), cells),
      [&](const auto& batch) {
        pass.add(batch, wanted, sums);
        return true;
      },
      [&](std::size_t position) {
        pass.add_cell(cells[position], wanted, sums);
        return true;
      });
}

}  // namespace

template <int dim, int spacedim>
struct ElementPass<dim, spacedim>::Tables {
  std::optional<ElementRegularization<dim, spacedim>> element;
  NeighbourSizes<dim, spacedim> sizes;
  const double* prescribed = nullptr;
  std::vector<double> unit_sizes;  ///< of all cells, if the mesh has targets
  NodeSums sums;
  SumLimits limits;                        ///< in a part of a mesh
  std::optional<TermRounding> rounding;    ///< in a part of a mesh, for weights up to 1
  std::vector<PartialQuality> qualities;   ///< of each block of cells
  std::vector<std::uint8_t> marked_nodes;  ///< nodes whose sums have to be added again
  std::vector<std::uint8_t> marked_cells;  ///< cells that add to these sums

  /// True if element steps take target sizes that are measured on the mesh.
  bool measures() const { return element->fits_neighbours() && prescribed == nullptr; }

  const TermRounding* rounding_of_parts() const { return rounding ? &*rounding : nullptr; }

  /// Returns the quality of the mesh after all blocks. Collective in a part of a mesh.
  MeshQuality quality(const Topology& topology, const std::vector<double>& cell_quality) const {
    return topology.part() ? mesh_quality(topology, cell_quality)
                           : mesh_quality(qualities, topology.n_cells());
  }

  /// Returns the nodes of all cells around some nodes, without nodes that are already marked; marks
  /// them.
  std::vector<NodeIndex> nodes_around(const Topology& topology, std::span<const NodeIndex> nodes) {
    std::vector<NodeIndex> around;
    for (const NodeIndex i : nodes)
      for (const CellIndex c : topology.node_cells(i))
        for (const NodeIndex j : topology.cell_nodes(c))
          if (!std::exchange(marked_nodes[j], 1)) around.push_back(j);
    return around;
  }
  /// Returns the nodes of some cells.
  std::vector<NodeIndex> nodes_of(const Topology& topology, std::span<const CellIndex> cells) {
    marked_nodes.assign(topology.n_nodes(), 0);
    std::vector<NodeIndex> nodes;
    for (const CellIndex c : cells)
      for (const NodeIndex i : topology.cell_nodes(c))
        if (!std::exchange(marked_nodes[i], 1)) nodes.push_back(i);
    return nodes;
  }
};

template <int dim, int spacedim>
ElementPass<dim, spacedim>::ElementPass() : tables_(std::make_unique<Tables>()) {}
template <int dim, int spacedim>
ElementPass<dim, spacedim>::~ElementPass() = default;

template <int dim, int spacedim>
void ElementPass<dim, spacedim>::prepare(const Mesh<dim, spacedim>& mesh,
                                         const ElementParameters<dim>& parameters) {
  const Topology& topology = mesh.topology();
  tables_->element.emplace(mesh.targets() ? with_given_sizes(parameters) : parameters);
  tables_->unit_sizes.assign(mesh.targets() ? mesh.n_cells() : 0, 1.0);
  tables_->prescribed = mesh.targets() ? tables_->unit_sizes.data() : nullptr;
  tables_->sums.prepare(topology);
  tables_->rounding.reset();
  if (topology.part()) {
    tables_->limits = limits_of_sums(mesh);
    tables_->rounding.emplace(tables_->limits.length, tables_->limits.weight, spacedim);
  }
  tables_->qualities.resize(topology.blocks().size());
  sums_ = tables_->sums[0];
}

template <int dim, int spacedim>
void ElementPass<dim, spacedim>::prescribe_sizes(std::span<const double> of_cells) {
  tables_->prescribed = of_cells.data();
}

template <int dim, int spacedim>
MeshQuality ElementPass<dim, spacedim>::transform_all(SmoothingState<dim, spacedim>& state,
                                                      double eta) {
  const Topology& topology = state.mesh.topology();
  if (tables_->measures()) tables_->sizes.update(state.mesh);
  with_scaling<dim, spacedim>(tables_->element->fits_neighbours(), [&](auto fits) {
    const auto compute = [&](auto has_targets) {
      const Pass<dim, spacedim, QualityWeighting, decltype(fits), decltype(has_targets)> pass{
          state.mesh,     *tables_->element,
          tables_->sizes, tables_->prescribed,
          {eta},          fits,
          has_targets,    tables_->rounding_of_parts()};
      tables_->sums.compute([&](std::size_t b, double* sums) {
        add_block(pass, topology.blocks()[b], state.cell_quality.data(), sums);
        tables_->qualities[b] = PartialQuality(topology, state.cell_quality, topology.blocks()[b]);
      });
    };
    state.mesh.targets() == nullptr ? compute(std::false_type{}) : compute(true);
  });
  base_ = tables_->rounding ? state.mesh.coordinates().data() : nullptr;
  return tables_->quality(topology, state.cell_quality);
}

template <int dim, int spacedim>
MeshQuality ElementPass<dim, spacedim>::transform_around(SmoothingState<dim, spacedim>& state,
                                                         std::span<const NodeIndex> nodes,
                                                         double eta) {
  const Topology& topology = state.mesh.topology();
  auto& marked_nodes = tables_->marked_nodes;
  auto& marked_cells = tables_->marked_cells;
  marked_nodes.assign(topology.n_nodes(), 0);
  marked_cells.assign(topology.n_cells(), 0);
  auto changed_sums = tables_->nodes_around(topology, nodes);
  if (tables_->measures()) {  // cells of other sizes change the steps of others
    tables_->sizes.update(state.mesh, changed_sums);
    const auto further = tables_->nodes_around(topology, changed_sums);
    changed_sums.insert(changed_sums.end(), further.begin(), further.end());
  }
  if (4 * changed_sums.size() > topology.n_nodes()) return transform_all(state, eta);
  std::sort(changed_sums.begin(), changed_sums.end());
  for (const NodeIndex i : changed_sums)
    for (const CellIndex c : topology.node_cells(i)) marked_cells[c] = 1;
  std::vector<CellIndex> cells;
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    if (marked_cells[c]) cells.push_back(c);

  const Pass<dim, spacedim, QualityWeighting> pass{state.mesh,
                                                   *tables_->element,
                                                   tables_->sizes,
                                                   tables_->prescribed,
                                                   {eta},
                                                   tables_->element->fits_neighbours(),
                                                   state.mesh.targets() != nullptr,
                                                   tables_->rounding_of_parts()};
  tables_->sums.compute_some(
      changed_sums, cells,
      [&](std::size_t b, std::span<const CellIndex> cells_of_block, double* sums) {
        add_to_marked(pass, cells_of_block, marked_nodes, sums);
        tables_->qualities[b] = PartialQuality(topology, state.cell_quality, topology.blocks()[b]);
      });
  base_ = tables_->rounding ? state.mesh.coordinates().data() : nullptr;
  return tables_->quality(topology, state.cell_quality);
}

template <int dim, int spacedim>
void ElementPass<dim, spacedim>::transform_some(const SmoothingState<dim, spacedim>& state,
                                                std::span<const NodeIndex> nodes,
                                                std::span<const CellIndex> cells,
                                                std::span<const double> weights, double threshold) {
  if (tables_->measures()) {
    if (cells.size() == state.mesh.n_cells())
      tables_->sizes.update(state.mesh);
    else
      tables_->sizes.update(state.mesh, tables_->nodes_of(state.mesh.topology(), cells));
  }
  std::optional<TermRounding> rounding;
  if (const MeshPart* part = state.mesh.topology().part()) {
    double largest = 0.0;
    for (const CellIndex c : cells) largest = std::max(largest, weights[c]);
    largest = part->max(std::max(largest, 1.0));
    rounding.emplace(largest * tables_->limits.length, largest * tables_->limits.weight, spacedim);
  }
  const Pass<dim, spacedim, ThresholdWeighting> pass{state.mesh,
                                                     *tables_->element,
                                                     tables_->sizes,
                                                     tables_->prescribed,
                                                     {weights.data(), threshold},
                                                     tables_->element->fits_neighbours(),
                                                     state.mesh.targets() != nullptr,
                                                     rounding ? &*rounding : nullptr};
  auto& marked_nodes = tables_->marked_nodes;
  marked_nodes.assign(state.mesh.n_nodes(), 0);
  for (const NodeIndex i : nodes) marked_nodes[i] = 1;
  tables_->sums.compute_some(nodes, cells,
                             [&](std::size_t, std::span<const CellIndex> some, double* sums) {
                               add_to_marked(pass, some, marked_nodes, sums);
                             });
  base_ = rounding ? state.mesh.coordinates().data() : nullptr;
}

template class ElementPass<2>;
template class ElementPass<3>;
template class ElementPass<2, 3>;

}  // namespace smoothfem
