// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <string>

#include "meshes/doctor/finding.h"
#include "meshes/io/abaqus/abaqus_file.h"
#include "meshes/io/abaqus/abaqus_lines.h"
#include "meshes/io/abaqus/abaqus_sets.h"
#include "meshes/io/label_range.h"
#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "smoothing/base/text.h"

namespace smoothfem {

namespace {

/// Elements of one dimension with the position of their set's name; 0 means no set.
struct LabelledElements {
  ElementList list;
  std::vector<std::size_t> sets;
};

/// Nodes, elements and sets with labels of their own: of a part, or of a file without parts.
struct LabelledMesh {
  std::vector<std::size_t> node_ids;
  std::vector<Point<3>> coordinates;
  std::array<LabelledElements, 4> elements;
  std::vector<LabelRange> fixed;
  std::vector<std::pair<LabelRange, std::size_t>> set_ranges;
  std::vector<std::pair<std::size_t, std::size_t>> nested_sets{};  ///< a set, and one in it
};

/// A part of the file at its place in the assembly.
struct Instance {
  std::string name, part;
  Point<3> translation = Point<3>::Zero();
  Eigen::AngleAxisd rotation = Eigen::AngleAxisd::Identity();
  Point<3> axis_point = Point<3>::Zero();
  /// Element sets of the assembly with elements of this instance.
  std::vector<std::pair<LabelRange, std::string>> sets{};

  bool is_moved() const { return !translation.isZero(0.0) || rotation.angle() != 0.0; }
  Point<3> place(const Point<3>& point) const {
    const Point<3> moved = point + translation;
    if (rotation.angle() == 0.0) return moved;
    return axis_point + rotation * (moved - axis_point);
  }
};

/// Element types that are no cells: springs, masses, connectors, CalculiX's network elements (D)
/// and the like.
bool is_no_cell(std::string_view type) {
  constexpr std::array prefixes{"SPRING", "DASHPOT", "MASS",  "ROTARYI", "CONN",    "GAP",  "DGAP",
                                "DCOUP",  "DISTRIB", "JOINT", "ITS",     "HEATCAP", "FLINK"};
  return type == "D" || std::any_of(prefixes.begin(), prefixes.end(),
                                    [&](const char* prefix) { return type.starts_with(prefix); });
}

class AbaqusReader {
 public:
  AbaqusReader(const std::filesystem::path& path, std::string_view content)
      : lines_(path, content), content_(content) {}

  MeshParts parts() {
    while (lines_.next_keyword()) read_block();
    for (const std::string& comment : lines_.name_comments()) add_physical_name(comment, parts_);
    for (auto& [name, part] : parts_of_file_) open_nested_sets(part);
    open_nested_sets(whole_);
    place_instances();
    sort_nodes();
    for (int dimension = 1; dimension <= 3; ++dimension) add_elements(dimension);
    find_middles_of_lines();
    describe_content();
    return std::move(parts_);
  }

 private:
  void read_block() {
    const std::string& keyword = lines_.keyword();
    note_keyword(keyword);
    if (keyword == "ASSEMBLY" || keyword == "END ASSEMBLY")
      in_assembly_ = keyword == "ASSEMBLY";
    else if (keyword == "INSTANCE")
      read_instance();
    else if (keyword == "PART")
      mesh_ = &parts_of_file_[capitals(lines_.parameter("NAME"))];
    else if (keyword == "END PART" || keyword == "END INSTANCE")
      mesh_ = &whole_;
    else if (keyword == "NODE" || keyword == "ELEMENT")
      read_mesh_block(keyword);
    else if (keyword == "ELSET")
      read_element_set();
    else if (keyword == "NSET" && capitals(lines_.parameter("NSET")) == abaqus_fixed_set)
      for_each_range([&](const LabelRange& range) { mesh_->fixed.push_back(range); },
                     [](const std::string&) {});
    else if (keyword == "SYSTEM" || keyword == "NGEN" || keyword == "NFILL" || keyword == "NCOPY" ||
             keyword == "ELGEN" || keyword == "ELCOPY")
      lines_.fail("*" + keyword +
                  " is not supported; save the mesh with all nodes and elements listed in global "
                  "coordinates");
  }

