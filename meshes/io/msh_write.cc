// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmsh.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <unordered_map>

#include "meshes/io/atomic_file.h"
#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/msh_file.h"
#include "meshes/io/number_text.h"
#include "meshes/tools/gmsh_session.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

/// Gmsh's number of the element type with these nodes; its nodes have our order.
int gmsh_type(int dim, std::size_t n_nodes) {
  if (dim == 1) return 1;
  switch (element_type(dim, n_nodes)) {
    case ElementType::triangle:
      return 2;
    case ElementType::quadrilateral:
      return 3;
    case ElementType::tetrahedron:
      return 4;
    case ElementType::hexahedron:
      return 5;
    case ElementType::prism:
      return 6;
    case ElementType::pyramid:
      return 7;
    case ElementType::polygon:
      break;  // refused before
  }
  return 0;
}

void require_tags_fit(const std::filesystem::path& path, const Topology& topology,
                      const MeshWriteOptions& options) {
  const auto& tags = topology.labels().cell_tags;
  const auto n_untagged = static_cast<std::size_t>(std::count(tags.begin(), tags.end(), 0));
  const bool tagged_in_part = n_untagged > 0 && n_untagged < tags.size();
  const bool only_edges_tagged = topology.labels().facets.size() > 0 && n_untagged == tags.size();
  if (options.msh_version == MshVersion::v2_2 && (tagged_in_part || only_edges_tagged))
    throw InputError("cannot write " + path.string() +
                     ": some cells have no physical tag, which version 2.2 cannot hold; use 4.1");
}

/// The numbers that nodes or cells get: those of the labels, or 1, 2, ...
std::vector<std::size_t> numbers(const std::vector<std::size_t>& ids, std::size_t n) {
  if (!ids.empty()) return ids;
  std::vector<std::size_t> plain(n);
  std::iota(plain.begin(), plain.end(), std::size_t{1});
  return plain;
}

void add_nodes(const MeshView& mesh, const std::vector<std::size_t>& tags) {
  std::vector<double> xyz;
  xyz.reserve(3 * mesh.n_nodes());
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    const Point<3> point = mesh.point(i);
    xyz.insert(xyz.end(), {point.x(), point.y(), point.z()});
  }
  gmsh::model::mesh::addNodes(mesh.dimension(), 1, tags, xyz);
}

/// Elements of one physical tag by Gmsh type: their tags and their node tags.
struct TypedElements {
  std::map<int, std::pair<std::vector<std::size_t>, std::vector<std::size_t>>> by_type;

  void add(int dim, std::size_t tag, std::span<const NodeIndex> nodes,
           const std::vector<std::size_t>& node_tags) {
    auto& [tags, nodes_of_all] = by_type[gmsh_type(dim, nodes.size())];
    tags.push_back(tag);
    for (const NodeIndex node : nodes) nodes_of_all.push_back(node_tags[node]);
  }
};

/// One discrete entity for each physical tag; 0 stands for no group. first_exists: entity 1 is
/// there already.
void add_entities(int dim, bool first_exists, const std::map<int, TypedElements>& by_tag,
                  const std::map<std::pair<int, int>, std::string>& names) {
  int entity = 0;
  for (const auto& [tag, elements] : by_tag) {
    ++entity;
    if (!first_exists || entity != 1) gmsh::model::addDiscreteEntity(dim, entity);
    for (const auto& [type, lists] : elements.by_type)
      gmsh::model::mesh::addElementsByType(entity, type, lists.first, lists.second);
    if (tag == 0) continue;
    gmsh::model::addPhysicalGroup(dim, {entity}, tag);
    const auto name = names.find({dim, tag});
    if (name != names.end()) gmsh::model::setPhysicalName(dim, tag, name->second);
  }
}

/// Facets are numbered behind the cells.
void build_model(const MeshView& mesh) {
  const Topology& topology = mesh.topology();
  const MeshLabels& labels = topology.labels();
  const int dim = mesh.dimension();
  const auto node_tags = numbers(labels.node_ids, mesh.n_nodes());
  const auto cell_tags = numbers(labels.cell_ids, mesh.n_cells());
  std::map<int, TypedElements> cells, facets;
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    cells[labels.cell_tags.empty() ? 0 : labels.cell_tags[c]].add(
        dim, cell_tags[c], topology.cell_nodes(c), node_tags);
  std::size_t last = *std::max_element(cell_tags.begin(), cell_tags.end());
  for (std::size_t f = 0; f < labels.facets.size(); ++f)
    facets[labels.facet_tags[f]].add(dim - 1, ++last, labels.facets[f], node_tags);
  // All nodes stand in the first entity of the cells, in their order, whichever entities use them.
  gmsh::model::addDiscreteEntity(dim, 1);
  add_nodes(mesh, node_tags);
  add_entities(dim, true, cells, labels.names);
  add_entities(dim - 1, false, facets, labels.names);
}

