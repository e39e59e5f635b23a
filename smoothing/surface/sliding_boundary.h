// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "smoothing/surface/surface_constraints.h"

namespace smoothfem {

/// Default of the largest distance of a sliding boundary's facets from the initial one, as a
/// fraction of its mean edge length. The chord between the midpoints of two facets has this
/// distance if they meet at 23 degrees. So coarse meshes of curved boundaries keep their shape;
/// other meshes hardly notice.
constexpr double default_slide_distance = 0.1;

/// Surfaces (in the plane: curves) that nodes slide on.
struct SlidingSurfaces {
  bool boundary = true, interfaces = false;
};

/// Facets of a mesh that nodes slide on, and why nodes stay when they do.
struct SlidingFacets {
  SurfaceFacets facets;
  std::vector<FixedReasons> reasons;
};
template <int dim>
SlidingFacets sliding_facets(const Mesh<dim>& mesh, SlidingSurfaces what);

/// Makes the constraints of nodes with these coordinates; see with_sliding_boundary.
template <int dim>
std::shared_ptr<const NodeConstraints<dim>> sliding_constraints(
    const SurfaceFacets& facets, std::span<const Point<dim>> coordinates,
    const FeatureParameters& parameters, double slide_distance);

/// Returns a planar or volume mesh whose boundary nodes slide on its present boundary. Nodes of
/// feature lines slide along them, and corners stay. Features follow from the parameters and from
/// borders between labelled facets of different tags. Inner nodes keep their reasons to stay.
/// slide_distance: largest distance from the boundary of the midpoints of facets and of their
/// sides, as a fraction of the boundary's mean edge length. Facets cut across curved parts; steps
/// beyond the distance are not taken. Facets of second order have no such limit, as their midside
/// nodes lie on the boundary. Throws InputError unless it is above 0; infinity means no
/// limit. what: which surfaces nodes slide on. Interfaces are those of inner_interfaces(); where
/// they meet each other or the boundary are feature lines (in the plane: corners). Nodes of
/// surfaces that do not slide stay.
template <int dim>
Mesh<dim> with_sliding_boundary(const Mesh<dim>& mesh, const FeatureParameters& parameters = {},
                                double slide_distance = default_slide_distance,
                                SlidingSurfaces what = {});

/// Returns the mesh without constraints; the nodes that these kept on surfaces stay where they are.
template <int dim>
Mesh<dim> with_fixed_surfaces(const Mesh<dim>& mesh);

/// Rule for the nodes of interfaces, which by default stay where they are.
enum class InterfaceRule { fixed, slide, free };
/// Users' names, in the order of the values.
inline constexpr std::array<std::string_view, 3> interface_rule_names{"fixed", "slide", "free"};
/// Returns the rule with this name. Throws InputError if there is none.
InterfaceRule interface_rule(const std::string& name);

/// Returns a surface mesh with this rule for its interfaces, which are lines on the surface. Lines
/// of free interfaces are no features. Throws InputError as find_features does.
SurfaceMesh with_interface_rule(const SurfaceMesh& mesh, InterfaceRule rule,
                                const FeatureParameters& parameters = {});

/// Returns the mesh with this rule for its interfaces, and with a boundary that slides if asked
/// for. Throws InputError as with_sliding_boundary does.
template <int dim>
Mesh<dim> with_interface_rule(const Mesh<dim>& mesh, InterfaceRule rule, bool boundary_slides,
                              const FeatureParameters& parameters = {},
                              double slide_distance = default_slide_distance);

}  // namespace smoothfem
