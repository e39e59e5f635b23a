// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/materials/cell_kinds.h"

#include "smoothing/mesh/interfaces.h"

namespace smoothfem {

std::vector<std::uint32_t> cell_kinds(const Topology& topology) {
  const auto materials = cell_materials(topology);
  if (materials.empty()) return std::vector<std::uint32_t>(topology.n_cells(), 0);
  return {materials.begin(), materials.end()};
}

std::vector<std::vector<std::string>> groups_of_kinds(const Topology& topology,
                                                      const std::vector<std::uint32_t>& kinds) {
  const MeshLabels& labels = topology.labels();
  const FileContent* content = labels.content.get();
  const bool has_entities = content && !content->cell_entities.empty();
  std::vector<std::vector<std::string>> groups;
  std::vector<bool> known;
  for (CellIndex c = 0; c < kinds.size(); ++c) {
    if (kinds[c] >= groups.size()) {
      groups.resize(kinds[c] + 1);
      known.resize(kinds[c] + 1, false);
    }
    if (known[kinds[c]] || labels.cell_tags.empty()) continue;
    known[kinds[c]] = true;
    const int dim = topology.dimension();
    for (const int tag : groups_of(content, dim, has_entities ? content->cell_entities[c] : 0,
                                   labels.cell_tags[c])) {
      groups[kinds[c]].push_back(std::to_string(tag));
      if (const auto name = labels.names.find({dim, tag}); name != labels.names.end())
        groups[kinds[c]].push_back(name->second);
    }
  }
  return groups;
}

}  // namespace smoothfem
