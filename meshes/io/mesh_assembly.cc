#include "meshes/io/mesh_assembly.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <string>

#include "smoothing/mesh/input_error.h"

namespace smoothfem {

MeshFile assemble_mesh(const std::filesystem::path& path, MeshParts parts) {
  const std::size_t n_nodes = parts.coordinates.size();
  try {
    auto topology = std::make_shared<const Topology>(
        2, n_nodes, std::move(parts.cells), std::move(parts.fixed), std::move(parts.labels));
    return {PlanarMesh(std::move(topology), std::move(parts.coordinates)),
            std::move(parts.cell_lines)};
  } catch (const CellError& error) {
    std::string place = path.string() + ":";
    if (!parts.cell_lines.empty()) place += std::to_string(parts.cell_lines[error.cell()]) + ":";
    throw InputError(place + " " + error.what());
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

namespace {

CompressedRows<NodeIndex> renumbered(const CompressedRows<NodeIndex>& rows,
                                     const std::vector<NodeIndex>& new_index) {
  CompressedRows<NodeIndex> result;
  std::vector<NodeIndex> nodes;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    nodes.clear();
    for (const NodeIndex node : rows[i]) nodes.push_back(new_index[node]);
    result.append(nodes);
  }
  return result;
}

}  // namespace

void drop_unused_nodes(MeshParts& parts) {
  constexpr NodeIndex unused = std::numeric_limits<NodeIndex>::max();
  std::vector<NodeIndex> new_index(parts.coordinates.size(), unused);
  for (const auto* rows : {&parts.cells, &parts.labels.facets})
    for (const NodeIndex node : rows->entries()) new_index[node] = 0;
  NodeIndex n_used = 0;
  for (std::size_t i = 0; i < new_index.size(); ++i) {
    if (new_index[i] == unused) continue;
    new_index[i] = n_used;
    parts.coordinates[n_used] = parts.coordinates[i];
    if (parts.fixed) (*parts.fixed)[n_used] = (*parts.fixed)[i];
    ++n_used;
  }
  if (n_used == parts.coordinates.size()) return;
  parts.coordinates.resize(n_used);
  if (parts.fixed) parts.fixed->resize(n_used);
  parts.cells = renumbered(parts.cells, new_index);
  parts.labels.facets = renumbered(parts.labels.facets, new_index);
}

}  // namespace smoothfem
