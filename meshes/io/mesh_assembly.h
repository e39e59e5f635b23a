#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// What the reader of any format collects; node indices are the file's order, from 0.
struct MeshParts {
  std::vector<Point<2>> coordinates;
  CompressedRows<NodeIndex> cells;
  std::optional<std::vector<bool>> fixed;  ///< without it the boundary nodes are fixed
  MeshLabels labels;
  std::vector<std::size_t> cell_lines;  ///< empty, or the line of every cell
};

/// Makes the mesh; errors of the mesh become InputErrors that start with "path:line: " or "path: ".
MeshFile assemble_mesh(const std::filesystem::path& path, MeshParts parts);

/// Removes nodes that neither a cell nor a facet uses (points of a CAD model), keeping the order.
void drop_unused_nodes(MeshParts& parts);

}  // namespace smoothfem
