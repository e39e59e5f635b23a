// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <unordered_map>

#include "meshes/io/abaqus/abaqus_file.h"
#include "meshes/io/abaqus/abaqus_lines.h"
#include "meshes/io/label_range.h"
#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"

namespace smoothfem {

namespace {

/// Elements of one dimension with the position of their set's name; 0 means no set.
struct LabelledElements {
  ElementList list;
  std::vector<std::size_t> sets;
};

class AbaqusReader {
 public:
  AbaqusReader(const std::filesystem::path& path, std::string_view content)
      : lines_(path, content) {}

  MeshParts parts() {
    while (lines_.next_keyword()) read_block();
    for (const std::string& comment : lines_.name_comments()) add_physical_name(comment, parts_);
    sort_nodes();
    for (int dimension = 1; dimension <= 3; ++dimension) add_elements(dimension);
    return std::move(parts_);
  }

 private:
  void read_block() {
    const std::string& keyword = lines_.keyword();
    if (keyword == "ASSEMBLY" || keyword == "END ASSEMBLY")
      in_assembly_ = keyword == "ASSEMBLY";
    else if (keyword == "INSTANCE")
      read_instance();
    else if (keyword == "END INSTANCE")
      in_instance_ = false;
    else if (keyword == "NODE" || keyword == "ELEMENT")
      read_mesh_block(keyword);
    else if (keyword == "ELSET")
      read_element_set();
    else if (keyword == "NSET" && capitals(lines_.parameter("NSET")) == abaqus_fixed_set)
      for_each_range([&](const LabelRange& range) { fixed_.push_back(range); });
    else if (keyword == "PART" && ++n_parts_ > 1)
      lines_.fail("the file has several parts; save each of them as a separate file");
    else if (keyword == "INCLUDE" || keyword == "SYSTEM" || keyword == "NGEN" ||
             keyword == "NFILL" || keyword == "NCOPY" || keyword == "ELGEN" || keyword == "ELCOPY")
      lines_.fail("*" + keyword +
                  " is not supported; save the mesh with all nodes and elements listed in global "
                  "coordinates");
  }

  void read_mesh_block(const std::string& keyword) {
    // Reference points of an assembly have separate labels and are not part of the mesh.
    if (in_assembly_ && !in_instance_) return;
    if (lines_.has_parameter("INPUT"))
      lines_.fail("*" + keyword + " with INPUT is not supported; put the lines of that file here");
    keyword == "NODE" ? read_nodes() : read_elements();
  }

  void read_instance() {
    in_instance_ = true;
    if (++n_instances_ > 1)
      lines_.fail("the assembly has several instances; save each of them as a separate file");
    if (lines_.next_data())
      lines_.fail(
          "the instance is moved or turned, which is not supported; save the mesh with its "
          "final coordinates and without instances");
  }

  void read_nodes() {
    if (capitals(lines_.parameter("SYSTEM", "R")) != "R")
      lines_.fail("only Cartesian coordinates are supported (*NODE without SYSTEM)");
    while (lines_.next_data()) {
      lines_.require_no_empty_field();
      const std::size_t label = lines_.label("the node's label");
      Point<3> point = Point<3>::Zero();
      for (int d = 0; d < 3 && lines_.has_field(); ++d) point[d] = lines_.number("a coordinate");
      parts_.node_ids.push_back(label);
      parts_.coordinates.push_back(point);
    }
  }

