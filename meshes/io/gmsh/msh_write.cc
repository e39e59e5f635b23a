// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "meshes/io/atomic_file.h"
#include "meshes/io/gmsh/msh_elements.h"
#include "meshes/io/gmsh/msh_entities.h"
#include "meshes/io/gmsh/msh_file.h"
#include "meshes/io/gmsh/msh_output.h"
#include "meshes/io/mesh_assembly.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

class MshWriter {
 public:
  MshWriter(const MeshView& mesh, const std::string& version, MshOutput& out)
      : mesh_(mesh),
        labels_(mesh.topology().labels()),
        content_(mesh.content() ? *mesh.content() : nothing_),
        version_(version),
        out_(out),
        elements_(mesh),
        numbers_(elements_, labels_),
        entities_(msh_entities(mesh, elements_)) {
    for (std::size_t e = 0; e < elements_.size(); ++e)
      last_number_ = std::max(last_number_, numbers_.of(e));
    for (const MshEntity& entity : entities_)
      for (const auto& [type, elements] : entity.by_type) n_elements_ += elements.size();
    keeps_rows_ = version_ == "2.2" && !content_.repeated.empty() && further_numbers_are_free();
  }

  void write() {
    write_header();
    write_names();
    if (version_ == "2.2") {
      write_nodes_2();
      write_elements_2();
    } else {
      write_entities();
      write_nodes_4();
      write_elements_4();
    }
    if (!content_.periodic.empty()) version_ == "2.2" ? write_periodic_2() : write_periodic_4();
    write_data();
    const bool is_same = content_.format == "gmsh" && content_.version == version_ &&
                         content_.is_binary == out_.is_binary();
    if (is_same)
      for (const std::string& section : content_.sections) out_.text(section);
    out_.finish();
  }

 private:
  // --- Parts of the file's records --------------------------------------------------------------

  std::size_t node_number(NodeIndex node) const {
    return labels_.node_ids.empty() ? std::size_t{node} + 1 : labels_.node_ids[node];
  }

  /// True if no element has a number of the further rows of the file.
  bool further_numbers_are_free() {
    std::set<std::size_t> numbers;
    for (const auto& [element, rows] : content_.repeated)
      for (const RepeatedElement& row : rows) numbers.insert(row.id);
    for (std::size_t e = 0; e < elements_.size(); ++e)
      if (numbers.contains(numbers_.of(e))) return false;
    last_of_file_ = *numbers.rbegin();
    return true;
  }

  /// Returns the file's row of an element for a group beyond the first; null if it has none.
  const RepeatedElement* row_of_file(std::size_t e, int group) const {
    if (!keeps_rows_) return nullptr;
    const auto found = content_.repeated.find({elements_.dimension(e), numbers_.of(e)});
    if (found == content_.repeated.end()) return nullptr;
    for (const RepeatedElement& row : found->second)
      if (row.group == group) return &row;
    return nullptr;
  }

  void end_section(const std::string& name) {
    out_.text(out_.is_binary() ? "\n$End" + name + "\n" : "$End" + name + "\n");
  }

  // --- Sections of both versions -----------------------------------------------------------------

  void write_header() {
    out_.text("$MeshFormat\n" + version_ + (out_.is_binary() ? " 1 8\n" : " 0 8\n"));
    if (out_.is_binary()) out_.number(std::int32_t{1});  // shows the byte order
    end_section("MeshFormat");
  }

  /// Writes names as text, also in binary files. A name cannot contain the character that ends it.
  void write_names() {
    std::string lines;
    int n = 0;
    for (const auto& [group, name] : labels_.names) {
      if (group.second == 0) continue;
      std::string quoted = name;
      std::replace(quoted.begin(), quoted.end(), '"', '\'');
      lines += std::to_string(group.first) + " " + std::to_string(group.second) + " \"" + quoted +
               "\"\n";
      ++n;
    }
    if (n > 0)
      out_.text("$PhysicalNames\n" + std::to_string(n) + "\n" + lines + "$EndPhysicalNames\n");
  }

  void write_point(NodeIndex node) {
    for (const double x : mesh_.point(node)) out_.number(x);
  }

