// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/space/fill_triangulation.h"

#include <deal.II/grid/grid_tools.h>

#include <algorithm>

namespace smoothfem {

template <int dim>
void fill_triangulation(const Mesh<dim>& mesh, const std::vector<unsigned int>& materials,
                        dealii::Triangulation<dim>& triangulation) {
  std::vector<dealii::Point<dim>> vertices;
  for (const auto& p : mesh.coordinates()) {
    vertices.emplace_back();
    for (int d = 0; d < dim; ++d) vertices.back()[d] = p[d];
  }
  std::vector<dealii::CellData<dim>> cells;
  bool all_quadrilaterals = dim == 2;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = mesh.topology().cell_nodes(c);
    dealii::CellData<dim> cell(static_cast<unsigned int>(nodes.size()));
    std::copy(nodes.begin(), nodes.end(), cell.vertices.begin());
    const ElementType type = mesh.topology().cell_type(c);
    const bool tensor = type == ElementType::quadrilateral || type == ElementType::hexahedron;
    // deal.II lists the nodes of quadrilaterals, also of a pyramid's base, in lexicographic order.
    for (std::size_t k = 2; tensor && k < nodes.size(); k += 4)
      std::swap(cell.vertices[k], cell.vertices[k + 1]);
    if (type == ElementType::pyramid) std::swap(cell.vertices[2], cell.vertices[3]);
    all_quadrilaterals &= tensor;
    if (!materials.empty()) cell.material_id = materials[c];
    cells.push_back(cell);
  }
  if (all_quadrilaterals) dealii::GridTools::consistently_order_cells(cells);
  triangulation.create_triangulation(vertices, cells, dealii::SubCellData());
}

template void fill_triangulation(const Mesh<2>&, const std::vector<unsigned int>&,
                                 dealii::Triangulation<2>&);
template void fill_triangulation(const Mesh<3>&, const std::vector<unsigned int>&,
                                 dealii::Triangulation<3>&);

}  // namespace smoothfem
