// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "meshes/io/abaqus/abaqus_file.h"
#include "meshes/io/abaqus/abaqus_lines.h"
#include "meshes/io/all_elements.h"
#include "meshes/io/atomic_file.h"
#include "meshes/io/mesh_assembly.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/text.h"

namespace smoothfem {

namespace {

struct NamedElement {
  std::string_view name;
  AbaqusElement element;
};

/// The types that the writer uses come first of their kind: continuum elements in space, plane
/// stress elements, shells, trusses.
constexpr std::array element_types{NamedElement{"C3D4", {3, 4}},
                                   NamedElement{"C3D5", {3, 5}},
                                   NamedElement{"C3D6", {3, 6}},
                                   NamedElement{"C3D8", {3, 8}},
                                   NamedElement{"C3D10", {3, 4, &tetrahedron_10}},
                                   NamedElement{"C3D13", {3, 5, &pyramid_13}},
                                   NamedElement{"C3D15", {3, 6, &prism_15}},
                                   NamedElement{"C3D20", {3, 8, &hexahedron_20}},
                                   NamedElement{"SC6", {3, 6}},
                                   NamedElement{"SC8", {3, 8}},
                                   NamedElement{"CPS3", {2, 3}},
                                   NamedElement{"CPS4", {2, 4}},
                                   NamedElement{"CPS6", {2, 3, &triangle_6}},
                                   NamedElement{"CPS8", {2, 4, &quadrilateral_8}},
                                   NamedElement{"M3D9", {2, 4, &quadrilateral_9}},
                                   NamedElement{"CPE6", {2, 3, &triangle_6}},
                                   NamedElement{"CPE8", {2, 4, &quadrilateral_8}},
                                   NamedElement{"CAX6", {2, 3, &triangle_6}},
                                   NamedElement{"CAX8", {2, 4, &quadrilateral_8}},
                                   NamedElement{"C2D6", {2, 3, &triangle_6}},
                                   NamedElement{"C2D8", {2, 4, &quadrilateral_8}},
                                   NamedElement{"CPE3", {2, 3}},
                                   NamedElement{"CPE4", {2, 4}},
                                   NamedElement{"CAX3", {2, 3}},
                                   NamedElement{"CAX4", {2, 4}},
                                   NamedElement{"C2D3", {2, 3}},
                                   NamedElement{"C2D4", {2, 4}},
                                   NamedElement{"S3", {2, 3}},
                                   NamedElement{"S4", {2, 4}},
                                   NamedElement{"S6", {2, 3, &triangle_6}},
                                   NamedElement{"STRI65", {2, 3, &triangle_6}},
                                   NamedElement{"S8", {2, 4, &quadrilateral_8}},
                                   NamedElement{"S9R5", {2, 4, &quadrilateral_9}},
                                   NamedElement{"M3D6", {2, 3, &triangle_6}},
                                   NamedElement{"M3D8", {2, 4, &quadrilateral_8}},
                                   NamedElement{"SFM3D6", {2, 3, &triangle_6}},
                                   NamedElement{"SFM3D8", {2, 4, &quadrilateral_8}},
                                   NamedElement{"STRI3", {2, 3}},
                                   NamedElement{"M3D3", {2, 3}},
                                   NamedElement{"M3D4", {2, 4}},
                                   NamedElement{"SFM3D3", {2, 3}},
                                   NamedElement{"SFM3D4", {2, 4}},
                                   NamedElement{"R3D3", {2, 3}},
                                   NamedElement{"R3D4", {2, 4}},
                                   NamedElement{"T2D2", {1, 2}},
                                   NamedElement{"T3D2", {1, 2}},
                                   NamedElement{"B21", {1, 2}},
                                   NamedElement{"B31", {1, 2}},
                                   NamedElement{"R2D2", {1, 2}},
                                   NamedElement{"SAX1", {1, 2}},
                                   NamedElement{"T2D3", {1, 2, &line_3}},
                                   NamedElement{"T3D3", {1, 2, &line_3}},
                                   NamedElement{"B22", {1, 2, &line_3}},
                                   NamedElement{"B32", {1, 2, &line_3}},
                                   NamedElement{"SAX2", {1, 2, &line_3}}};

/// Returns the type of an element of a mesh of dimension mesh_dim; null if Abaqus has none. Facets
/// of volume meshes are shells, lines are trusses.
const NamedElement* type_of(int mesh_dim, int dim, std::size_t n_corners, std::size_t n_midside) {
  for (const NamedElement& type : element_types)
    if (type.element.dimension == dim && type.element.n_corners == n_corners &&
        type.element.n_nodes() == n_corners + n_midside &&
        (dim != 2 || mesh_dim == 2 || type.name.starts_with('S')))
      return &type;
  return nullptr;
}

}  // namespace

std::optional<AbaqusElement> abaqus_element(std::string_view type) {
  // Heat transfer and acoustic elements have the same shapes.
  if (type.starts_with("DC") || type.starts_with("AC")) type.remove_prefix(1);
  for (const auto& [name, element] : element_types) {
    if (!type.starts_with(name)) continue;
    const std::string_view variant = type.substr(name.size());  // R, H, I, T, ...
    if (variant == "R5" || std::all_of(variant.begin(), variant.end(), [](char c) {
          return std::isalpha(static_cast<unsigned char>(c));
        }))
      return element;
  }
  return std::nullopt;
}

namespace {

using Names = std::map<std::pair<int, int>, std::string>;

/// Quotes keep blanks and other characters together.
std::string quoted_if_needed(const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
  });
  return plain && std::isalpha(static_cast<unsigned char>(name.front())) ? name : '"' + name + '"';
}