  /// Writes the fields of the file. Rows without a number are left out.
  void write_data() {
    for (const MeshField& field : content_.node_fields)
      write_field("NodeData", field,
                  [&](std::size_t i) { return node_number(static_cast<NodeIndex>(i)); });
    std::size_t first = 0;
    for (const MeshField& field : content_.element_fields) {
      std::vector<FurtherRow> further;
      for (const RepeatedElement* row : further_rows_)
        if (row->values.size() >= first + field.n_components && !std::isnan(row->values[first]))
          further.emplace_back(row->id, row->values.data() + first);
      write_field(
          "ElementData", field, [&](std::size_t e) { return numbers_.of(e); }, further);
      first += field.n_components;
    }
  }

  using FurtherRow = std::pair<std::size_t, const double*>;  // number and values

  template <class NumberOf>
  void write_field(const std::string& section, const MeshField& field, const NumberOf& number_of,
                   const std::vector<FurtherRow>& further = {}) {
    const std::size_t n = field.n_components, n_written = msh_components(n);
    if (n_written == 0) return;
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < field.n_rows(); ++i)
      if (!std::isnan(field.number(i * n)) && number_of(i) <= INT32_MAX) rows.push_back(i);
    std::string name = field.name;
    std::replace(name.begin(), name.end(), '"', '\'');
    std::string head = "$" + section + "\n1\n\"" + name + "\"\n1\n";
    append_number(head, field.time);
    out_.text(head + "\n3\n" + std::to_string(field.step) + "\n" + std::to_string(n_written) +
              "\n" + std::to_string(rows.size() + further.size()) + "\n");
    const auto write_row = [&](std::size_t number, const auto& value) {
      out_.number(static_cast<std::int32_t>(number));
      for (std::size_t k = 0; k < n_written; ++k) out_.number(k < n ? value(k) : 0.0);
      out_.end_record();
    };
    for (const std::size_t i : rows)
      write_row(number_of(i), [&](std::size_t k) { return field.number(i * n + k); });
    for (const auto& [number, values] : further)
      write_row(number, [&, row = values](std::size_t k) { return row[k]; });
    end_section(section);
  }

  // --- Version 2.2 -------------------------------------------------------------------------------

  void write_nodes_2() {
    out_.text("$Nodes\n" + std::to_string(mesh_.n_nodes()) + "\n");
    for (NodeIndex i = 0; i < mesh_.n_nodes(); ++i) {
      out_.number(static_cast<std::int32_t>(node_number(i)));
      write_point(i);
      out_.end_record();
    }
    end_section("Nodes");
  }

  /// Writes type by type, as Gmsh does; readers sort by the numbers. An element in several groups
  /// is repeated for each, with the file's number or one of its own.
  void write_elements_2() {
    std::size_t n = n_elements_;
    for (const MshEntity& entity : entities_)
      if (entity.groups.size() > 1)
        for (const auto& [type, elements] : entity.by_type)
          n += elements.size() * (entity.groups.size() - 1);
    out_.text("$Elements\n" + std::to_string(n) + "\n");
    std::size_t next = std::max(last_number_, last_of_file_) + 1;
    const auto number_of = [&](std::size_t e, int group) {
      const RepeatedElement* row = row_of_file(e, group);
      if (!row) return next++;
      further_rows_.push_back(row);
      return row->id;
    };
    for (const int number : msh_type_numbers())
      for (const MshEntity& entity : entities_) {
        const auto elements = entity.by_type.find(number);
        if (elements == entity.by_type.end()) continue;
        const auto groups = entity.groups.empty() ? std::vector{0} : entity.groups;
        for (const std::size_t e : elements->second)
          for (const int group : groups)
            write_element_2(entity, msh_type(number), e, group,
                            group == groups.front() ? numbers_.of(e) : number_of(e, group));
      }
    end_section("Elements");
  }

  void write_element_2(const MshEntity& entity, const MshType& type, std::size_t e, int group,
                       std::size_t tag) {
    constexpr std::int32_t n_tags = 2;  // physical group and entity
    const auto number = static_cast<std::int32_t>(tag);
    const auto head = out_.is_binary() ? std::array<std::int32_t, 4>{type.number, 1, n_tags, number}
                                       : std::array<std::int32_t, 4>{number, type.number, n_tags};
    for (std::size_t k = 0; k < (out_.is_binary() ? 4 : 3); ++k) out_.number(head[k]);
    out_.number(static_cast<std::int32_t>(group));
    out_.number(static_cast<std::int32_t>(entity.number));
    for (const NodeIndex node : elements_.row(e, type.order))
      out_.number(static_cast<std::int32_t>(node_number(node)));
    out_.end_record();
  }

  /// As text, also in binary files, as Gmsh does.
  void write_periodic_2() {
    std::string text = "$Periodic\n" + std::to_string(content_.periodic.size()) + "\n";
    for (const PeriodicEntity& link : content_.periodic) {
      text += std::to_string(link.dimension) + " " + std::to_string(link.entity) + " " +
              std::to_string(link.partner) + "\n";
      if (!link.affine.empty()) {
        text += "Affine";
        for (const double value : link.affine) append_number(text += ' ', value);
        text += "\n";
      }
      text += std::to_string(link.nodes.size()) + "\n";
      for (const auto& [node, partner] : link.nodes)
        text +=
            std::to_string(node_number(node)) + " " + std::to_string(node_number(partner)) + "\n";
    }
    out_.text(text + "$EndPeriodic\n");
  }

  // --- Version 4.1 -------------------------------------------------------------------------------

  void write_entities() {
    out_.text("$Entities\n");
    std::array<std::size_t, 4> n_entities{};
    for (const MshEntity& entity : entities_)
      ++n_entities[static_cast<std::size_t>(entity.dimension)];
    for (const std::size_t n : n_entities) out_.number(n);
    out_.end_record();
    for (const MshEntity& entity : entities_) {
      out_.number(entity.number);
      write_box(entity);
      out_.number(entity.groups.size());
      for (const int group : entity.groups) out_.number(group);
      if (entity.dimension > 0) {
        const auto boundary = entity.of_file ? entity.of_file->boundary : std::vector<int>();
        out_.number(boundary.size());
        for (const int number : boundary) out_.number(number);
      }
      out_.end_record(true);
    }
    end_section("Entities");
  }

  /// Writes the box of an entity, or the coordinates of a point.
  void write_box(const MshEntity& entity) {
    const std::size_t n = entity.dimension == 0 ? 3 : 6;
    if (entity.of_file && entity.of_file->box.size() >= n) {
      for (std::size_t k = 0; k < n; ++k) out_.number(entity.of_file->box[k]);
      return;
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Point<3> low = Point<3>::Constant(infinity), high = -low;
    for (const auto& [type, elements] : entity.by_type)
      for (const std::size_t e : elements)
        for (const NodeIndex node : elements_.row(e)) {
          const Point<3> point = mesh_.point(node);
          low = low.cwiseMin(point);
          high = high.cwiseMax(point);
        }
    if (entity.by_type.empty()) low = high = Point<3>::Zero();
    // Gmsh scales boxes about their middles, here by 1, which rounds. This keeps the files
    // unchanged.
    const Point<3> middle = 0.5 * (low + high);
    for (const Point<3>& corner : {low, high}) {
      for (const double x : Point<3>((corner - middle) + middle)) out_.rounded(x);
      if (entity.dimension == 0) return;
    }
  }

  /// Returns the nodes of each entity: as in the file, otherwise all in the first entity of the
  /// cells, whichever entities use them.
  std::vector<std::vector<NodeIndex>> nodes_of_entities() const {
    std::map<std::array<int, 2>, std::size_t> numbers;
    std::size_t first_of_cells = entities_.size();
    for (std::size_t k = 0; k < entities_.size(); ++k) {
      numbers[{entities_[k].dimension, entities_[k].number}] = k;
      if (entities_[k].dimension == mesh_.dimension()) first_of_cells = std::min(first_of_cells, k);
    }
    const auto& of_file = content_.node_entities;
    std::vector<std::vector<NodeIndex>> nodes(entities_.size());
    for (NodeIndex i = 0; i < mesh_.n_nodes(); ++i) {
      const auto known = of_file.empty() ? numbers.end() : numbers.find(of_file[i]);
      nodes[known == numbers.end() ? first_of_cells : known->second].push_back(i);
    }
    return nodes;
  }

  void write_nodes_4() {
    out_.text("$Nodes\n");
    const auto& ids = labels_.node_ids;
    const auto nodes = nodes_of_entities();
    out_.number(entities_.size());
    out_.number(mesh_.n_nodes());
    out_.number(ids.empty() ? std::size_t{1} : *std::min_element(ids.begin(), ids.end()));
    out_.number(ids.empty() ? mesh_.n_nodes() : *std::max_element(ids.begin(), ids.end()));
    out_.end_record();
    for (std::size_t k = 0; k < entities_.size(); ++k) {
      for (const int value : {entities_[k].dimension, entities_[k].number, 0}) out_.number(value);
      out_.number(nodes[k].size());
      out_.end_record();
      for (const NodeIndex i : nodes[k]) {
        out_.number(node_number(i));
        out_.end_record();
      }
      for (const NodeIndex i : nodes[k]) {
        write_point(i);
        out_.end_record();
      }
    }
    end_section("Nodes");
  }

  void write_elements_4() {
    out_.text("$Elements\n");
    std::size_t n_blocks = 0, first = std::numeric_limits<std::size_t>::max();
    for (const MshEntity& entity : entities_) n_blocks += entity.by_type.size();
    for (std::size_t e = 0; e < elements_.size(); ++e) first = std::min(first, numbers_.of(e));
    out_.number(n_blocks);
    out_.number(n_elements_);
    out_.number(first);
    out_.number(last_number_);
    out_.end_record();
    for (const MshEntity& entity : entities_)
      for (const auto& [type, elements] : entity.by_type) {
        for (const int value : {entity.dimension, entity.number, type}) out_.number(value);
        out_.number(elements.size());
        out_.end_record();
        for (const std::size_t e : elements) {
          out_.number(numbers_.of(e));
          for (const NodeIndex node : elements_.row(e, msh_type(type).order))
            out_.number(node_number(node));
          out_.end_record(true);
        }
      }
    end_section("Elements");
  }

  void write_periodic_4() {
    out_.text("$Periodic\n");
    out_.number(content_.periodic.size());
    out_.end_record();
    for (const PeriodicEntity& link : content_.periodic) {
      for (const int value : {link.dimension, link.entity, link.partner}) out_.number(value);
      out_.end_record();
      out_.number(link.affine.size());
      for (const double value : link.affine) out_.number(value);
      out_.end_record();
      out_.number(link.nodes.size());
      out_.end_record();
      for (const auto& [node, partner] : link.nodes) {
        out_.number(node_number(node));
        out_.number(node_number(partner));
        out_.end_record();
      }
    }
    end_section("Periodic");
  }

  inline static const FileContent nothing_{};

  const MeshView& mesh_;
  const MeshLabels& labels_;
  const FileContent& content_;
  std::string version_;
  MshOutput& out_;
  AllElements elements_;
  ElementNumbers numbers_;
  std::vector<MshEntity> entities_;
  std::size_t last_number_ = 0, n_elements_ = 0;
  bool keeps_rows_ = false;       ///< further rows have the numbers and data of the file
  std::size_t last_of_file_ = 0;  ///< largest number of these rows
  std::vector<const RepeatedElement*> further_rows_;  ///< that are written
};