  void read_mesh_block(const std::string& keyword) {
    // Reference points of an assembly have separate labels and are not part of the mesh.
    if (in_assembly_ && mesh_ == &whole_) return;
    keyword == "NODE" ? read_nodes() : read_elements();
  }

  /// An instance may have a translation, then an axis by two points and an angle in degrees. It may
  /// also have nodes and elements of its own.
  void read_instance() {
    Instance& instance = instances_.emplace_back();
    instance.name = lines_.parameter("NAME");
    instance.part = capitals(lines_.parameter("PART"));
    std::vector<std::vector<double>> numbers;  // of each line
    while (lines_.next_data()) {
      auto& of_line = numbers.emplace_back();
      while (lines_.has_field())
        of_line.push_back(lines_.number("a number of the instance's place"));
    }
    if (numbers.size() > 2 || (!numbers.empty() && numbers[0].size() > 3) ||
        (numbers.size() == 2 && numbers[1].size() != 7))
      lines_.fail(
          "the place of the instance is not a line with a translation (3 numbers) and, for a turn, "
          "a line with two points and an angle (7 numbers)");
    for (std::size_t d = 0; !numbers.empty() && d < numbers[0].size(); ++d)
      instance.translation[static_cast<Eigen::Index>(d)] = numbers[0][d];
    if (numbers.size() == 2) {
      const auto& turn = numbers[1];
      instance.axis_point = {turn[0], turn[1], turn[2]};
      const Point<3> axis = Point<3>(turn[3], turn[4], turn[5]) - instance.axis_point;
      if (axis.isZero(0.0)) lines_.fail("the two points of the instance's axis are equal");
      instance.rotation = Eigen::AngleAxisd(turn[6] * std::numbers::pi / 180.0, axis.normalized());
    }
    const auto part = parts_of_file_.find(instance.part);
    if (part != parts_of_file_.end() && !part->second.node_ids.empty()) {
      mesh_ = &whole_;
    } else {  // its nodes and elements follow
      instance.part = "*" + std::to_string(instances_.size());
      mesh_ = &parts_of_file_[instance.part];
    }
  }

  /// Remembers the keywords whose data are not part of the mesh.
  void note_keyword(const std::string& keyword) {
    constexpr std::array of_mesh{"NODE",     "ELEMENT",  "ELSET",        "PART",         "END PART",
                                 "ASSEMBLY", "INSTANCE", "END INSTANCE", "END ASSEMBLY", "HEADING"};
    if (std::find(of_mesh.begin(), of_mesh.end(), keyword) != of_mesh.end()) return;
    if (keyword.starts_with("END ")) return;
    std::string text = "*" + keyword;
    for (const char* key : {"NSET", "NAME"})
      if (const std::string name = lines_.parameter(key); !name.empty()) text += " " + name;
    if (text == "*NSET " + std::string(abaqus_fixed_set)) return;
    auto& names = parts_.content.section_names;
    if (std::find(names.begin(), names.end(), text) == names.end()) names.push_back(text);
  }

