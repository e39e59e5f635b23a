// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace smoothfem {

/// Shape of a cell. A polygon is any planar cell with five or more nodes. Dimension and number of
/// nodes determine the type. Nodes of planar cells run counterclockwise; volume_elements.h draws
/// the node order of volume cells.
enum class ElementType : std::uint8_t {
  triangle,
  quadrilateral,
  polygon,
  tetrahedron,
  pyramid,
  prism,
  hexahedron
};

constexpr std::string_view name_of(ElementType type) {
  switch (type) {
    case ElementType::triangle:
      return "triangle";
    case ElementType::quadrilateral:
      return "quadrilateral";
    case ElementType::polygon:
      return "polygon";
    case ElementType::tetrahedron:
      return "tetrahedron";
    case ElementType::pyramid:
      return "pyramid";
    case ElementType::prism:
      return "prism";
    case ElementType::hexahedron:
      return "hexahedron";
  }
  return "unknown";
}

/// Returns the dimension of the cell, 2 or 3.
constexpr int dimension_of(ElementType type) {
  return type <= ElementType::polygon ? 2 : 3;
}

/// True if a cell of a mesh of this dimension (2 or 3) can have n_nodes nodes.
constexpr bool is_cell_size(int dim, std::size_t n_nodes) {
  return dim == 2 ? n_nodes >= 3 : (n_nodes >= 4 && n_nodes <= 6) || n_nodes == 8;
}

/// Returns the type of the cell with n_nodes nodes. Requires is_cell_size(dim, n_nodes).
constexpr ElementType element_type(int dim, std::size_t n_nodes) {
  if (dim == 2)
    return n_nodes == 3   ? ElementType::triangle
           : n_nodes == 4 ? ElementType::quadrilateral
                          : ElementType::polygon;
  return n_nodes == 4   ? ElementType::tetrahedron
         : n_nodes == 5 ? ElementType::pyramid
         : n_nodes == 6 ? ElementType::prism
                        : ElementType::hexahedron;
}

}  // namespace smoothfem
