// SPDX-License-Identifier: GPL-3.0-or-later
// The reader and the writer of .msh against Gmsh's own.
#include <gmsh.h>

#include <functional>
#include <map>

#include "meshes/tests/labelled_box.h"
#include "meshes/tests/mesh_tests.h"
#include "meshes/tools/gmsh_session.h"

namespace smoothfem {
namespace {

struct Variant {
  std::string name;
  MeshWriteOptions options;
  friend void PrintTo(const Variant& parameter, std::ostream* out) { *out << parameter.name; }
};

const auto variants = ::testing::Values(Variant{"v41_binary", {MshVersion::v4_1, true}},
                                        Variant{"v41_text", {MshVersion::v4_1, false}},
                                        Variant{"v22_binary", {MshVersion::v2_2, true}},
                                        Variant{"v22_text", {MshVersion::v2_2, false}});

/// An element by its number: its physical tag, and its nodes' coordinates.
struct Element {
  int tag;
  std::vector<Point<3>> nodes;
  bool operator==(const Element&) const = default;
};
using Elements = std::map<std::size_t, Element>;
using Names = std::map<std::pair<int, int>, std::string>;

// --- Contents of the current model ---------------------------------------------------------------

std::map<std::size_t, Point<3>> nodes_of_model() {
  std::vector<std::size_t> tags;
  std::vector<double> xyz, parameters;
  gmsh::model::mesh::getNodes(tags, xyz, parameters);
  std::map<std::size_t, Point<3>> nodes;
  for (std::size_t i = 0; i < tags.size(); ++i)
    nodes[tags[i]] = {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
  return nodes;
}

/// Elements without a group have the tag 0.
Elements elements_of_model(int dimension) {
  const auto points = nodes_of_model();
  Elements elements;
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities, dimension);
  for (const auto& [dim, entity] : entities) {
    std::vector<int> groups, types;
    gmsh::model::getPhysicalGroupsForEntity(dim, entity, groups);
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, dim, entity);
    for (std::size_t t = 0; t < types.size(); ++t) {
      const std::size_t n = nodes[t].size() / tags[t].size();
      for (std::size_t e = 0; e < tags[t].size(); ++e) {
        Element& element = elements[tags[t][e]];
        element.tag = groups.empty() ? 0 : groups.front();
        for (std::size_t k = 0; k < n; ++k) element.nodes.push_back(points.at(nodes[t][e * n + k]));
      }
    }
  }
  return elements;
}

Names names_of_model(int least_dimension) {
  Names names;
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups);
  for (const auto& [dimension, tag] : groups) {
    std::string name;
    gmsh::model::getPhysicalName(dimension, tag, name);
    if (!name.empty() && dimension >= least_dimension) names[{dimension, tag}] = name;
  }
  return names;
}

// --- Contents of the mesh ------------------------------------------------------------------------

Point<3> in_space(const Point<2>& p) {
  return {p.x(), p.y(), 0.0};
}
Point<3> in_space(const Point<3>& p) {
  return p;
}

template <int dim>
Elements elements_in(const Mesh<dim>& mesh) {
  const MeshLabels& labels = mesh.topology().labels();
  Elements cells;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    Element& cell = cells[labels.cell_ids.empty() ? c + 1 : labels.cell_ids[c]];
    cell.tag = labels.cell_tags.empty() ? 0 : labels.cell_tags[c];
    for (const NodeIndex node : mesh.topology().cell_nodes(c))
      cell.nodes.push_back(in_space(mesh.copied_coordinates()[node]));
  }
  return cells;
}

/// Facets with a tag; their numbers are not kept.
template <int dim>
std::vector<Element> facets_of(const Mesh<dim>& mesh) {
  const MeshLabels& labels = mesh.topology().labels();
  std::vector<Element> facets;
  for (std::size_t f = 0; f < labels.facets.size(); ++f) {
    Element& facet = facets.emplace_back(Element{labels.facet_tags[f], {}});
    for (const NodeIndex node : labels.facets[f])
      facet.nodes.push_back(in_space(mesh.copied_coordinates()[node]));
  }
  return facets;
}

std::vector<Element> tagged(const Elements& elements) {
  std::vector<Element> result;
  for (const auto& [number, element] : elements)
    if (element.tag != 0) result.push_back(element);
  return result;
}

/// Gmsh prints one digit too few to keep every bit.
void expect_near(const Element& a, const Element& b, double tolerance) {
  EXPECT_EQ(a.tag, b.tag);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t k = 0; k < a.nodes.size(); ++k)
    EXPECT_LE((a.nodes[k] - b.nodes[k]).lpNorm<Eigen::Infinity>(), tolerance);
}

