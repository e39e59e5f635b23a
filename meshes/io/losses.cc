// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/losses.h"

#include <algorithm>
#include <set>

#include "meshes/io/all_elements.h"
#include "meshes/io/mesh_file.h"
#include "smoothing/base/text.h"

namespace smoothfem {

namespace {

/// Collects the losses of a mesh in a format.
class Losses {
 public:
  Losses(const MeshView& mesh, const MeshFormat& format)
      : topology_(mesh.topology()),
        labels_(mesh.topology().labels()),
        content_(mesh.content()),
        elements_(mesh),
        format_(format) {}

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
    const bool keeps_text = content_->format == format_.name && !content_->sections.empty();
    for (const std::string& name : content_->section_names) add(!keeps_text, name);
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
    std::size_t n_lost = 0;
    for (std::size_t e = elements_.n_cells() + labels_.facets.size(); e < elements_.size(); ++e)
      n_lost += elements_.dimension(e) < format_.min_element_dimension;
    add(n_lost > 0, std::to_string(n_lost) + " points, lines or facets without a label");
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
  std::vector<std::string> found_;
};

}  // namespace

bool is_own_field(const MeshField& field) {
  return field.name == "mean_ratio";
}

std::vector<std::string> losses(const std::filesystem::path& path, const MeshView& mesh) {
  return losses(format_for(path, mesh), mesh);
}
std::vector<std::string> losses(const MeshFormat& format, const MeshView& mesh) {
  return Losses(mesh, format).find();
}

}  // namespace smoothfem
