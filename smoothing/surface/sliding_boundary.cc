// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/surface/sliding_boundary.h"

#include <algorithm>
#include <set>
#include <type_traits>

#include "smoothing/base/find_named.h"
#include "smoothing/mesh/boundary_tags.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/mesh/interfaces.h"
#include "smoothing/surface/line_constraints.h"

namespace smoothfem {

namespace {

/// Mean over the sides of all facets; in space each side belongs to two facets.
template <int dim>
double mean_edge_length(const CompressedRows<NodeIndex>& facets, std::span<const Point<dim>> x) {
  double sum = 0.0;
  std::size_t n_sides = 0;
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (std::size_t k = 0, n = facets[f].size(); k < (dim == 2 ? 1 : n); ++k, ++n_sides)
      sum += (x[facets[f][k]] - x[facets[f][k + 1 < n ? k + 1 : 0]]).norm();
  return sum / static_cast<double>(n_sides);
}

/// Returns the labelled edges of a volume mesh.
std::vector<std::array<NodeIndex, 2>> labelled_edges(const Topology& topology) {
  std::vector<std::array<NodeIndex, 2>> edges;
  const FileContent* content = topology.labels().content.get();
  if (topology.dimension() != 3 || content == nullptr) return edges;
  const OtherElements& others = content->others[1];
  for (std::size_t e = 0; e < others.nodes.size(); ++e)
    if (others.tags[e] != 0) edges.push_back({others.nodes[e][0], others.nodes[e][1]});
  return edges;
}

/// Flags labelled points, and nodes of labelled edges that are no sides of these facets.
std::vector<bool> nodes_off_facets(const Topology& topology,
                                   const CompressedRows<NodeIndex>& facets) {
  auto flags = labelled_points(topology);
  flags.resize(topology.n_nodes(), false);
  const auto edges = labelled_edges(topology);
  if (edges.empty()) return flags;
  std::set<std::array<NodeIndex, 2>> sides;
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (std::size_t k = 0, n = facets[f].size(); k < n; ++k) {
      const NodeIndex a = facets[f][k], b = facets[f][k + 1 < n ? k + 1 : 0];
      sides.insert({std::min(a, b), std::max(a, b)});
    }
  for (const auto& [a, b] : edges)
    if (!sides.contains({std::min(a, b), std::max(a, b)})) flags[a] = flags[b] = true;
  return flags;
}

template <int dim>
using Constraints = std::conditional_t<dim == 2, LineConstraints, SurfaceConstraints>;

}  // namespace

template <int dim>
SlidingFacets sliding_facets(const Mesh<dim>& mesh, SlidingSurfaces what) {
  const Topology& topology = mesh.topology();
  std::vector<FixedReasons> reasons = topology.fixed_reasons();
  const auto free = [&](NodeIndex i, FixedReasons removed) {
    reasons[i] &= static_cast<FixedReasons>(~removed);
  };
  SurfaceFacets surfaces;
  if (what.boundary) {
    surfaces = {topology.boundary_facets(), boundary_tags(topology), {}};
    // What the file marks on the boundary may be nothing but the boundary.
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      if (topology.on_boundary()[i]) free(i, bit(FixedReason::boundary) | bit(FixedReason::marked));
  }
  if (what.interfaces) {
    const Interfaces interfaces = inner_interfaces(topology);
    if (surfaces.tags.empty()) surfaces.tags.assign(surfaces.nodes.size(), 0);
    const auto stays = nodes_off_facets(topology, interfaces.facets);
    for (std::size_t f = 0; f < interfaces.facets.size(); ++f) {
      surfaces.nodes.append(interfaces.facets[f]);
      surfaces.tags.push_back(interfaces.tags[f]);
      for (const NodeIndex i : interfaces.facets[f])
        if (!stays[i]) free(i, bit(FixedReason::interface));
    }
  }
  surfaces.marked_edges = labelled_edges(topology);
  if (topology.midside())
    surfaces.midside =
        midside_of_facets(dim, topology.cells(), topology.midside()->of_cells, surfaces.nodes);
  return {std::move(surfaces), std::move(reasons)};
}

template <int dim>
std::shared_ptr<const NodeConstraints<dim>> sliding_constraints(
    const SurfaceFacets& facets, std::span<const Point<dim>> coordinates,
    const FeatureParameters& parameters, double slide_distance) {
  require_slide_distance(slide_distance);
  // Curved facets follow the surface, so that their chords may be far from it.
  const auto& midside = facets.midside.entries();
  const bool is_curved =
      std::any_of(midside.begin(), midside.end(), [](NodeIndex node) { return node != no_corner; });
  return std::make_shared<const Constraints<dim>>(
      facets, coordinates, parameters,
      is_curved ? NodeConstraints<dim>::unbounded
                : slide_distance * mean_edge_length<dim>(facets.nodes, coordinates));
}

template <int dim>
Mesh<dim> with_sliding_boundary(const Mesh<dim>& mesh, const FeatureParameters& parameters,
                                double slide_distance, SlidingSurfaces what) {
  SlidingFacets sliding = sliding_facets(mesh, what);
  auto constraints =
      sliding_constraints<dim>(sliding.facets, mesh.coordinates(), parameters, slide_distance);
  return with_fixed_nodes(Mesh<dim>(mesh.shared_topology(), mesh.copied_coordinates(),
                                    std::move(constraints), mesh.shared_targets()),
                          std::move(sliding.reasons));
}

template <int dim>
Mesh<dim> with_fixed_surfaces(const Mesh<dim>& mesh) {
  auto reasons = mesh.topology().fixed_reasons();
  for (NodeIndex i = 0; mesh.constraints() && i < mesh.n_nodes(); ++i)
    if (mesh.constraints()->classifications()[i].kind != GeometricClassification::none)
      reasons[i] |=
          bit(mesh.topology().on_boundary()[i] ? FixedReason::boundary : FixedReason::interface);
  return with_fixed_nodes(
      Mesh<dim>(mesh.shared_topology(), mesh.copied_coordinates(), nullptr, mesh.shared_targets()),
      std::move(reasons));
}

InterfaceRule interface_rule(const std::string& name) {
  const auto& names = interface_rule_names;
  const auto& found = find_named("interfaces", name, names, [](std::string_view n) { return n; });
  return static_cast<InterfaceRule>(&found - names.data());
}

SurfaceMesh with_interface_rule(const SurfaceMesh& mesh, InterfaceRule rule,
                                const FeatureParameters& parameters) {
  const Topology& topology = mesh.topology();
  if (rule == InterfaceRule::fixed || !any_node_has(topology, bit(FixedReason::interface)))
    return mesh;
  auto reasons = without(topology.fixed_reasons(), bit(FixedReason::interface));
  if (rule == InterfaceRule::slide) {
    const auto points = labelled_points(topology);
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i]) reasons[i] |= bit(FixedReason::interface);
    return with_fixed_nodes(mesh, std::move(reasons));
  }
  auto constraints = std::make_shared<const SurfaceConstraints>(
      SurfaceFacets{topology.cells(), {}, {}}, mesh.coordinates(), parameters);
  return with_fixed_nodes(
      SurfaceMesh(mesh.shared_topology(), mesh.copied_coordinates(), std::move(constraints)),
      without(reasons, bit(FixedReason::corner)));
}