/// Returns the set of a tag: its name, if Abaqus can hold it and no other tag has it.
std::string set_name(const std::pair<int, int>& key, const Names& names) {
  const auto found = names.find(key);
  const auto same_name = [&](const auto& other) {
    return other.first != key && other.first.first == key.first &&
           capitals(other.second) == capitals(found->second);
  };
  if (found == names.end() || found->second.empty() ||
      found->second.find('"') != std::string::npos ||
      std::any_of(names.begin(), names.end(), same_name))
    return std::string(abaqus_tag_set) + std::to_string(key.second);
  return quoted_if_needed(found->second);
}

class AbaqusWriter {
 public:
  explicit AbaqusWriter(const MeshView& mesh)
      : mesh_(mesh),
        labels_(mesh.topology().labels()),
        elements_(mesh),
        numbers_(elements_, labels_) {}

  std::string text() {
    text_.append(abaqus_first_comment).append("\n");
    for (const auto& [key, name] : labels_.names)
      text_.append(abaqus_name_comment).append(physical_name_line(key, name)).append("\n");
    write_nodes();
    const Topology& topology = mesh_.topology();
    const int dim = mesh_.dimension();
    const MidsideNodes* midside = topology.midside();
    const auto cell_label = [&](std::size_t c) { return numbers_.of(c); };
    const auto facet_label = [&](std::size_t f) { return numbers_.of(elements_.n_cells() + f); };
    write_elements(dim, topology.cells(), midside ? &midside->of_cells : nullptr, labels_.cell_tags,
                   cell_label);
    write_elements(dim - 1, labels_.facets, midside ? &midside->of_facets : nullptr,
                   labels_.facet_tags, facet_label);
    if (const FileContent* content = mesh_.content()) {
      write_further_sets(dim, content->cell_entities, cell_label);
      write_further_sets(dim - 1, content->facet_entities, facet_label);
    }
    write_fixed();
    text_.append(abaqus_last_comment).append("\n");
    return std::move(text_);
  }

 private:
  std::size_t node_label(std::size_t i) const {
    return labels_.node_ids.empty() ? i + 1 : labels_.node_ids[i];
  }

  void write_nodes() {
    text_ += "*NODE\n";
    for (NodeIndex i = 0; i < mesh_.n_nodes(); ++i) {
      append_number(text_, node_label(i));
      for (const double x : mesh_.point(i)) {
        text_ += ", ";
        append_number(text_, x);
      }
      text_ += '\n';
    }
  }

  /// One block for each type and tag; the labels define the order.
  template <class LabelOf>
  void write_elements(int dim, const CompressedRows<NodeIndex>& rows,
                      const CompressedRows<NodeIndex>* midside, const std::vector<int>& tags,
                      const LabelOf& label_of) {
    using Key = std::tuple<std::size_t, std::size_t, int>;  // corners, other nodes, tag
    std::map<Key, std::vector<std::size_t>> blocks;
    for (std::size_t i = 0; i < rows.size(); ++i)
      blocks[{rows[i].size(), midside ? (*midside)[i].size() : 0, tags.empty() ? 0 : tags[i]}]
          .push_back(i);
    for (const auto& [key, members] : blocks) {
      const auto& [n_corners, n_midside, tag] = key;
      const NamedElement* type = type_of(mesh_.dimension(), dim, n_corners, n_midside);
      text_.append("*ELEMENT, TYPE=").append(type->name);
      if (tag != 0) text_ += ", ELSET=" + set_name({dim, tag}, labels_.names);
      text_ += '\n';
      for (const std::size_t i : members)
        write_element(label_of(i), type->element, rows[i],
                      midside ? (*midside)[i] : std::span<const NodeIndex>());
    }
  }

  /// Abaqus reads at most 16 numbers a line; a line that ends with a comma continues.
  void write_element(std::size_t label, const AbaqusElement& element,
                     std::span<const NodeIndex> corners, std::span<const NodeIndex> midside) {
    std::vector<NodeIndex> row(corners.begin(), corners.end());
    row.insert(row.end(), midside.begin(), midside.end());
    if (element.order) element.order->to_file(row);
    if (element.order == &line_3) std::swap(row[1], row[2]);
    append_number(text_, label);
    for (std::size_t k = 0; k < row.size(); ++k) {
      text_ += k == numbers_a_line - 1 ? ",\n" : ", ";
      append_number(text_, node_label(row[k]));
    }
    text_ += '\n';
  }

