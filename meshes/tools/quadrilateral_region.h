// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshes/tools/gmsh_planar.h"

namespace smoothfem {

/// Makes quadrilaterals with edges of about edge_length between polygons whose numbers of corners
/// are even. Gmsh meshes the region of every second corner, and all its cells' edges are halved.
/// The polygons' edges are the only boundary edges. Throws InputError with Gmsh's message if it
/// fails.
PlanarCells mesh_quadrilaterals(const Polygons& polygons, double edge_length,
                                const RegionMeshing& meshing = {});

/// Parameters for making a mesh of quadrilaterals from Gmsh's mesh.
struct QuadrilateralMeshing {
  /// More halvings leave fewer irregular nodes. Numbers of corners must then be multiples of
  /// 2^n_halvings, and the number of cells is met up to 4^(n_halvings - 1).
  int n_halvings = 1;
  PlanarPattern pattern = PlanarPattern::quadrilaterals;
};

/// Makes a mesh with a given number of cells, by cutting some of Gmsh's cells before the halving.
/// The number is met exactly; it is one less if the number of boundary edges excludes its parity.
/// It is larger on boundaries too coarse for so few cells. Throws InputError with Gmsh's message if
/// it cannot mesh the region.
PlanarCells mesh_with_n_quadrilaterals(const Polygons& polygons, std::size_t n_cells,
                                       const QuadrilateralMeshing& meshing = {});

/// Makes the mesh for a region with n_boundary_edges, a multiple of 2^n_halvings. edge_scale, at
/// least 1, multiplies the edge lengths and gives fewer edges and cells.
PlanarCells mesh_with_n_quadrilaterals(const std::vector<Outline>& outlines, std::size_t n_cells,
                                       std::size_t n_boundary_edges, double edge_scale,
                                       const QuadrilateralMeshing& meshing = {});

/// Smooths valid cells by GETMe; boundary nodes stay.
void smooth_quadrilaterals(PlanarCells& cells);

}  // namespace smoothfem
