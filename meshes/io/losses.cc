// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/losses.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "meshes/io/all_elements.h"
#include "meshes/io/mesh_file.h"
#include "smoothing/base/text.h"

namespace smoothfem {

namespace {

/// Collects the losses of a mesh in a format.
class Losses {
 public:
  Losses(const MeshView& mesh, const MeshFormat& format, const MeshWriteOptions& options)
      : topology_(mesh.topology()),
        labels_(mesh.topology().labels()),
        content_(mesh.content()),
        elements_(mesh),
        format_(format),
        options_(options) {}

  std::vector<std::string> find() {
    add(!format_.holds_tags && !labels_.cell_tags.empty(), "the tags of cells");
    add(!format_.holds_facets && !labels_.facets.empty(), "labelled facets");
    add(!format_.holds_physical_names && !labels_.names.empty(), "names of groups");
    add(!format_.holds_numbers && !(labels_.node_ids.empty() && labels_.cell_ids.empty()),
        "the numbers of nodes and cells");
    add(!format_.holds_fixed_nodes && loses_fixed_nodes(), "which nodes are fixed");
    if (!content_) return std::move(found_);
    find_groups();
    find_elements();
    find_fields();
    add(!format_.holds_periodic && !content_->periodic.empty(), "periodic partners");
    add(!format_.holds_points_in_space && content_->plane, "the plane of the mesh in space");
    find_rows();
    const bool keeps_text = is_written_as_read() && !content_->sections.empty();
    for (const std::string& name : content_->section_names)
      add(!keeps_text && std::count(found_.begin(), found_.end(), name) == 0, name);
    return std::move(found_);
  }

 private:
  void add(bool is_lost, std::string what) {
    if (is_lost) found_.push_back(std::move(what));
  }

  /// True if the fixed nodes are not those of the boundary, which files without flags have, or more
  /// than these where the format can add some.
  bool loses_fixed_nodes() const {
    for (NodeIndex i = 0; i < topology_.n_nodes(); ++i) {
      const FixedReasons reasons = topology_.fixed_reasons(i);
      const bool is_marked = has(reasons, FixedReason::marked);
      if (topology_.on_boundary()[i] ? reasons == 0 : is_marked && !format_.adds_fixed_nodes)
        return true;
    }
    return false;
  }

  /// Groups beyond the first one of an element.
  void find_groups() {
    if (format_.holds_several_groups) return;
    std::set<std::string> lost;
    for (const auto& [key, entity] : content_->entities)
      for (std::size_t k = 1; k < entity.groups.size(); ++k) {
        const auto name = labels_.names.find({key.first, entity.groups[k]});
        lost.insert(name == labels_.names.end() ? std::to_string(entity.groups[k]) : name->second);
      }
    add(!lost.empty(), "the further groups of elements in several groups (" +
                           joined({lost.begin(), lost.end()}) + ")");
  }

  void find_elements() {
    // The text of a file of Abaqus has all elements.
    if (format_.name == "abaqus" && is_written_as_read() && !content_->sections.empty()) return;
    std::size_t n_lost = 0;
    for (std::size_t e = elements_.n_cells() + labels_.facets.size(); e < elements_.size(); ++e)
      n_lost += elements_.dimension(e) < format_.min_element_dimension;
    add(n_lost > 0, std::to_string(n_lost) + " points, lines or facets without a label");
  }

  /// True if the file has the format, version and encoding of that which the mesh comes from.
  bool is_written_as_read() const {
    if (content_->format != format_.name) return false;
    if (!format_.has_two_encodings) return true;
    return options_.binary.value_or(content_->is_binary) == content_->is_binary &&
           (!options_.msh_version || is_version_2() == (content_->version == "2.2"));
  }
  bool is_version_2() const {
    return options_.msh_version ? *options_.msh_version == MshVersion::v2_2
                                : content_->format == "gmsh" && content_->version == "2.2";
  }

  /// Data of elements that a file repeats for each of their groups, if they differ.
  void find_rows() {
    if (content_->repeated.empty() || (format_.name == "gmsh" && is_version_2())) return;
    std::size_t n_lost = 0;
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      const std::size_t id = elements_.id(e) == 0 ? e + 1 : elements_.id(e);
      const auto rows = content_->repeated.find({elements_.dimension(e), id});
      if (rows == content_->repeated.end()) continue;
      n_lost +=
          std::any_of(rows->second.begin(), rows->second.end(),
                      [&](const RepeatedElement& row) { return !has_data_of(e, row.values); });
    }
    add(n_lost > 0, "the data of " + std::to_string(n_lost) +
                        (n_lost == 1 ? " element that differ" : " elements that differ") +
                        " between their groups");
  }

  bool has_data_of(std::size_t e, const std::vector<double>& values) const {
    std::size_t i = 0;
    for (const MeshField& field : content_->element_fields)
      for (std::size_t k = 0; k < field.n_components && i < values.size(); ++k, ++i) {
        const double value = field.number(e * field.n_components + k);
        if (value != values[i] && !(std::isnan(value) && std::isnan(values[i]))) return false;
      }
    return true;
  }

  void find_fields() {
    std::vector<std::string> names;
    const auto find = [&](const std::vector<MeshField>& fields, bool is_of_file) {
      for (const MeshField& field : fields)
        if (field.name != content_->tag_field && !is_own_field(field) &&
            !(format_.holds_field && format_.holds_field(field, is_of_file)))
          names.push_back(field.name);
    };
    find(content_->node_fields, false);
    find(content_->element_fields, false);
    find(content_->file_fields, true);
    add(!names.empty(), (names.size() == 1 ? "the field " : "the fields ") + joined(names));
  }

  const Topology& topology_;
  const MeshLabels& labels_;
  const FileContent* content_;
  AllElements elements_;
  const MeshFormat& format_;
  const MeshWriteOptions options_;
  std::vector<std::string> found_;
};

}  // namespace

bool is_own_field(const MeshField& field) {
  return field.name == "mean_ratio";
}

std::vector<std::string> losses(const std::filesystem::path& path, const MeshView& mesh,
                                const MeshWriteOptions& options) {
  return losses(format_for(path, mesh), mesh, options);
}
std::vector<std::string> losses(const MeshFormat& format, const MeshView& mesh,
                                const MeshWriteOptions& options) {
  return Losses(mesh, format, options).find();
}

}  // namespace smoothfem
