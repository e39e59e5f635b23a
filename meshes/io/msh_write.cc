#include <gmsh.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "meshes/io/atomic_file.h"
#include "meshes/io/gmsh_session.h"
#include "meshes/io/msh_file.h"
#include "smoothing/mesh/input_error.h"

namespace smoothfem {

namespace {

constexpr int line_type = 1, triangle_type = 2, quadrilateral_type = 3;  // Gmsh's numbers

void require_writable(const std::filesystem::path& path, const Topology& topology,
                      const MeshWriteOptions& options) {
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    if (topology.cell_type(c) == ElementType::polygon) {
      std::string others;
      for (const auto& format : mesh_formats())
        if (format.holds_polygons) others += (others.empty() ? "" : ", ") + format.extension;
      throw InputError(
          "cannot write " + path.string() + ": cell " + std::to_string(c) + " has " +
          std::to_string(topology.cell_nodes(c).size()) +
          " nodes, and .msh files hold only triangles and quadrilaterals; use one of " + others);
    }
  const auto& tags = topology.labels().cell_tags;
  const auto n_untagged = static_cast<std::size_t>(std::count(tags.begin(), tags.end(), 0));
  const bool tagged_in_part = n_untagged > 0 && n_untagged < tags.size();
  const bool only_edges_tagged = topology.labels().facets.size() > 0 && n_untagged == tags.size();
  if (options.msh_version == MshVersion::v2_2 && (tagged_in_part || only_edges_tagged))
    throw InputError("cannot write " + path.string() +
                     ": some cells have no physical tag, which version 2.2 cannot hold; use 4.1");
}

void add_nodes(const PlanarMesh& mesh, int surface) {
  std::vector<std::size_t> tags(mesh.n_nodes());
  std::vector<double> xyz;
  xyz.reserve(3 * mesh.n_nodes());
  for (std::size_t i = 0; i < mesh.n_nodes(); ++i) {
    tags[i] = i + 1;
    xyz.insert(xyz.end(), {mesh.coordinates()[i].x(), mesh.coordinates()[i].y(), 0.0});
  }
  gmsh::model::mesh::addNodes(2, surface, tags, xyz);
}

/// Elements of one entity by Gmsh type: tags and 1-based node tags.
struct TypedElements {
  std::map<int, std::pair<std::vector<std::size_t>, std::vector<std::size_t>>> by_type;

  void add(int type, std::size_t tag, std::span<const NodeIndex> nodes) {
    auto& [tags, node_tags] = by_type[type];
    tags.push_back(tag);
    for (const NodeIndex node : nodes) node_tags.push_back(std::size_t{node} + 1);
  }
};

/// One discrete entity for each physical tag; 0 stands for no group.
void add_entities(int dimension, const std::map<int, TypedElements>& by_tag,
                  const std::map<std::pair<int, int>, std::string>& names) {
  int entity = 0;
  for (const auto& [tag, elements] : by_tag) {
    ++entity;
    if (dimension != 2 || entity != 1) gmsh::model::addDiscreteEntity(dimension, entity);
    for (const auto& [type, lists] : elements.by_type)
      gmsh::model::mesh::addElementsByType(entity, type, lists.first, lists.second);
    if (tag == 0) continue;
    gmsh::model::addPhysicalGroup(dimension, {entity}, tag);
    const auto name = names.find({dimension, tag});
    if (name != names.end()) gmsh::model::setPhysicalName(dimension, tag, name->second);
  }
}

/// Cells keep their order as element tags 1, 2, ...; edges follow them.
void build_model(const PlanarMesh& mesh) {
  const Topology& topology = mesh.topology();
  const MeshLabels& labels = topology.labels();
  std::map<int, TypedElements> cells, facets;
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    cells[labels.cell_tags.empty() ? 0 : labels.cell_tags[c]].add(
        topology.cell_type(c) == ElementType::triangle ? triangle_type : quadrilateral_type,
        std::size_t{c} + 1, topology.cell_nodes(c));
  for (std::size_t f = 0; f < labels.facets.size(); ++f)
    facets[labels.facet_tags[f]].add(line_type, topology.n_cells() + f + 1, labels.facets[f]);
  // All nodes stand in the first surface, in their order, whichever entities use them.
  gmsh::model::addDiscreteEntity(2, 1);
  add_nodes(mesh, 1);
  add_entities(2, cells, labels.names);
  add_entities(1, facets, labels.names);
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

}  // namespace

void write_msh(const std::filesystem::path& path, const PlanarMesh& mesh, const MeshFields&,
               const MeshWriteOptions& options) {
  require_writable(path, mesh.topology(), options);
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
  });
}

}  // namespace smoothfem
