// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/loop/smooth.h"
#include "smoothing/surface/sliding_boundary.h"

namespace smoothfem {

/// Rules of a user for nodes that by default stay.
struct MeshRules {
  InterfaceRule interfaces = InterfaceRule::fixed;
  bool boundary_slides = false;
  bool joins_periodic = false;  ///< periodic nodes move as inner nodes of a torus
  FeatureParameters features = {};
  double slide_distance = default_slide_distance;
};

/// Returns the mesh with the rules for interfaces and for the boundary. Throws InputError as
/// with_sliding_boundary does.
template <int dim>
Mesh<dim> with_rules(const Mesh<dim>& mesh, const MeshRules& rules) {
  return with_interface_rule(mesh, rules.interfaces, rules.boundary_slides, rules.features,
                             rules.slide_distance);
}

/// True if periodic partners move: if they are joined, or if the boundary of a periodic mesh
/// slides.
bool moves_partners(const Topology& topology, const MeshRules& rules);

/// Smooths a mesh of with_rules(). Periodic partners move together (smooth_periodic.h) or stay.
template <int dim>
SmoothingResult smooth_by_rules(Mesh<dim>& mesh, Method<dim>& method, const MeshRules& rules,
                                const std::type_identity_t<Observer<dim>>& observer = {});

}  // namespace smoothfem