  void read_elements() {
    const std::string type = capitals(lines_.parameter("TYPE"));
    const auto element = abaqus_element(type);
    if (!element)
      lines_.fail(
          "the element type '" + type +
          "' cannot be read; use C3D4, C3D5, C3D6, C3D8, CPS3, CPS4, S3, S4 or similar types, "
          "whose nodes are their corners");
    auto& elements = elements_[element->dimension];
    const std::size_t set = set_number(lines_.parameter("ELSET"));
    while (lines_.next_data()) {
      elements.list.ids.push_back(lines_.label("the element's label"));
      elements.list.lines.push_back(lines_.line());
      elements.sets.push_back(set);
      row_.clear();
      // Labels are replaced by indices when all nodes are known.
      while (row_.size() < element->n_nodes) {
        if (!lines_.has_field() && !lines_.next_data())
          lines_.fail("the element has " + std::to_string(row_.size()) + " nodes, but its type " +
                      type + " has " + std::to_string(element->n_nodes));
        const std::size_t label = lines_.label("the node");
        if (label >= std::numeric_limits<NodeIndex>::max())
          lines_.fail("the label " + std::to_string(label) + " is too large");
        row_.push_back(static_cast<NodeIndex>(label));
      }
      if (lines_.has_field())
        lines_.fail("the element has more nodes than the " + std::to_string(element->n_nodes) +
                    " of its type " + type);
      elements.list.nodes.append(row_);
    }
  }

  /// Returns the number of a set; 0 without a name.
  std::size_t set_number(const std::string& name) {
    if (name.empty()) return 0;
    const auto [set, is_new] = set_numbers_.try_emplace(capitals(name), set_names_.size() + 1);
    if (is_new) set_names_.push_back(name);
    return set->second;
  }

  /// Calls `use` with the labels of a set as ranges. Entries that are not numbers name other sets,
  /// whose members have a set already.
  template <class Use>
  void for_each_range(const Use& use) {
    const bool generate = lines_.has_parameter("GENERATE");
    while (lines_.next_data()) {
      while (!generate && lines_.has_field())
        if (const auto label = lines_.label_if_number()) use(LabelRange{*label, *label, 1});
      if (!generate) continue;
      LabelRange range{lines_.label("the first label"), lines_.label("the last label"), 1};
      if (lines_.has_field()) range.step = lines_.label("the step");
      if (range.step == 0 || range.last < range.first)
        lines_.fail("the labels from " + std::to_string(range.first) + " to " +
                    std::to_string(range.last) + " in steps of " + std::to_string(range.step) +
                    " are not a range");
      use(range);
    }
  }

  void read_element_set() {
    const std::size_t set = set_number(lines_.parameter("ELSET"));
    for_each_range([&](const LabelRange& range) {
      if (range.first == range.last)
        set_of_.try_emplace(range.first, set);
      else
        set_ranges_.emplace_back(range, set);
    });
  }

  void sort_nodes() {
    auto& ids = parts_.node_ids;
    const auto order = sorted_by(ids);
    for (std::size_t i = 1; i < order.size(); ++i)
      if (ids[order[i]] == ids[order[i - 1]])
        lines_.fail("the file defines the node " + std::to_string(ids[order[i]]) + " twice");
    reorder(parts_.coordinates, order);
    reorder(ids, order);
    if (fixed_.empty()) return;
    parts_.fixed.emplace(ids.size(), false);
    for (const LabelRange& range : fixed_)
      for_each_in_range(ids, range, [&](std::size_t i) { (*parts_.fixed)[i] = true; });
  }