// --- Files that Gmsh writes ----------------------------------------------------------------------

/// A square around a disc: two groups, a side in a third one, and a point that no element uses.
void build_disc_in_square() {
  namespace occ = gmsh::model::occ;
  const int square = occ::addRectangle(0, 0, 0, 1, 1), disc = occ::addDisk(0.5, 0.5, 0, 0.2, 0.2);
  gmsh::vectorpair parts;
  std::vector<gmsh::vectorpair> origin;
  occ::fragment({{2, square}}, {{2, disc}}, parts, origin);
  occ::synchronize();
  for (std::size_t i = 0; i < parts.size(); ++i)
    gmsh::model::addPhysicalGroup(2, {parts[i].second}, 30 - 7 * static_cast<int>(i));
  gmsh::model::setPhysicalName(2, 30, "the disc");
  gmsh::model::addPhysicalGroup(1, {2}, 4);
  gmsh::model::setPhysicalName(1, 4, "side");
  gmsh::model::mesh::generate(2);
}

/// Prisms below, tetrahedra above; in blocks of several types and entities.
void build_layers_and_tetrahedra() {
  namespace occ = gmsh::model::occ;
  occ::addRectangle(0, 0, 0, 1, 1);
  gmsh::vectorpair layers, block;
  occ::extrude({{2, 1}}, 0, 0, 0.5, layers, {2}, {}, true);
  occ::extrude({layers[0]}, 0, 0, 0.7, block);
  occ::synchronize();
  gmsh::model::addPhysicalGroup(3, {layers[1].second}, 2);
  gmsh::model::addPhysicalGroup(3, {block[1].second}, 1);
  gmsh::model::setPhysicalName(3, 1, "block");
  gmsh::model::addPhysicalGroup(2, {1, block[0].second}, 8);
  gmsh::model::mesh::generate(3);
}

/// Files that Gmsh writes; it has no binary files of version 4.0.
struct GmshVariant {
  std::string name;
  double version;
  bool is_binary;
  friend void PrintTo(const GmshVariant& parameter, std::ostream* out) { *out << parameter.name; }
};

class MshOfGmsh : public FileTest, public ::testing::WithParamInterface<GmshVariant> {
 protected:
  template <int dim>
  void expect_read_as_it_is(const std::function<void()>& build) {
    const bool is_2 = GetParam().version < 4.0, is_binary = GetParam().is_binary;
    GmshSession session;
    session.set_option("Mesh.MeshSizeMax", 0.3);
    session.set_option("Mesh.MshFileVersion", GetParam().version);
    session.set_option("Mesh.Binary", is_binary);
    session.set_option("Mesh.SaveAll", !is_2);  // version 2.2 would lose the tags
    session.set_option("Mesh.PreserveNumberingMsh2", 1);
    session.set_option("Mesh.SaveParametric", !is_2);
    session.run("model", [&] {
      build();
      gmsh::write(file("a.msh").string());
    });
    const auto mesh = std::get<Mesh<dim>>(read_mesh(file("a.msh")).mesh);
    const double tolerance = is_binary ? 0.0 : 1e-15;
    const Elements expected = elements_of_model(dim), found = elements_in(mesh);
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [number, element] : found)
      expect_near(element, expected.at(number), tolerance);
    const auto expected_facets = tagged(elements_of_model(dim - 1)), facets = facets_of(mesh);
    ASSERT_EQ(facets.size(), expected_facets.size());
    for (std::size_t f = 0; f < facets.size(); ++f)
      expect_near(facets[f], expected_facets[f], tolerance);
    EXPECT_EQ(mesh.topology().labels().names, names_of_model(dim - 1));
  }
};

TEST_P(MshOfGmsh, PlanarMeshesAreReadAsTheyAre) {
  expect_read_as_it_is<2>(build_disc_in_square);
}

TEST_P(MshOfGmsh, VolumeMeshesAreReadAsTheyAre) {
  expect_read_as_it_is<3>(build_layers_and_tetrahedra);
}

INSTANTIATE_TEST_SUITE_P(Msh, MshOfGmsh,
                         ::testing::Values(GmshVariant{"v41_binary", 4.1, true},
                                           GmshVariant{"v41_text", 4.1, false},
                                           GmshVariant{"v40_text", 4.0, false},
                                           GmshVariant{"v22_binary", 2.2, true},
                                           GmshVariant{"v22_text", 2.2, false}),
                         [](const auto& info) { return info.param.name; });

