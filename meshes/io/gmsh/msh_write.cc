// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
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
  MshWriter(const MeshView& mesh, MshOutput& out)
      : mesh_(mesh),
        labels_(mesh.topology().labels()),
        out_(out),
        entities_(msh_entities(mesh.topology())) {
    const auto& ids = labels_.cell_ids;
    last_cell_ = ids.empty() ? mesh.n_cells() : *std::max_element(ids.begin(), ids.end());
  }

  void write_2() {
    write_header("2.2");
    write_names();
    write_nodes_2();
    write_elements_2();
    out_.finish();
  }

  void write_4() {
    write_header("4.1");
    write_names();
    write_entities();
    write_nodes_4();
    write_elements_4();
    out_.finish();
  }

 private:
  // --- Parts of the file's records --------------------------------------------------------------

  std::size_t node_number(NodeIndex node) const {
    return labels_.node_ids.empty() ? std::size_t{node} + 1 : labels_.node_ids[node];
  }
  const CompressedRows<NodeIndex>& rows(const MshEntity& entity) const {
    return is_of_cells(entity) ? mesh_.topology().cells() : labels_.facets;
  }
  bool is_of_cells(const MshEntity& entity) const { return entity.dimension == mesh_.dimension(); }
  /// Facets are numbered after the cells.
  std::size_t element_number(const MshEntity& entity, std::uint32_t i) const {
    if (!is_of_cells(entity)) return last_cell_ + 1 + i;
    return labels_.cell_ids.empty() ? std::size_t{i} + 1 : labels_.cell_ids[i];
  }
  std::size_t n_elements() const { return mesh_.n_cells() + labels_.facets.size(); }

  void end_section(const std::string& name) {
    out_.text(out_.is_binary() ? "\n$End" + name + "\n" : "$End" + name + "\n");
  }

  // --- Sections of both versions -----------------------------------------------------------------

  void write_header(const std::string& version) {
    out_.text("$MeshFormat\n" + version + (out_.is_binary() ? " 1 8\n" : " 0 8\n"));
    if (out_.is_binary()) out_.number(std::int32_t{1});  // shows the byte order
    end_section("MeshFormat");
  }

  /// Writes names as text, also in binary files. A name cannot contain the character that ends it.
  void write_names() {
    std::string lines;
    int n = 0;
    for (const auto& [group, name] : labels_.names) {
      const bool is_used = std::any_of(
          entities_.begin(), entities_.end(), [&, group = group](const MshEntity& entity) {
            return entity.dimension == group.first && entity.group == group.second;
          });
      if (!is_used || group.second == 0) continue;
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

  /// Writes type by type, as Gmsh does; readers sort by the numbers.
  void write_elements_2() {
    out_.text("$Elements\n" + std::to_string(n_elements()) + "\n");
    for (const MshElementType& type : msh_element_types)
      for (const MshEntity& entity : entities_) {
        const auto elements = entity.by_type.find(type.number);
        if (elements == entity.by_type.end()) continue;
        for (const std::uint32_t i : elements->second) write_element_2(entity, type, i);
      }
    end_section("Elements");
  }

  void write_element_2(const MshEntity& entity, const MshElementType& type, std::uint32_t i) {
    constexpr std::int32_t n_tags = 2;  // physical group and entity
    const auto number = static_cast<std::int32_t>(element_number(entity, i));
    const auto head = out_.is_binary() ? std::array<std::int32_t, 4>{type.number, 1, n_tags, number}
                                       : std::array<std::int32_t, 4>{number, type.number, n_tags};
    for (std::size_t k = 0; k < (out_.is_binary() ? 4 : 3); ++k) out_.number(head[k]);
    out_.number(static_cast<std::int32_t>(entity.group));
    out_.number(static_cast<std::int32_t>(entity.number));
    for (const NodeIndex node : rows(entity)[i])
      out_.number(static_cast<std::int32_t>(node_number(node)));
    out_.end_record();
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
      const std::size_t n_groups = entity.group != 0 ? 1 : 0, n_on_boundary = 0;
      out_.number(n_groups);
      if (n_groups > 0) out_.number(entity.group);
      out_.number(n_on_boundary);
      out_.end_record(true);
    }
    end_section("Entities");
  }

  void write_box(const MshEntity& entity) {
    Point<3> low = Point<3>::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto& [type, elements] : entity.by_type)
      for (const std::uint32_t i : elements)
        for (const NodeIndex node : rows(entity)[i]) {
          const Point<3> point = mesh_.point(node);
          low = low.cwiseMin(point);
          high = high.cwiseMax(point);
        }
    // Gmsh scales boxes about their middles, here by 1, which rounds. This keeps the files
    // unchanged.
    const Point<3> middle = 0.5 * (low + high);
    for (const Point<3>& corner : {low, high})
      for (const double x : Point<3>((corner - middle) + middle)) out_.rounded(x);
  }

  /// Writes all nodes in the first entity of the cells, in their order, whichever entities use
  /// them.
  void write_nodes_4() {
    out_.text("$Nodes\n");
    const auto& ids = labels_.node_ids;
    out_.number(entities_.size());
    out_.number(mesh_.n_nodes());
    out_.number(ids.empty() ? std::size_t{1} : *std::min_element(ids.begin(), ids.end()));
    out_.number(ids.empty() ? mesh_.n_nodes() : *std::max_element(ids.begin(), ids.end()));
    out_.end_record();
    for (const MshEntity& entity : entities_) {
      const bool has_nodes = is_of_cells(entity) && entity.number == 1;
      for (const int value : {entity.dimension, entity.number, 0}) out_.number(value);
      out_.number(has_nodes ? mesh_.n_nodes() : std::size_t{0});
      out_.end_record();
      if (!has_nodes) continue;
      for (NodeIndex i = 0; i < mesh_.n_nodes(); ++i) {
        out_.number(node_number(i));
        out_.end_record();
      }
      for (NodeIndex i = 0; i < mesh_.n_nodes(); ++i) {
        write_point(i);
        out_.end_record();
      }
    }
    end_section("Nodes");
  }

  void write_elements_4() {
    out_.text("$Elements\n");
    const auto& ids = labels_.cell_ids;
    std::size_t n_blocks = 0;
    for (const MshEntity& entity : entities_) n_blocks += entity.by_type.size();
    out_.number(n_blocks);
    out_.number(n_elements());
    out_.number(ids.empty() ? std::size_t{1} : *std::min_element(ids.begin(), ids.end()));
    out_.number(last_cell_ + labels_.facets.size());
    out_.end_record();
    for (const MshEntity& entity : entities_)
      for (const auto& [type, elements] : entity.by_type) {
        for (const int value : {entity.dimension, entity.number, type}) out_.number(value);
        out_.number(elements.size());
        out_.end_record();
        for (const std::uint32_t i : elements) {
          out_.number(element_number(entity, i));
          for (const NodeIndex node : rows(entity)[i]) out_.number(node_number(node));
          out_.end_record(true);
        }
      }
    end_section("Elements");
  }

  const MeshView& mesh_;
  const MeshLabels& labels_;
  MshOutput& out_;
  std::vector<MshEntity> entities_;  ///< of the facets, then of the cells
  std::size_t last_cell_ = 0;
};

void require_version_2_holds(const std::filesystem::path& path, const Topology& topology) {
  const MeshLabels& labels = topology.labels();
  const auto& tags = labels.cell_tags;
  const auto n_untagged = static_cast<std::size_t>(std::count(tags.begin(), tags.end(), 0));
  const bool is_tagged_in_part = n_untagged > 0 && n_untagged < tags.size();
  const bool has_only_tagged_facets = labels.facets.size() > 0 && n_untagged == tags.size();
  if (is_tagged_in_part || has_only_tagged_facets)
    throw InputError("cannot write " + path.string() +
                     ": some cells have no physical tag, which version 2.2 cannot hold; use 4.1");
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
  const bool is_version_4 = options.msh_version == MshVersion::v4_1;
  if (!is_version_4) require_version_2_holds(path, mesh.topology());
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    MshOutput out(temporary, options.msh_binary);
    MshWriter writer(mesh, out);
    is_version_4 ? writer.write_4() : writer.write_2();
  });
}

}  // namespace smoothfem
