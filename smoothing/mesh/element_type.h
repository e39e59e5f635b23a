#pragma once

#include <cstdint>
#include <string_view>

namespace smoothfem {

/// Shape of a cell. A polygon is any planar cell with five or more nodes; its number of nodes is
/// the length of its row in the topology. Nodes of planar cells run counterclockwise.
enum class ElementType : std::uint8_t { triangle, quadrilateral, polygon };

constexpr std::string_view name_of(ElementType type) {
  switch (type) {
    case ElementType::triangle:
      return "triangle";
    case ElementType::quadrilateral:
      return "quadrilateral";
    case ElementType::polygon:
      return "polygon";
  }
  return "unknown";
}

/// Type of the planar cell with n_nodes >= 3 nodes.
constexpr ElementType planar_element_type(std::size_t n_nodes) {
  return n_nodes == 3   ? ElementType::triangle
         : n_nodes == 4 ? ElementType::quadrilateral
                        : ElementType::polygon;
}

}  // namespace smoothfem
