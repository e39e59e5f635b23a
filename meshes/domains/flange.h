// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A round flange with a hub, a bore through both and bolt holes on a circle through the disc; the
/// axis is z. Lengths are in units of the coordinates. Genus and bounding box are those of the
/// volume model of the thesis, Section 6.3, whose shape is not published. The proportions give its
/// ratio of surface to volume.
struct FlangeShape {
  static constexpr double radius = 8.0;
  static constexpr double disc_height = 4.0;  ///< the disc lies between z = 0 and here
  static constexpr double height = 9.0;       ///< the hub ends here
  static constexpr double hub_radius = 4.0;
  static constexpr double bore_radius = 1.5;
  static constexpr int n_bolts = 8;  ///< the first in the direction of x
  static constexpr double bolt_circle_radius = 6.0;
  static constexpr double bolt_radius = 0.8;
  static constexpr int genus = n_bolts + 1;
};

struct FlangeParameters {
  ElementType element_type = ElementType::tetrahedron;  ///< tetrahedron or hexahedron
  /// Factor on the edge lengths, from 1 to 4. A mesh with 1 has the thesis' size (566,004
  /// tetrahedra or 67,055 hexahedra) and edge_scale^3 times more cells.
  double edge_scale = 1.0;
};

/// Meshes the flange: tetrahedra by Gmsh's Delaunay mesher, hexahedra by sweeping quadrilaterals
/// along z. The number of cells is usually met within 2 %, always within 10 %. Where edges are
/// longer than a hole's gap to the rims (edge_scale above 2.5), hexahedra get flat. Boundary nodes
/// are fixed and lie on the planes and cylinders; cells are valid and all of one type.
///
/// Gmsh uses a fixed seed and one thread: with the same Gmsh and C library, equal parameters give
/// bitwise identical meshes. Takes a second for hexahedra, up to half a minute for tetrahedra.
/// Throws InputError for another element type, an edge scale out of range, and if the mesh turns
/// out to be invalid or of another genus.
VolumeMesh generate_flange(const FlangeParameters& parameters);

}  // namespace smoothfem