  /// Puts all instances into one mesh. With several, the labels of each follow those of the one
  /// before, and the names of sets begin with that of the instance.
  void place_instances() {
    if (instances_.empty() && parts_of_file_.empty()) return;
    if (instances_.empty())
      for (const auto& [name, part] : parts_of_file_)
        instances_.push_back({.name = name, .part = name});
    const bool are_several = instances_.size() > 1;
    std::size_t node_base = 0, element_base = 0;
    for (const Instance& instance : instances_) {
      const LabelledMesh& part = parts_of_file_.at(instance.part);
      const auto set_of = [&](std::size_t set) {
        if (set == 0 || !are_several) return set;
        return set_number(instance.name + "." + set_names_[set - 1]);
      };
      const auto shifted = [](const LabelRange& range, std::size_t base) {
        return LabelRange{range.first + base, range.last + base, range.step};
      };
      std::size_t last_node = node_base, last_element = element_base;
      for (std::size_t i = 0; i < part.node_ids.size(); ++i) {
        whole_.node_ids.push_back(part.node_ids[i] + node_base);
        whole_.coordinates.push_back(instance.place(part.coordinates[i]));
        last_node = std::max(last_node, whole_.node_ids.back());
      }
      for (std::size_t d = 0; d < part.elements.size(); ++d) {
        const LabelledElements& from = part.elements[d];
        LabelledElements& to = whole_.elements[d];
        for (std::size_t e = 0; e < from.list.ids.size(); ++e) {
          row_.clear();
          for (const auto labels : {from.list.nodes[e], from.list.midside_of(e)})
            for (const NodeIndex label : labels)
              row_.push_back(static_cast<NodeIndex>(label + node_base));
          to.list.append_nodes(row_, from.list.nodes[e].size());
          to.list.ids.push_back(from.list.ids[e] + element_base);
          to.list.lines.push_back(from.list.lines[e]);
          to.sets.push_back(set_of(from.sets[e]));
          last_element = std::max(last_element, to.list.ids.back());
        }
      }
      for (const auto& [range, set] : part.set_ranges)
        whole_.set_ranges.emplace_back(shifted(range, element_base), set_of(set));
      for (const auto& [range, name] : instance.sets)
        whole_.set_ranges.emplace_back(shifted(range, element_base), set_number(name));
      for (const LabelRange& range : part.fixed) whole_.fixed.push_back(shifted(range, node_base));
      node_base = last_node;
      element_base = last_element;
    }
    if (are_several)
      parts_.notes.push_back(
          "the " + std::to_string(instances_.size()) +
          " instances become one mesh, whose nodes and elements are numbered anew");
  }

  /// Keeps the file's text, if its nodes are where the text says.
  void describe_content() {
    FileContent& content = parts_.content;
    content.format = "abaqus";
    if (!types_left_out_.empty())
      parts_.notes.push_back(count_of(n_left_out_, "element") +
                             (types_left_out_.size() == 1 ? " of type " : " of types ") +
                             joined({types_left_out_.begin(), types_left_out_.end()}) +
                             (n_left_out_ == 1 ? " is left out, as it is no cell"
                                               : " are left out, as they are no cells"));
    if (n_empty_coordinates_ > 0)
      parts_.notes.push_back(std::to_string(n_empty_coordinates_) +
                             (n_empty_coordinates_ == 1 ? " empty coordinate is read as 0"
                                                        : " empty coordinates are read as 0"));
    if (!has_all_sets_)
      parts_.notes.emplace_back(
          "the file has too many sets of elements, and the last ones are left out");
    if (lines_.n_included() > 0)
      parts_.notes.push_back(
          "the file includes " + std::to_string(lines_.n_included()) +
          (lines_.n_included() == 1 ? " other, whose text is" : " others, whose text is") +
          " in place in written .inp files");
    const auto n_parts =
        std::count_if(parts_of_file_.begin(), parts_of_file_.end(),
                      [](const auto& part) { return !part.second.node_ids.empty(); });
    const bool is_placed = n_parts > 1 || instances_.size() > 1 ||
                           (instances_.size() == 1 && instances_[0].is_moved());
    if (is_placed || content_.starts_with(abaqus_first_comment)) return;
    std::string whole = std::move(lines_).whole_text();
    content.sections.push_back(whole.empty() ? std::string(content_) : std::move(whole));
  }

