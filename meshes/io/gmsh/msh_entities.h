// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "meshes/io/all_elements.h"
#include "meshes/io/gmsh/msh_elements.h"

namespace smoothfem {

/// The elements of one entity of the model, by which Gmsh sorts elements.
struct MshEntity {
  int dimension;
  int number = 0;                                     ///< different in each dimension
  std::vector<int> groups{};                          ///< physical tags
  const ModelEntity* of_file = nullptr;               ///< null if the file does not describe it
  std::map<int, std::vector<std::size_t>> by_type{};  ///< elements by Gmsh's type
};

/// Returns the entities of a mesh, ascending by dimension and number: those of its file and, where
/// the file has none, one for each combination of groups. Elements whose type Gmsh does not have
/// are left out.
inline std::vector<MshEntity> msh_entities(const MeshView& mesh, const AllElements& elements) {
  const FileContent* content = mesh.content();
  using Key = std::tuple<int, int, std::vector<int>>;  // dimension, entity of the file, groups
  std::map<Key, MshEntity> found;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const int dimension = elements.dimension(e), entity = elements.entity(e);
    const MshType type = msh_type(dimension, elements.nodes(e).size(), elements.midside(e).size());
    if (type.number == 0) continue;
    auto groups = groups_of(content, dimension, entity, elements.tag(e));
    const Key key(dimension, entity, groups);
    found.try_emplace(key, MshEntity{dimension, 0, std::move(groups)})
        .first->second.by_type[type.number]
        .push_back(e);
  }
  std::set<std::pair<int, int>> used;
  if (content)
    for (const auto& [key, entity] : content->entities) used.insert(key);
  std::map<std::pair<int, int>, MshEntity> numbered;
  const auto add = [&](MshEntity entity) {
    numbered.emplace(std::pair(entity.dimension, entity.number), std::move(entity));
  };
  std::vector<MshEntity*> without_number;
  for (auto& [key, entity] : found) {
    entity.number = std::get<1>(key);
    const std::pair name(entity.dimension, entity.number);
    if (entity.number == 0 || numbered.contains(name)) {
      without_number.push_back(&entity);
      continue;
    }
    used.insert(name);
    add(std::move(entity));
  }
  for (MshEntity* entity : without_number) {
    entity->number = 1;
    while (!used.emplace(entity->dimension, entity->number).second) ++entity->number;
    add(std::move(*entity));
  }
  if (content)
    for (const auto& [key, of_file] : content->entities) {
      MshEntity& entity =
          numbered.try_emplace(key, MshEntity{key.first, key.second, of_file.groups}).first->second;
      entity.of_file = &of_file;
    }
  std::vector<MshEntity> entities;
  for (auto& [key, entity] : numbered) entities.push_back(std::move(entity));
  return entities;
}

}  // namespace smoothfem
