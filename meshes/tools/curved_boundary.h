// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <span>
#include <variant>

#include "meshes/tools/outline.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Takes a point of a boundary facet of a mesh to its place on the boundary of the domain. corners:
/// of the facet; they lie on the boundary.
template <int dim>
using OntoBoundary =
    std::function<Point<dim>(std::span<const Point<dim>> corners, const Point<dim>& point)>;
using AnyOntoBoundary = std::variant<OntoBoundary<2>, OntoBoundary<3>>;

/// Returns a mesh with midside nodes on all edges (TRI6, QUAD8, TET10, HEX20, ...): those of the
/// boundary on the boundary of the domain, the others in the middle of their edges.
template <int dim>
Mesh<dim> with_curved_boundary(const Mesh<dim>& linear, const OntoBoundary<dim>& onto);

/// Returns the boundary that has these points in the middle of the polygons' edges. Facets that are
/// not edges of the polygons, with exactly their corners, are straight.
OntoBoundary<2> boundary_through(const Polygons& corners, const Polygons& middles);

/// The boundary of domains with straight edges and flat faces.
template <int dim>
OntoBoundary<dim> flat_boundary() {
  return [](std::span<const Point<dim>>, const Point<dim>& point) { return point; };
}

}  // namespace smoothfem