  void read_nodes() {
    if (capitals(lines_.parameter("SYSTEM", "R")) != "R")
      lines_.fail("only Cartesian coordinates are supported (*NODE without SYSTEM)");
    while (lines_.next_data()) {
      const std::vector<bool> is_empty = lines_.empty_fields();
      if (is_empty.front()) lines_.fail("the node has no label; put its number first in the line");
      const std::size_t label = lines_.label("the node's label");
      Point<3> point = Point<3>::Zero();
      for (std::size_t d = 0; d < 3 && d + 1 < is_empty.size(); ++d)
        if (is_empty[d + 1])
          ++n_empty_coordinates_;
        else
          point[static_cast<Eigen::Index>(d)] = lines_.number("a coordinate");
      mesh_->node_ids.push_back(label);
      mesh_->coordinates.push_back(point);
    }
  }

  void read_elements() {
    const std::string type = capitals(lines_.parameter("TYPE"));
    const auto element = abaqus_element(type);
    if (!element && is_no_cell(type)) {
      types_left_out_.insert(type);
      while (lines_.next_data()) ++n_left_out_;
      return;
    }
    if (!element)
      lines_.fail("the element type '" + type +
                  "' cannot be read; use C3D4, C3D6, C3D8, C3D10, C3D15, C3D20, CPS3, CPS4, CPS6, "
                  "CPS8, S3, S4 or similar types");
    auto& elements = mesh_->elements[static_cast<std::size_t>(element->dimension)];
    const std::size_t set = set_number(lines_.parameter("ELSET"));
    while (lines_.next_data()) {
      elements.list.ids.push_back(lines_.label("the element's label"));
      elements.list.lines.push_back(lines_.line());
      elements.sets.push_back(set);
      row_.clear();
      // Labels are replaced by indices when all nodes are known.
      while (row_.size() < element->n_nodes()) {
        if (!lines_.has_field() && !lines_.next_data())
          lines_.fail("the element has " + std::to_string(row_.size()) + " nodes, but its type " +
                      type + " has " + std::to_string(element->n_nodes()));
        const std::size_t label = lines_.label("the node");
        if (label >= std::numeric_limits<NodeIndex>::max())
          lines_.fail("the label " + std::to_string(label) + " is too large");
        row_.push_back(static_cast<NodeIndex>(label));
      }
      if (lines_.has_field())
        lines_.fail("the element has more nodes than the " + std::to_string(element->n_nodes()) +
                    " of its type " + type);
      if (element->order) element->order->from_file(row_);
      elements.list.append_nodes(row_, element->n_corners);
    }
  }

  static std::optional<std::size_t> label_of(std::string_view entry) {
    std::size_t label = 0;
    const auto [end, error] = std::from_chars(entry.data(), entry.data() + entry.size(), label);
    if (error != std::errc() || end != entry.data() + entry.size()) return std::nullopt;
    return label;
  }

  /// Returns the number of a set; 0 without a name.
  std::size_t set_number(const std::string& name) {
    if (name.empty()) return 0;
    const auto [set, is_new] = set_numbers_.try_emplace(capitals(name), set_names_.size() + 1);
    if (is_new) set_names_.push_back(name);
    return set->second;
  }

