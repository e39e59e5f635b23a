// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/external/text_vtk.h"

#include <string>

#include "meshes/io/atomic_file.h"
#include "meshes/io/node_order.h"
#include "meshes/io/vtk/vtk_files.h"
#include "smoothing/base/text.h"

namespace smoothfem {

void write_text_vtk(const std::filesystem::path& path, const MeshView& mesh) {
  const Topology& topology = mesh.topology();
  std::string text =
      "# vtk DataFile Version 3.0\nsmoothfem mesh\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  text += "POINTS " + std::to_string(mesh.n_nodes()) + " double\n";
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    const Point<3> p = mesh.point(i);
    for (int d = 0; d < 3; ++d) {
      append_number(text, p[d]);
      text += d < 2 ? ' ' : '\n';
    }
  }
  text += "CELLS " + std::to_string(mesh.n_cells()) + " " +
          std::to_string(mesh.n_cells() + topology.cells().n_entries()) + "\n";
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = topology.cell_nodes(c);
    text += std::to_string(nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k)
      text += " " +
              std::to_string(nodes[topology.cell_type(c) == ElementType::prism ? vtk_wedge[k] : k]);
    text += '\n';
  }
  text += "CELL_TYPES " + std::to_string(mesh.n_cells()) + "\n";
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    text += std::to_string(vtk_type(topology.cell_type(c))) + "\n";
  text += "POINT_DATA " + std::to_string(mesh.n_nodes()) +
          "\nSCALARS fixed int 1\nLOOKUP_TABLE default\n";
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) text += topology.is_fixed(i) ? "1\n" : "0\n";
  write_atomically(path, text);
}

}  // namespace smoothfem