/// Gmsh does not look whether its writes succeed: a full disk shows as a missing end.
void require_complete_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(file), {}};
  constexpr std::string_view end = "$EndElements";
  const std::size_t last = content.find_last_not_of("\r\n");
  if (last == std::string::npos || !std::string_view(content).substr(0, last + 1).ends_with(end))
    throw std::runtime_error("only a part of it could be written; is the disk full?");
}

/// Gmsh prints 16 digits into text files: one too few to get every coordinate back, and enough of
/// a difference to make a barely valid cell invalid. Prints those of $Nodes again with all.
class NodesPrintedAgain {
 public:
  NodesPrintedAgain(const std::filesystem::path& file, const MeshView& mesh)
      : content_(read_whole_file(file)), reader_(file, content_), mesh_(mesh) {
    const auto tags = numbers(mesh.topology().labels().node_ids, mesh.n_nodes());
    for (NodeIndex i = 0; i < tags.size(); ++i) index_of_tag_.emplace(tags[i], i);
  }

  std::string text(bool version_4) {
    do reader_.require_line("$Nodes");
    while (reader_.word() != "$Nodes");
    text_ = content_.substr(0, content_.size() - reader_.rest().size());
    reader_.require_line("the number of nodes");
    copy_line();
    const std::uint64_t n = reader_.integer("the number of nodes or blocks");
    for (std::uint64_t i = 0; i < n; ++i) version_4 ? print_block() : print_node();
    return text_.append(reader_.rest());
  }

 private:
  void copy_line() { text_.append(reader_.text()).append("\n"); }

  void print_node() {
    reader_.require_line("a node");
    const std::uint64_t tag = reader_.integer("the node's tag");
    append_number(text_, tag);
    text_ += ' ';
    print_point(tag);
  }

  void print_block() {
    reader_.require_line("a block of nodes");
    copy_line();
    for (int skipped = 0; skipped < 3; ++skipped) reader_.word();
    std::vector<std::uint64_t> tags(reader_.integer("the number of nodes in the block"));
    for (auto& tag : tags) {
      reader_.require_line("a node's tag");
      tag = reader_.integer("the node's tag");
      copy_line();
    }
    for (const std::uint64_t tag : tags) {
      reader_.require_line("a node's coordinates");
      print_point(tag);
    }
  }

  void print_point(std::uint64_t tag) {
    const Point<3> point = mesh_.point(index_of_tag_.at(tag));
    for (int d = 0; d < 3; ++d) {
      append_number(text_, point[d]);
      text_ += d < 2 ? ' ' : '\n';
    }
  }

  std::string content_, text_;
  LineReader reader_;
  const MeshView& mesh_;
  std::unordered_map<std::uint64_t, NodeIndex> index_of_tag_;
};

}  // namespace

void write_msh(const std::filesystem::path& path, const MeshView& mesh, const MeshFields&,
               const MeshWriteOptions& options) {
  require_no_polygons(path, mesh);
  require_tags_fit(path, mesh.topology(), options);
  GmshSession session;
  const bool version_4 = options.msh_version == MshVersion::v4_1;
  session.set_option("Mesh.MshFileVersion", version_4 ? 4.1 : 2.2);
  session.set_option("Mesh.Binary", options.msh_binary ? 1 : 0);
  session.set_option("Mesh.PreserveNumberingMsh2", 1);    // the order of the cells
  session.set_option("Mesh.SaveAll", version_4 ? 1 : 0);  // 2.2 would lose the tags
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    session.run("cannot write " + path.string(), [&] {
      build_model(mesh);
      gmsh::write(temporary.string());
    });
    require_complete_file(temporary);
    if (!options.msh_binary)
      write_atomically(temporary, NodesPrintedAgain(temporary, mesh).text(version_4));
  });
}

}  // namespace smoothfem