  /// Writes the sets of elements in several groups, but for the first one.
  template <class LabelOf>
  void write_further_sets(int dim, const std::vector<int>& entities, const LabelOf& label_of) {
    std::map<int, std::vector<std::size_t>> members;
    for (std::size_t i = 0; i < entities.size(); ++i) {
      const auto groups = groups_of(mesh_.content(), dim, entities[i], 0);
      for (std::size_t k = 1; k < groups.size(); ++k) members[groups[k]].push_back(label_of(i));
    }
    for (const auto& [group, labels] : members)
      write_set("*ELSET, ELSET=" + set_name({dim, group}, labels_.names), labels);
  }

  void write_fixed() {
    std::vector<std::size_t> labels;
    for (NodeIndex i = 0; i < mesh_.n_nodes(); ++i)
      if (mesh_.topology().reasons_to_stay(i) != 0) labels.push_back(node_label(i));
    write_set("*NSET, NSET=" + std::string(abaqus_fixed_set), labels);
  }

  void write_set(const std::string& keyword, const std::vector<std::size_t>& labels) {
    text_ += keyword;
    for (std::size_t k = 0; k < labels.size(); ++k) {
      text_ += k % numbers_a_line == 0 ? "\n" : ", ";
      append_number(text_, labels[k]);
    }
    text_ += '\n';
  }

  static constexpr std::size_t numbers_a_line = 16;  // as many as Abaqus reads

  const MeshView& mesh_;
  const MeshLabels& labels_;
  AllElements elements_;
  ElementNumbers numbers_;
  std::string text_;
};

}  // namespace

namespace {

/// Returns the text of an input file with the coordinates of a mesh that was read from it. Lines of
/// nodes that have not moved stay as they are, and so does everything else.
class AbaqusRewriter {
 public:
  explicit AbaqusRewriter(const MeshView& mesh) : mesh_(mesh) {
    const auto& ids = mesh.topology().labels().node_ids;
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      nodes_[ids.empty() ? std::size_t{i} + 1 : ids[i]] = i;
  }

  std::string text(const std::string& original) {
    std::string result;
    bool is_node_block = false, in_assembly = false, in_instance = false;
    for (std::size_t begin = 0; begin < original.size();) {
      const std::size_t end = std::min(original.find('\n', begin), original.size() - 1) + 1;
      const std::string_view line = std::string_view(original).substr(begin, end - begin);
      const std::string_view text = trimmed(line.substr(0, line.find('\n')));
      if (text.starts_with('*') && !text.starts_with("**")) {
        const std::string name = capitals(trimmed(text.substr(1, text.find(',') - 1)));
        if (name.ends_with("ASSEMBLY")) in_assembly = name == "ASSEMBLY";
        if (name.ends_with("INSTANCE")) in_instance = name == "INSTANCE";
        // Reference points of an assembly are not part of the mesh.
        is_node_block = name == "NODE" && (in_instance || !in_assembly);
      }
      is_node_block && !text.starts_with('*') ? append_node(result, line) : void(result += line);
      begin = end;
    }
    return result;
  }

 private:
  void append_node(std::string& result, std::string_view line) const {
    LineReader reader("", line, ", \t\r\v\f");
    std::vector<double> old;
    std::size_t label = 0;
    try {
      if (!reader.next_line() || !reader.has_word()) {
        result += line;
        return;
      }
      label = reader.integer("the label");
      while (old.size() < 3 && reader.has_word()) old.push_back(reader.number("a coordinate"));
    } catch (const InputError&) {
      result += line;
      return;
    }
    const auto node = nodes_.find(label);
    if (node == nodes_.end()) {  // no cell uses it
      result += line;
      return;
    }
    const Point<3> point = mesh_.point(node->second);
    bool has_moved = false;
    for (std::size_t d = 0; d < 3; ++d)
      has_moved =
          has_moved || point[static_cast<Eigen::Index>(d)] != (d < old.size() ? old[d] : 0.0);
    if (!has_moved) {
      result += line;
      return;
    }
    append_number(result, label);
    const std::size_t least = point.z() == 0.0 ? 2 : 3;
    for (std::size_t d = 0; d < std::max(old.size(), least); ++d) {
      result += ", ";
      append_number(result, point[static_cast<Eigen::Index>(d)]);
    }
    result += line.ends_with("\r\n") ? "\r\n" : "\n";
  }

  const MeshView& mesh_;
  std::unordered_map<std::size_t, NodeIndex> nodes_;
};

}  // namespace

void write_abaqus(const std::filesystem::path& path, const MeshView& mesh, const MeshFields&,
                  const MeshWriteOptions&) {
  require_no_polygons(path, mesh);
  require_held(path, mesh, "Abaqus", ".msh or .vtu",
               [&](int dim, std::size_t n_corners, std::size_t n_midside) {
                 return type_of(mesh.dimension(), dim, n_corners, n_midside) != nullptr;
               });
  const FileContent* content = mesh.content();
  const bool has_text = content && content->format == "abaqus" && !content->sections.empty();
  write_atomically(path, has_text ? AbaqusRewriter(mesh).text(content->sections.front())
                                  : AbaqusWriter(mesh).text());
}

}  // namespace smoothfem