template <int dim>
Mesh<dim> with_interface_rule(const Mesh<dim>& mesh, InterfaceRule rule, bool boundary_slides,
                              const FeatureParameters& parameters, double slide_distance) {
  const bool has_interfaces = any_node_has(mesh.topology(), bit(FixedReason::interface));
  Mesh<dim> result = mesh;
  if (rule == InterfaceRule::free && has_interfaces)
    result = with_fixed_nodes(
        std::move(result), without(mesh.topology().fixed_reasons(), bit(FixedReason::interface)));
  const SlidingSurfaces sliding{.boundary = boundary_slides,
                                .interfaces = rule == InterfaceRule::slide && has_interfaces};
  if (!sliding.boundary && !sliding.interfaces) return result;
  return with_sliding_boundary(result, parameters, slide_distance, sliding);
}

#define SMOOTHFEM_INSTANTIATE(dim)                                                             \
  template SlidingFacets sliding_facets(const Mesh<dim>&, SlidingSurfaces);                    \
  template std::shared_ptr<const NodeConstraints<dim>> sliding_constraints(                    \
      const SurfaceFacets&, std::span<const Point<dim>>, const FeatureParameters&, double);    \
  template Mesh<dim> with_sliding_boundary(const Mesh<dim>&, const FeatureParameters&, double, \
                                           SlidingSurfaces);                                   \
  template Mesh<dim> with_fixed_surfaces(const Mesh<dim>&);                                    \
  template Mesh<dim> with_interface_rule(const Mesh<dim>&, InterfaceRule, bool,                \
                                         const FeatureParameters&, double);
SMOOTHFEM_INSTANTIATE(2)
SMOOTHFEM_INSTANTIATE(3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
