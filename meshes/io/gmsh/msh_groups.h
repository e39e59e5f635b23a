// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "meshes/io/gmsh/msh_parts.h"
#include "meshes/io/line_reader.h"
#include "smoothing/mesh/mesh_labels.h"

namespace smoothfem {

/// Returns the number in a line of a .msh file that is text in both encodings. Input: one of
/// msh_input.h.
template <class Input>
std::uint64_t msh_count_in_text(Input& in, const char* what) {
  std::string_view line = in.text_line(what);
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  const char* const last = line.data() + line.size();
  std::uint64_t n = 0;
  const auto [end, error] = std::from_chars(line.data(), last, n);
  const std::string_view rest(end, static_cast<std::size_t>(last - end));
  if (error != std::errc() || rest.find_first_not_of(" \t\r") != rest.npos)
    in.fail(std::string(what) + " is " + in_quotes(line) +
            ", which is not an integer of at least 0");
  return n;
}

/// The physical groups of a .msh file: their names and, in version 4, the groups of the model's
/// entities, which apply to their elements. Entities that Gmsh has made between partitions have no
/// group: there they would repeat that of the cells.
class MshGroups {
 public:
  /// Reads $PhysicalNames: lines 'dimension tag "name"', in version 2.0 also 'tag "name"'. The
  /// first name of a group counts.
  template <class Input>
  void read_names(Input& in) {
    const std::uint64_t n = msh_count_in_text(in, "the number of physical names");
    for (std::uint64_t i = 0; i < n; ++i) {
      const std::string_view line = in.text_line("a physical name");
      const std::size_t begin = line.find('"'), end = line.find('"', begin + 1);
      const bool has_name = begin != line.npos && end != line.npos && end > begin + 1;
      std::istringstream numbers{std::string(line.substr(0, begin))};
      Group group;
      if (!(numbers >> group.first))
        in.fail("expected dimension, tag and name of a physical group");
      if (!(numbers >> group.second)) {
        if (!has_name) in.fail("expected dimension, tag and name of a physical group");
        of_any_dimension_.emplace(group.first, line.substr(begin + 1, end - begin - 1));
        continue;
      }
      if (group.first < 0 || group.first > 3)
        in.fail("the physical group's dimension is " + std::to_string(group.first) +
                ", but must be from 0 to 3");
      if (has_name) names_.emplace(group, line.substr(begin + 1, end - begin - 1));
    }
  }

  /// Gives elements the names that the file has for any dimension. tags: of elements by dimension.
  /// A name that no element has goes to the highest dimension.
  void name_elements(const std::array<const std::vector<int>*, 4>& tags) {
    for (const auto& [tag, name] : of_any_dimension_) {
      int highest = 0;
      bool is_used = false;
      for (int dimension = 0; dimension <= 3; ++dimension) {
        const std::vector<int>& of_elements = *tags[static_cast<std::size_t>(dimension)];
        if (!of_elements.empty()) highest = dimension;
        if (std::find(of_elements.begin(), of_elements.end(), tag) == of_elements.end()) continue;
        names_.emplace(Group(dimension, tag), name);
        is_used = true;
      }
      if (!is_used) names_.emplace(Group(highest, tag), name);
    }
  }

  /// Reads $Entities or $PartitionedEntities, whose text may be broken into lines anywhere.
  /// points_have_boxes: true in version 4.0; version 4.1 has the coordinates only.
  template <class Input>
  void read_entities(Input& in, bool is_partitioned, bool points_have_boxes) {
    const auto integer = [&] {
      in.find_value("the end of the entities");
      return in.integer("entity");
    };
    const auto count = [&] {
      in.find_value("the end of the entities");
      return in.count("a count of the entities");
    };
    if (is_partitioned) {
      n_partitions_ = count();
      for (auto n = count(); n > 0; --n) {
        ghosts_.insert(integer());
        integer();  // the partition that has these copies
      }
    }
    std::array<std::uint64_t, 4> n_entities{};
    for (auto& n : n_entities) n = count();
    for (int dimension = 0; dimension < 4; ++dimension)
      for (auto i = n_entities[static_cast<std::size_t>(dimension)]; i > 0; --i) {
        const int entity = integer();
        bool is_between = false;  // partitions
        if (is_partitioned) {
          is_between = integer() > dimension;  // dimension of the whole entity
          integer();                           // its number
          if (dimension > dimension_) partitions_.clear();
          dimension_ = dimension;
          for (auto n = count(); n > 0; --n) partitions_.insert(integer());
        }
        ModelEntity& of_file = entities_[{dimension, entity}];
        for (int k = 0; k < (dimension == 0 && !points_have_boxes ? 3 : 6); ++k) {  // point or box
          in.find_value("the end of the entities");
          of_file.box.push_back(in.coordinate("a coordinate"));
        }
        for (auto n = count(); n > 0; --n) {
          const int group = integer();
          if (!is_between) of_file.groups.push_back(group);
        }
        if (dimension == 0) continue;
        for (auto n = count(); n > 0; --n) of_file.boundary.push_back(integer());
      }
  }

  /// Returns the first of an entity's groups; 0 if it has none.
  int tag_of_entity(int dimension, int entity) const {
    const auto found = entities_.find({dimension, entity});
    return found == entities_.end() || found->second.groups.empty() ? 0
                                                                    : found->second.groups.front();
  }

  /// Returns all of an entity's groups.
  std::vector<int> groups_of_entity(int dimension, int entity) const {
    const auto found = entities_.find({dimension, entity});
    return found == entities_.end() ? std::vector<int>() : found->second.groups;
  }

  /// True if the entity has copies of elements of other partitions.
  bool has_ghosts(int dimension, int entity) const {
    return dimension == dimension_ && ghosts_.contains(entity) &&
           !entities_.contains({dimension, entity});
  }
  /// Returns which part the file has if all its cells are of one partition of several.
  std::optional<MshPart> part() const {
    if (n_partitions_ < 2 || partitions_.size() != 1) return std::nullopt;
    return MshPart{*partitions_.begin(), n_partitions_};
  }

  std::map<std::pair<int, int>, std::string> names() && { return std::move(names_); }
  std::map<std::pair<int, int>, ModelEntity> entities() && { return std::move(entities_); }

 private:
  using Group = std::pair<int, int>;  // dimension and tag

  std::map<Group, std::string> names_;
  std::map<int, std::string> of_any_dimension_;  ///< names by tag
  std::map<Group, ModelEntity> entities_;        ///< by dimension and number
  std::uint64_t n_partitions_ = 0;
  int dimension_ = 0;         ///< largest one of entities of a partition
  std::set<int> partitions_;  ///< of the entities of that dimension
  std::set<int> ghosts_;      ///< entities of copied elements
};

}  // namespace smoothfem