using MshOfPartitions = FileTest;

TEST_F(MshOfPartitions, IsReadByGmshAfterwards) {
  const std::string before = file("a.msh").string(), after = file("b.msh").string();
  GmshSession session;
  session.set_option("Mesh.MeshSizeMax", 0.3);
  session.set_option("Mesh.PartitionCreateGhostCells", 1);
  session.run("model", [&] {
    build_disc_in_square();
    gmsh::model::mesh::partition(2);
    gmsh::write(before);
  });
  write_mesh(after, read_mesh(before).mesh);
  session.run("result", [&] {
    gmsh::open(after);
    gmsh::model::remove();
  });
}

/// Copies of elements do not count, and neither do the elements between partitions.
TEST_F(MshOfPartitions, IsTheMeshWithoutPartitions) {
  for (const int is_binary : {0, 1})
    for (const int has_topology : {0, 1}) {
      GmshSession session;
      session.set_option("Mesh.MeshSizeMax", 0.3);
      session.set_option("Mesh.PartitionCreateGhostCells", 1);
      session.set_option("Mesh.Binary", is_binary);
      session.set_option("Mesh.PartitionCreateTopology", has_topology);
      session.run("model", [&] {
        build_layers_and_tetrahedra();
        gmsh::write(file("whole.msh").string());
        gmsh::model::mesh::partition(3);
        gmsh::write(file("divided.msh").string());
      });
      const auto read = [&](const char* name) {
        return std::get<VolumeMesh>(read_mesh(file(name)).mesh);
      };
      const VolumeMesh whole = read("whole.msh"), divided = read("divided.msh");
      EXPECT_EQ(divided.copied_coordinates(), whole.copied_coordinates());
      EXPECT_EQ(elements_in(divided), elements_in(whole));
      EXPECT_EQ(facets_of(divided), facets_of(whole));
      EXPECT_EQ(divided.topology().fixed_reasons(), whole.topology().fixed_reasons());
    }
}

TEST_F(MshOfPartitions, OneFileOfSeveralIsReadWithANote) {
  for (const double version : {4.1, 2.2}) {
    GmshSession session;
    session.set_option("Mesh.MeshSizeMax", 0.3);
    session.set_option("Mesh.PartitionSplitMeshFiles", 1);
    session.set_option("Mesh.MshFileVersion", version);
    session.run("model", [&] {
      build_layers_and_tetrahedra();
      gmsh::model::mesh::partition(3);
      gmsh::write(file("all.msh").string());
    });
    EXPECT_THAT(read_mesh(file("all_2.msh")).notes,
                ::testing::Contains(::testing::HasSubstr(
                    version > 3.0 ? "part 2 of the 3 parts of a mesh, and only this part is read"
                                  : "all elements are of partition 2; if Gmsh has split")));
  }
}

// --- Files that smoothfem writes -----------------------------------------------------------------

class MshForGmsh : public FileTest, public ::testing::WithParamInterface<Variant> {
 protected:
  template <int dim>
  void expect_read_by_gmsh(const Mesh<dim>& mesh) {
    write_mesh(file("a.msh"), mesh, {}, GetParam().options);
    const GmshSession session;
    session.run("a.msh", [&] { gmsh::open(file("a.msh").string()); });
    const MeshLabels& labels = mesh.topology().labels();
    const auto nodes = nodes_of_model();
    ASSERT_EQ(nodes.size(), mesh.n_nodes());
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      EXPECT_EQ(nodes.at(labels.node_ids.empty() ? i + 1 : labels.node_ids[i]),
                in_space(mesh.coordinates()[i]));
    EXPECT_EQ(elements_of_model(dim), elements_in(mesh));
    EXPECT_EQ(tagged(elements_of_model(dim - 1)), facets_of(mesh));
    EXPECT_EQ(names_of_model(0), labels.names);
    gmsh::model::remove();  // open() makes another model
  }
};

TEST_P(MshForGmsh, PlanarMeshes) {
  expect_read_by_gmsh(mixed_mesh(false, labels_of_mixed_mesh()));
  expect_read_by_gmsh(mixed_mesh(false));
}

TEST_P(MshForGmsh, VolumeMeshesWithNodeNumbers) {
  for (const auto kind : {test::BoxCells::tetrahedra, test::BoxCells::hexahedra,
                          test::BoxCells::prisms, test::BoxCells::mixed})
    expect_read_by_gmsh(labelled_box(kind));
}

INSTANTIATE_TEST_SUITE_P(Msh, MshForGmsh, variants,
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace smoothfem
