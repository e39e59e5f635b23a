// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshes/tools/gmsh_planar.h"

namespace smoothfem {

/// Quadrilaterals of about an edge length between polygons whose numbers of corners are even: Gmsh
/// meshes the region of every second corner, and all its cells' edges are halved. The polygons'
/// edges are the only boundary edges. Throws InputError with Gmsh's words if it cannot.
PlanarCells mesh_quadrilaterals(const Polygons& polygons, double edge_length);

/// How a mesh of quadrilaterals comes from Gmsh's.
struct QuadrilateralMeshing {
  /// More than one leave fewer irregular nodes; numbers of corners are then multiples of
  /// 2^n_halvings, and the number of cells is met up to 4^(n_halvings - 1).
  int n_halvings = 1;
  PlanarPattern pattern = PlanarPattern::quadrilaterals;
};

/// The same with a given number of cells. It is met exactly (one less where the number of boundary
/// edges allows no even, or no odd, number of cells) by cutting some of Gmsh's cells before the
/// halving, except on boundaries too coarse for so few cells: there it is larger. Throws InputError
/// with Gmsh's words if it cannot mesh the region.
PlanarCells mesh_with_n_quadrilaterals(const Polygons& polygons, std::size_t n_cells,
                                       const QuadrilateralMeshing& meshing = {});

/// The same for a region with so many boundary edges, a multiple of 2^n_halvings; edge_scale, from
/// 1 on, times longer edges give fewer of them, and fewer cells.
PlanarCells mesh_with_n_quadrilaterals(const std::vector<Outline>& outlines, std::size_t n_cells,
                                       std::size_t n_boundary_edges, double edge_scale,
                                       const QuadrilateralMeshing& meshing = {});

/// Smooths valid cells by GETMe; boundary nodes stay.
void smooth_quadrilaterals(PlanarCells& cells);

}  // namespace smoothfem