  /// Calls `use` with the labels of a set as ranges, and `use_name` with entries that are no
  /// numbers but names of other sets.
  template <class Use, class UseName>
  void for_each_range(const Use& use, const UseName& use_name) {
    const bool generate = lines_.has_parameter("GENERATE");
    while (lines_.next_data()) {
      while (!generate && lines_.has_field()) {
        const std::string_view entry = lines_.entry();
        if (const auto label = label_of(entry))
          use(LabelRange{*label, *label, 1});
        else
          use_name(std::string(entry));
      }
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

  /// Sets that CAE makes for itself (INTERNAL), for example below surfaces, are no groups.
  void read_element_set() {
    if (lines_.has_parameter("INTERNAL")) return;
    const std::string name = lines_.parameter("ELSET");
    const std::string of_instance = capitals(lines_.parameter("INSTANCE"));
    const auto instance =
        std::find_if(instances_.begin(), instances_.end(),
                     [&](const Instance& other) { return capitals(other.name) == of_instance; });
    if (instance != instances_.end())
      return for_each_range(
          [&](const LabelRange& range) { instance->sets.emplace_back(range, name); },
          [](const std::string&) {});
    const std::size_t set = set_number(name);
    auto& ranges = mesh_->set_ranges;
    for_each_range(
        [&](const LabelRange& range) {
          const bool continues = !ranges.empty() && ranges.back().second == set &&
                                 ranges.back().first.step == 1 && range.step == 1 &&
                                 ranges.back().first.last + 1 == range.first;
          if (continues)
            ranges.back().first.last = range.last;
          else
            ranges.emplace_back(range, set);
        },
        [&](const std::string& member) {
          mesh_->nested_sets.emplace_back(set, set_number(member));
        });
  }

  /// Gives a set of sets the elements of all sets that come before it, as Abaqus does.
  void open_nested_sets(LabelledMesh& mesh) {
    constexpr std::size_t most = 1'000'000;
    for (const auto& [set, member] : mesh.nested_sets) {
      const std::size_t n = mesh.set_ranges.size();
      for (std::size_t i = 0; i < n && mesh.set_ranges.size() < most; ++i)
        if (mesh.set_ranges[i].second == member)
          mesh.set_ranges.emplace_back(mesh.set_ranges[i].first, set);
      for (const LabelledElements& elements : mesh.elements)
        for (std::size_t e = 0; e < elements.sets.size() && mesh.set_ranges.size() < most; ++e)
          if (elements.sets[e] == member)
            mesh.set_ranges.emplace_back(LabelRange{elements.list.ids[e], elements.list.ids[e], 1},
                                         set);
      if (mesh.set_ranges.size() >= most) has_all_sets_ = false;
    }
  }

  void sort_nodes() {
    parts_.node_ids = std::move(whole_.node_ids);
    parts_.coordinates = std::move(whole_.coordinates);
    auto& ids = parts_.node_ids;
    const auto order = sorted_by(ids);
    for (std::size_t i = 1; i < order.size(); ++i)
      if (ids[order[i]] == ids[order[i - 1]])
        lines_.fail("the file defines the node " + std::to_string(ids[order[i]]) + " twice");
    reorder(parts_.coordinates, order);
    reorder(ids, order);
    if (whole_.fixed.empty()) return;
    parts_.fixed.emplace(ids.size(), false);
    for (const LabelRange& range : whole_.fixed)
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
    LabelledElements& from = whole_.elements[static_cast<std::size_t>(dimension)];
    ElementList& to = parts_.elements[dimension];
    std::vector<std::size_t> sets;
    for (const std::size_t e : sorted_by(from.list.ids)) {
      const std::size_t line = from.list.lines[e], id = from.list.ids[e];
      if (!to.ids.empty() && to.ids.back() == id)
        lines_.fail_at(line, "the element " + std::to_string(id) + " is defined twice");
      row_.clear();
      for (const auto labels : {from.list.nodes[e], from.list.midside_of(e)})
        for (const NodeIndex label : labels) row_.push_back(node_index(label, line));
      to.append_nodes(row_, from.list.nodes[e].size());
      to.ids.push_back(id);
      to.lines.push_back(line);
      sets.push_back(from.sets[e]);
    }
    add_groups(dimension, combine_sets(to.ids, sets, whole_.set_ranges));
  }

  /// Abaqus lists the middle node of a line second, but some programs list it last: the nodes of
  /// most lines decide.
  void find_middles_of_lines() {
    ElementList& lines = parts_.elements[1];
    const auto& points = parts_.coordinates;
    const auto distance = [&](NodeIndex node, NodeIndex a, NodeIndex b) {
      return (points[node] - 0.5 * (points[a] + points[b])).norm();
    };
    std::ptrdiff_t votes = 0;  // for the second
    for (std::size_t e = 0; e < lines.midside.size(); ++e)
      if (!lines.midside[e].empty()) {
        const NodeIndex first = lines.nodes[e][0], second = lines.nodes[e][1],
                        third = lines.midside[e][0];
        votes += distance(second, first, third) <= distance(third, first, second) ? 1 : -1;
      }
    if (votes < 0 || lines.midside.empty()) return;
    ElementNodes turned;
    for (std::size_t e = 0; e < lines.nodes.size(); ++e) {
      const auto ends = lines.nodes[e], middle = lines.midside[e];
      turned.nodes.append(middle.empty() ? std::array{ends[0], ends[1]}
                                         : std::array{ends[0], middle[0]});
      turned.midside.append(middle.empty() ? middle : ends.subspan(1));
    }
    lines.nodes = std::move(turned.nodes);
    lines.midside = std::move(turned.midside);
  }

  /// Gives elements the tag of the first of their sets. Elements in several sets belong to an
  /// entity with all their groups.
  void add_groups(int dimension, const SetCombinations& combinations) {
    ElementList& to = parts_.elements[dimension];
    const auto& sets = combinations.sets;
    has_all_sets_ = has_all_sets_ && combinations.is_complete;
    for (const std::uint32_t c : combinations.of_element)
      to.tags.push_back(sets[c].empty() ? 0 : tag_of(dimension, sets[c].front()));
    const bool any_several =
        std::any_of(sets.begin(), sets.end(), [](const auto& of_one) { return of_one.size() > 1; });
    if (!any_several) return;
    to.entities.assign(combinations.of_element.begin(), combinations.of_element.end());
    for (std::size_t c = 1; c < sets.size(); ++c)
      for (const std::size_t set : sets[c])
        parts_.content.entities[{dimension, static_cast<int>(c)}].groups.push_back(
            tag_of(dimension, set));
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
  std::string_view content_;
  MeshParts parts_;
  LabelledMesh whole_;  ///< the file without parts; in the end all instances
  std::map<std::string, LabelledMesh> parts_of_file_;  ///< by name in capitals
  std::vector<Instance> instances_;
  LabelledMesh* mesh_ = &whole_;  ///< that the lines belong to
  std::vector<NodeIndex> row_;
  std::vector<std::string> set_names_;
  std::map<std::string, std::size_t> set_numbers_;  ///< by name in capitals, from 1
  std::map<std::pair<int, std::size_t>, int> tags_;
  std::set<std::string> types_left_out_;
  std::size_t n_left_out_ = 0, n_empty_coordinates_ = 0;
  bool has_all_sets_ = true;
  bool in_assembly_ = false;
};

}  // namespace

MeshParts read_abaqus(const std::filesystem::path& path, const MeshReadOptions&) {
  const std::string content = read_whole_file(path);
  return AbaqusReader(path, content).parts();
}

namespace {

/// True if the first line that is no comment is a keyword.
bool is_abaqus(std::string_view beginning) {
  LineReader reader({}, beginning);
  while (reader.next_line()) {
    const std::string_view word = reader.word();
    if (word.starts_with("**")) continue;
    return word.size() > 1 && word[0] == '*' && std::isalpha(static_cast<unsigned char>(word[1]));
  }
  return false;
}

const RegisteredFormat abaqus({.name = "abaqus",
                               .extension = ".inp",
                               .description = "Abaqus and CalculiX input",
                               .holds_planar_meshes = true,
                               .holds_volume_meshes = true,
                               .holds_second_order = true,
                               .holds_fixed_nodes = true,
                               .holds_facets = true,
                               .holds_physical_names = true,
                               .holds_numbers = true,
                               .holds_several_groups = true,
                               .min_element_dimension = 3,
                               .recognizes = is_abaqus,
                               .read = read_abaqus,
                               .write = write_abaqus});

}  // namespace

}  // namespace smoothfem
