// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cassert>
#include <cstdint>
#include <map>
#include <vector>

#include "meshes/io/gmsh/msh_elements.h"
#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// The cells, or the labelled facets, of one physical tag. Gmsh sorts elements by the entities of
/// its model.
struct MshEntity {
  int dimension;
  int number = 0;                                       ///< from 1 in each dimension
  int group = 0;                                        ///< physical tag; 0 means none
  std::map<int, std::vector<std::uint32_t>> by_type{};  ///< cells or facets by Gmsh's type
};

/// Appends one entity for each tag, in ascending order. rows: nodes of the elements, all of types
/// that Gmsh has. tags: of the rows; empty if they have none.
inline void append_msh_entities(std::vector<MshEntity>& entities, int dimension,
                                const CompressedRows<NodeIndex>& rows,
                                const std::vector<int>& tags) {
  std::map<int, MshEntity> by_tag;
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    const MshElementType* type = msh_element_type(dimension, rows[i].size());
    assert(type);
    by_tag.try_emplace(tags.empty() ? 0 : tags[i], MshEntity{dimension})
        .first->second.by_type[type->number]
        .push_back(i);
  }
  int number = 0;
  for (auto& [tag, entity] : by_tag) {
    entity.number = ++number;
    entity.group = tag;
    entities.push_back(std::move(entity));
  }
}

/// Returns the entities of the labelled facets, followed by those of the cells.
inline std::vector<MshEntity> msh_entities(const Topology& topology) {
  const MeshLabels& labels = topology.labels();
  std::vector<MshEntity> entities;
  append_msh_entities(entities, topology.dimension() - 1, labels.facets, labels.facet_tags);
  append_msh_entities(entities, topology.dimension(), topology.cells(), labels.cell_tags);
  return entities;
}

}  // namespace smoothfem