void require_version_2_holds(const std::filesystem::path& path, const Topology& topology) {
  const MeshLabels& labels = topology.labels();
  for (const auto* ids : {&labels.node_ids, &labels.cell_ids})
    for (const std::size_t id : *ids)
      if (id > INT32_MAX - labels.facets.size())
        throw InputError("cannot write " + path.string() + ": the number " + std::to_string(id) +
                         " does not fit into 32 bits, which version 2.2 has; use 4.1");
}

}  // namespace

void write_msh(const std::filesystem::path& path, const MeshView& mesh, const MeshFields&,
               const MeshWriteOptions& options) {
  require_no_polygons(path, mesh);
  require_held(path, mesh, "Gmsh", ".vtu",
               [](int dimension, std::size_t n_corners, std::size_t n_midside) {
                 return msh_type(dimension, n_corners, n_midside).number != 0;
               });
  const FileContent* content = mesh.content();
  const bool is_of_gmsh = content && content->format == "gmsh";
  const std::string version = options.msh_version
                                  ? *options.msh_version == MshVersion::v2_2 ? "2.2" : "4.1"
                              : is_of_gmsh ? content->version
                                           : "4.1";
  const bool is_binary = options.binary.value_or(is_of_gmsh ? content->is_binary : true);
  if (version == "2.2") require_version_2_holds(path, mesh.topology());
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    MshOutput out(temporary, is_binary);
    MshWriter(mesh, version, out).write();
  });
}

}  // namespace smoothfem
