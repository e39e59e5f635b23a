// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/gmsh/msh_layout.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "meshes/io/file_parts.h"
#include "meshes/io/gmsh/msh_elements.h"
#include "meshes/io/gmsh/msh_groups.h"
#include "meshes/io/gmsh/msh_input.h"
#include "smoothing/base/input_error.h"
#include "smoothing/mesh/interfaces.h"

namespace smoothfem {

namespace {

constexpr std::string_view other_format =
    "it is neither a binary .msh file of version 4.1 nor a .vtu file";

/// Goes through the sections of a file.
class LayoutScan {
 public:
  explicit LayoutScan(const std::filesystem::path& path) : path_(path), file_(path) {}

  MshLayout layout() {
    if (line() != "$MeshFormat") return {.obstacle = std::string(other_format)};
    visit_format();
    for (std::string section = line(); layout_.obstacle.empty() && !section.empty();
         section = line())
      visit(section);
    if (layout_.obstacle.empty() && (layout_.nodes.empty() || layout_.elements.empty()))
      layout_.obstacle = "it has no nodes or no elements";
    return std::move(layout_);
  }

 private:
  void visit(const std::string& section) {
    if (section == "$Entities" || section == "$PartitionedEntities")
      visit_entities(section);
    else if (section == "$Nodes")
      visit_nodes();
    else if (section == "$Elements")
      visit_elements();
    else if (section == "$PhysicalNames" || section == "$Comments" ||
             section == "$GhostElements")  // these name elements of the file
      at_ = end_of(section);
    else if (section == "$NodeData" || section == "$ElementData")
      visit_data(section);
    else
      refuse(section.starts_with('$') ? "it has the section " + section : "it is damaged");
  }

  void refuse(const std::string& why) { layout_.obstacle = why; }

  void visit_format() {
    if (line() != "4.1 1 8") return refuse(std::string(other_format));
    if (take<std::int32_t>() != 1) return refuse("it has another byte order");
    require_end("$MeshFormat");
  }

  void visit_entities(const std::string& section) {
    const std::uint64_t begin = at_, end = end_of(section);
    const std::int32_t one = 1;  // the reader expects the number that shows the byte order
    std::string content(reinterpret_cast<const char*>(&one), sizeof one);
    content.resize(sizeof one + end - begin);
    file_.read(begin, std::span(content).subspan(sizeof one));
    MshBinaryInput input(path_.string(), content, 0, true);
    groups_.read_entities(input, section == "$PartitionedEntities", false);
    at_ = end;
  }

  /// Returns the numbers of blocks and items, and the smallest and the largest tag. A table of all
  /// tags must not be wasteful.
  std::array<std::uint64_t, 4> take_totals() {
    constexpr std::uint64_t most_a_node = 16;
    const auto totals = take<std::array<std::uint64_t, 4>>();
    if (totals[3] >= UINT32_MAX)
      refuse("it has numbers above 32 bits");
    else if (totals[3] / most_a_node > totals[1])
      refuse("its numbers have large gaps");
    return totals;
  }

  void visit_nodes() {
    const auto totals = take_totals();
    layout_.last_node = totals[3];
    for (std::uint64_t b = 0; b < totals[0]; ++b) {
      const auto entity = take<std::array<std::int32_t, 3>>();
      MshNodeBlock block{.n = take<std::uint64_t>(),
                         .n_numbers = 3 + (entity[2] != 0 ? entity[0] : 0)};
      if (!fits(block.n, 8 + 8 * static_cast<std::uint64_t>(block.n_numbers))) return;
      block.tags_at = at_;
      block.points_at = at_ + 8 * block.n;
      at_ = block.points_at + 8 * block.n * static_cast<std::uint64_t>(block.n_numbers);
      if (block.n > 0) layout_.nodes.push_back(block);
    }
    require_end("$Nodes");
  }

  void visit_elements() {
    const auto totals = take_totals();
    layout_.last_element = totals[3];
    for (std::uint64_t b = 0; b < totals[0]; ++b) {
      const auto entity = take<std::array<std::int32_t, 3>>();
      const MshType type = msh_type(entity[2]);
      if (type.number == 0 || type.n_nodes != type.n_corners)
        return refuse("it has elements of second order or of unknown types");
      MshElementBlock block{
          .n = take<std::uint64_t>(),
          .at = at_,
          .dimension = type.dimension,
          .has_group = groups_.tag_of_entity(entity[0], entity[1]) != 0,
          .material = materials_.of(groups_.groups_of_entity(entity[0], entity[1])),
          .n_nodes = static_cast<std::uint32_t>(type.n_nodes)};
      if (entity[0] != type.dimension) return refuse("it is damaged");
      if (!fits(block.n, 8 + 8 * type.n_nodes)) return;
      at_ += block.n * (8 + 8 * type.n_nodes);
      if (block.n > 0 && !groups_.has_ghosts(entity[0], entity[1]))
        layout_.elements.push_back(block);
    }
    require_end("$Elements");
  }

  /// Data say which nodes must stay if they have one of these names.
  void visit_data(const std::string& section) {
    const std::uint64_t end = end_of(section);
    line();
    const std::string name = line();
    for (const char* required : {required_field, corner_field, ridge_field})
      if (name == required || name == '"' + std::string(required) + '"')
        return refuse("its data '" + std::string(required) + "' say which nodes must stay");
    at_ = end;
  }

  bool fits(std::uint64_t n, std::uint64_t size) {
    if (n <= (file_.size() - at_) / size) return true;
    refuse("it is damaged");
    return false;
  }

  template <class T>
  T take() {
    T value{};
    file_.read(at_, {reinterpret_cast<char*>(&value), sizeof value});
    at_ += sizeof value;
    return value;
  }

  /// Returns the next line that is not empty, without its end; nothing at the end of the file.
  std::string line() {
    std::string text;
    while (at_ < file_.size() && text.size() < 256) {
      const char c = take<char>();
      if (c != '\n' && c != '\r') text += c;
      if (c == '\n' && !text.empty()) break;
    }
    return text;
  }

  void require_end(std::string section) {
    if (line() != section.insert(1, "End")) refuse("it is damaged");
  }

  /// Returns the position behind the section's last line.
  std::uint64_t end_of(std::string section) {
    const std::string wanted = section.insert(1, "End");
    std::string window;
    constexpr std::size_t step = std::size_t{1} << 20;
    for (std::uint64_t from = at_; from < file_.size();) {
      const std::size_t kept = std::min(window.size(), wanted.size()),
                        n = std::min<std::uint64_t>(step, file_.size() - from);
      window.erase(0, window.size() - kept);
      window.resize(kept + n);
      file_.read(from, std::span(window).subspan(kept));
      if (const std::size_t found = window.find(wanted); found != window.npos)
        return from - kept + found + wanted.size();
      from += n;
    }
    refuse("it is damaged");
    return file_.size();
  }

  std::filesystem::path path_;
  FileParts file_;
  std::uint64_t at_ = 0;
  MshGroups groups_;
  MaterialNumbers materials_;
  MshLayout layout_;
};

}  // namespace

MshLayout msh_layout(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    return {.obstacle = "it is no regular file"};
  try {
    return LayoutScan(path).layout();
  } catch (const InputError&) {
    return {.obstacle = "it is damaged"};
  }
}

}  // namespace smoothfem
