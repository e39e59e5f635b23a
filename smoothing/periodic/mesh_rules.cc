// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/periodic/mesh_rules.h"

#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/periodic/smooth_periodic.h"
#include "smoothing/second_order/smooth_second_order.h"

namespace smoothfem {

bool moves_partners(const Topology& topology, const MeshRules& rules) {
  return rules.joins_periodic ||
         (rules.boundary_slides && any_node_has(topology, bit(FixedReason::periodic)));
}

template <int dim>
SmoothingResult smooth_by_rules(Mesh<dim>& mesh, Method<dim>& method, const MeshRules& rules,
                                const std::type_identity_t<Observer<dim>>& observer) {
  if (!moves_partners(mesh.topology(), rules)) return smooth(mesh, method, observer);
  if (mesh.topology().midside() && mesh.constraints())
    throw InputError(
        "periodic partners cannot slide in meshes of second order; leave the boundary and the "
        "interfaces fixed, or save the mesh with linear cells");
  if (mesh.topology().midside() && moves_midside_nodes(method))
    throw InputError("method " + method.info.name +
                     " moves midside nodes, which cannot move together with periodic partners; "
                     "leave these fixed, or use a method that moves corners");
  if (mesh.topology().midside())
    return smooth_second_order(mesh, CornerNumbers::of_mesh, method.floor != 0, observer,
                               [&](Mesh<dim>& corners, const Observer<dim>& of_corners) {
                                 return smooth_by_rules(corners, method, rules, of_corners);
                               });
  PeriodicParameters<dim> parameters;
  if (mesh.constraints()) {
    const SlidingSurfaces sliding{.boundary = rules.boundary_slides,
                                  .interfaces = rules.interfaces == InterfaceRule::slide};
    SurfaceFacets facets = sliding_facets(mesh, sliding).facets;
    if (rules.joins_periodic) facets = without_periodic_facets(mesh, facets);
    if (!facets.nodes.empty())
      parameters.make_constraints = [facets, rules](std::span<const Point<dim>> x) {
        return sliding_constraints<dim>(facets, x, rules.features, rules.slide_distance);
      };
  }
  return smooth_periodic(mesh, method, observer, parameters);
}

template SmoothingResult smooth_by_rules(Mesh<2>&, Method<2>&, const MeshRules&,
                                         const Observer<2>&);
template SmoothingResult smooth_by_rules(Mesh<3>&, Method<3>&, const MeshRules&,
                                         const Observer<3>&);

}  // namespace smoothfem
