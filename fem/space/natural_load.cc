// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/space/natural_load.h"

#include <algorithm>
#include <map>

#include "smoothing/simd/vectors.h"

namespace smoothfem {

namespace {

/// Maps the mesh's nodes of facets to local nodes.
template <int dim>
std::map<NodeIndex, NodeIndex> local_nodes(const NaturalBoundary& natural,
                                           const FiniteElementSpace<dim>& space) {
  std::map<NodeIndex, NodeIndex> local;
  for (const auto& facet : natural.facets())
    for (const NodeIndex node : facet) local[node] = FiniteElementSpace<dim>::absent;
  for (NodeIndex i = 0; i < space.nodes.size(); ++i)
    if (const auto found = local.find(space.nodes[i]); found != local.end()) found->second = i;
  return local;
}

/// Maps the nodes whose mean is a dof's position to the dof.
template <int dim>
std::map<std::vector<NodeIndex>, std::uint32_t> dofs_by_nodes(
    const std::map<NodeIndex, NodeIndex>& nodes, const FiniteElementSpace<dim>& space) {
  std::vector<bool> on_facets(space.nodes.size(), false);
  for (const auto& [node, local] : nodes)
    if (local != space.absent) on_facets[local] = true;
  std::map<std::vector<NodeIndex>, std::uint32_t> dofs;
  for (std::uint32_t dof = 0; dof < space.n_local; ++dof) {
    const auto row = space.dof_nodes[dof];
    if (std::all_of(row.begin(), row.end(), [&](NodeIndex node) { return on_facets[node]; }))
      dofs[{row.begin(), row.end()}] = dof;
  }
  return dofs;
}

}  // namespace

template <int dim>
void find_natural_facets(const NaturalBoundary& natural, CurvedPoints<dim>* curved,
                         FiniteElementSpace<dim>& space) {
  if (natural.empty()) return;
  const auto nodes = local_nodes(natural, space);
  const auto dofs = dofs_by_nodes(nodes, space);
  std::map<std::size_t, NaturalFacets> groups;
  for (std::size_t f = 0; f < natural.facets().size(); ++f) {
    const auto& facet = natural.facets()[f];
    std::vector<NodeIndex> vertices;
    for (const NodeIndex node : facet) vertices.push_back(nodes.at(node));
    if (std::count(vertices.begin(), vertices.end(), space.absent) > 0) continue;
    if (vertices.size() == 4) std::swap(vertices[2], vertices[3]);  // deal.II's order
    auto& group = groups[vertices.size()];
    if (group.element.n_vertices == 0)
      group.element = make_facet_element(vertices.size(), space.degree, space.is_curved);
    std::vector<std::uint32_t> of_facet;
    for (std::size_t i = 0; i < group.element.n_dofs; ++i) {
      std::vector<NodeIndex> around;
      for (std::size_t v = 0; v < vertices.size(); ++v)
        if (group.element.support[i * vertices.size() + v] > 1e-12) around.push_back(vertices[v]);
      std::sort(around.begin(), around.end());
      if (const auto found = dofs.find(around); found != dofs.end())
        of_facet.push_back(found->second);
    }
    // If dofs are missing, the facet's cell belongs to another rank and contributes to no equation
    // here.
    if (of_facet.size() < group.element.n_dofs) continue;
    if (curved != nullptr)
      curved->append_facet(group.element.mapping, vertices, group.points);
    else
      group.points.insert(group.points.end(), vertices.begin(), vertices.end());
    group.dofs.insert(group.dofs.end(), of_facet.begin(), of_facet.end());
    group.kinds.push_back(natural.kinds()[f]);
  }
  for (auto& [n_vertices, group] : groups) space.natural_facets.push_back(std::move(group));
}

namespace {

/// Returns the position at a point of the rule, and the outward normal. Its length is that of the
/// line, or the area, that a unit of the reference facet covers there.
template <int dim>
struct FacetPoint {
  Point<dim> position = Point<dim>::Zero(), normal;

  FacetPoint(const FacetElement& element, std::size_t q, const NodeIndex* points,
             const std::vector<Point<dim>>& x) {
    std::array<Point<dim>, dim - 1> tangents;
    tangents.fill(Point<dim>::Zero());
    const std::size_t n_points = element.mapping.size();
    for (std::size_t p = 0; p < n_points; ++p) {
      const std::size_t k = q * n_points + p;
      position += element.rule.geometry[k] * x[points[p]];
      for (std::size_t d = 0; d + 1 < dim; ++d)
        tangents[d] += element.rule.geometry_gradient[(dim - 1) * k + d] * x[points[p]];
    }
    if constexpr (dim == 2)
      normal = {tangents[0].y(), -tangents[0].x()};
    else
      normal = point_of(cross(vector_of(tangents[0]), vector_of(tangents[1])));
  }
};

}  // namespace

template <int dim>
void add_natural_load(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
                      const ManufacturedSolution<dim>& solution,
                      const std::vector<std::uint32_t>& materials,
                      Eigen::VectorXd& right_hand_side) {
  for (const auto& group : space.natural_facets) {
    const FacetElement& element = group.element;
    for (std::size_t f = 0; f < group.kinds.size(); ++f)
      for (std::size_t q = 0; q < element.rule.n_points; ++q) {
        const FacetPoint<dim> at(element, q, &group.points[f * element.mapping.size()], x);
        Point<dim> flux = solution.value_and_gradient(at.position).gradient;
        if (!materials.empty())
          flux = solution.materials[materials[group.kinds[f]]].diffusivity(at.position) * flux;
        else if (solution.diffusivity)
          flux = solution.diffusivity(at.position) * flux;
        const double weighted = element.rule.weights[q] * flux.dot(at.normal);
        for (std::size_t i = 0; i < element.n_dofs; ++i) {
          const double part = weighted * element.rule.shape[q * element.n_dofs + i];
          space.for_each_master(group.dofs[f * element.n_dofs + i],
                                [&](std::uint32_t row, double weight) {
                                  if (row < space.n_own) right_hand_side[row] += weight * part;
                                });
        }
      }
  }
}

#define SMOOTHFEM_INSTANTIATE(dim)                                                               \
  template void find_natural_facets(const NaturalBoundary&, CurvedPoints<dim>*,                  \
                                    FiniteElementSpace<dim>&);                                   \
  template void add_natural_load(const FiniteElementSpace<dim>&, const std::vector<Point<dim>>&, \
                                 const ManufacturedSolution<dim>&,                               \
                                 const std::vector<std::uint32_t>&, Eigen::VectorXd&);
SMOOTHFEM_INSTANTIATE(2)
SMOOTHFEM_INSTANTIATE(3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