  static std::vector<std::size_t> sorted_by(const std::vector<std::size_t>& ids) {
    std::vector<std::size_t> order(ids.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (!std::is_sorted(ids.begin(), ids.end()))
      std::stable_sort(order.begin(), order.end(),
                       [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
    return order;
  }

  template <class T>
  static void reorder(std::vector<T>& values, const std::vector<std::size_t>& order) {
    std::vector<T> sorted;
    sorted.reserve(values.size());
    for (const std::size_t i : order) sorted.push_back(values[i]);
    values = std::move(sorted);
  }

  NodeIndex node_index(std::size_t label, std::size_t line) const {
    const auto& ids = parts_.node_ids;
    const auto found = label - 1 < ids.size() && ids[label - 1] == label
                           ? ids.begin() + static_cast<std::ptrdiff_t>(label - 1)
                           : std::lower_bound(ids.begin(), ids.end(), label);
    if (found == ids.end() || *found != label)
      lines_.fail_at(line, "the element names node " + std::to_string(label) +
                               ", which the file does not have");
    return static_cast<NodeIndex>(found - ids.begin());
  }

  /// Adds the elements in the order of their labels.
  void add_elements(int dimension) {
    LabelledElements& from = elements_[dimension];
    ElementList& to = parts_.elements[dimension];
    std::vector<std::size_t> sets;
    for (const std::size_t e : sorted_by(from.list.ids)) {
      const std::size_t line = from.list.lines[e], id = from.list.ids[e];
      if (!to.ids.empty() && to.ids.back() == id)
        lines_.fail_at(line, "the element " + std::to_string(id) + " is defined twice");
      row_.clear();
      for (const NodeIndex label : from.list.nodes[e]) row_.push_back(node_index(label, line));
      to.nodes.append(row_);
      to.ids.push_back(id);
      to.lines.push_back(line);
      sets.push_back(from.sets[e]);
    }
    find_sets(to.ids, sets);
    for (const std::size_t set : sets) to.tags.push_back(set == 0 ? 0 : tag_of(dimension, set));
  }

  /// Gives elements without a set (0) the first *ELSET that contains them. Sets are numbered in the
  /// order of appearance.
  void find_sets(const std::vector<std::size_t>& ids, std::vector<std::size_t>& sets) const {
    constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> first(ids.size(), none);
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (const auto found = set_of_.find(ids[i]); found != set_of_.end()) first[i] = found->second;
    for (const auto& [range, set] : set_ranges_)
      for_each_in_range(ids, range,
                        [&, set = set](std::size_t i) { first[i] = std::min(first[i], set); });
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (sets[i] == 0 && first[i] != none) sets[i] = first[i];
  }

  /// Returns the tag that a comment gave to the set's name, or a new one.
  int tag_of(int dimension, std::size_t set) {
    const auto [tag, is_new] = tags_.try_emplace({dimension, set}, 0);
    if (!is_new) return tag->second;
    const std::string& name = set_names_[set - 1];
    if (name.starts_with(abaqus_tag_set)) {
      const char* digits = name.data() + abaqus_tag_set.size();
      const auto [end, error] = std::from_chars(digits, name.data() + name.size(), tag->second);
      if (error == std::errc() && end == name.data() + name.size()) return tag->second;
    }
    for (const auto& [key, known] : parts_.names)
      if (key.first == dimension && capitals(known) == capitals(name))
        return tag->second = key.second;
    int unused = 1;
    while (parts_.names.contains({dimension, unused})) ++unused;
    parts_.names[{dimension, unused}] = name;
    return tag->second = unused;
  }

  AbaqusLines lines_;
  MeshParts parts_;
  std::array<LabelledElements, 4> elements_;
  std::vector<NodeIndex> row_;
  std::vector<LabelRange> fixed_;
  std::vector<std::string> set_names_;
  std::map<std::string, std::size_t> set_numbers_;  ///< by name in capitals, from 1
  std::unordered_map<std::size_t, std::size_t> set_of_;
  std::vector<std::pair<LabelRange, std::size_t>> set_ranges_;
  std::map<std::pair<int, std::size_t>, int> tags_;
  int n_parts_ = 0, n_instances_ = 0;
  bool in_assembly_ = false, in_instance_ = false;
};

}  // namespace

MeshParts read_abaqus(const std::filesystem::path& path) {
  const std::string content = read_whole_file(path);
  return AbaqusReader(path, content).parts();
}

namespace {

const RegisteredFormat abaqus({.name = "abaqus",
                               .extension = ".inp",
                               .description = "Abaqus and CalculiX input",
                               .holds_planar_meshes = true,
                               .holds_volume_meshes = true,
                               .holds_fixed_nodes = true,
                               .holds_physical_names = true,
                               .holds_numbers = true,
                               .read = read_abaqus,
                               .write = write_abaqus});

}  // namespace

}  // namespace smoothfem
