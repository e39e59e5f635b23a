// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/outline.h"

namespace smoothfem {

/// A closed outline whose edges are shorter than those of the others by a factor.
struct ShapeOutline {
  Outline curves;
  double edge_factor = 1.0;
};

/// A planar region: inside the first outline and outside the others.
struct Shape {
  std::vector<ShapeOutline> outlines;

  /// Returns polygons with edges of about this length, a multiple of `multiple_of` on each curve.
  /// at: position of the points along the edges; see divide().
  Polygons polygons(double edge_length, std::size_t multiple_of, double at = 0.0) const;
  /// True if edges grow from some outlines to others.
  bool is_graded() const;
};

/// Registers a domain, given without its function `make`, whose meshes are made of a form (a Shape,
/// or a solid made of one). mesh_form(name, form, parameters): the mesh.
template <class Form>
RegisteredDomain registered_form(Domain domain, Form (*form)(),
                                 AnyMesh (*mesh_form)(const std::string&, const Form&,
                                                      const DomainParameters&)) {
  domain.make = [=, name = domain.name](const DomainParameters& p) {
    return mesh_form(name, form(), p);
  };
  return RegisteredDomain(std::move(domain));
}

/// A disc of radius 1 with a round hole of radius 0.6.
Shape washer_shape();
/// Six fins on a base.
Shape comb_shape(double fin_width);
/// An L with a rounded inner corner, three round holes and a slot.
Shape bracket_shape();
/// A channel between two waves, 8 long.
Shape channel_shape(double width);
/// A star with five points.
Shape star_shape();
/// The section of a symmetric wing of chord 1 (four-digit NACA section with a sharp trailing edge).
/// thickness: largest one, as a fraction of the chord.
Outline airfoil(double thickness);

}  // namespace smoothfem
