// SPDX-License-Identifier: GPL-3.0-or-later
/// The table "What each format holds" of the manual: each of its cells by a round trip.
#include "meshes/io/losses.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/base/text.h"
#include "smoothing/mesh/fixed_nodes.h"

namespace smoothfem {
namespace {

/// Two squares side by side; the inner edge is between nodes 1 and 4.
PlanarMesh two_squares(MeshLabels labels, FileContent content,
                       std::optional<std::vector<bool>> fixed = {}) {
  CompressedRows<NodeIndex> cells;
  cells.append(std::vector<NodeIndex>{0, 1, 4, 3});
  cells.append(std::vector<NodeIndex>{1, 2, 5, 4});
  labels.content = std::make_shared<const FileContent>(std::move(content));
  return {
      std::make_shared<const Topology>(2, 6, std::move(cells), std::move(fixed), std::move(labels)),
      {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}}};
}

MeshLabels tagged() {
  MeshLabels labels;
  labels.cell_tags = {3, 4};
  labels.facets.append(std::vector<NodeIndex>{0, 1});
  labels.facet_tags = {7};
  return labels;
}

MeshField field(const std::string& name, std::vector<double> values) {
  return {.name = name, .n_components = 1, .type = NumberType::float64, .values = values};
}

OtherElements elements(std::vector<std::vector<NodeIndex>> rows) {
  OtherElements others;
  for (const auto& row : rows) {
    others.nodes.append(row);
    others.tags.push_back(0);
  }
  return others;
}

/// A row of the table: a mesh that says this one thing, and whether a mesh still says it.
struct Thing {
  std::string row;
  PlanarMesh mesh;
  bool (*is_kept)(const PlanarMesh& read, const PlanarMesh& written);
};

const MeshLabels& labels_of(const PlanarMesh& mesh) {
  return mesh.topology().labels();
}
const FileContent& content_in(const PlanarMesh& mesh) {
  static const FileContent none;
  return labels_of(mesh).content ? *labels_of(mesh).content : none;
}

/// True if the groups of these elements are the same, whatever the numbers of their entities.
bool have_same_groups(const PlanarMesh& a, const PlanarMesh& b) {
  const auto groups = [](const PlanarMesh& mesh, CellIndex c) {
    const auto& entities = content_in(mesh).cell_entities;
    auto all = groups_of(&content_in(mesh), 2, entities.empty() ? 0 : entities[c],
                         labels_of(mesh).cell_tags[c]);
    std::sort(all.begin(), all.end());
    return all;
  };
  if (labels_of(a).cell_tags.size() != a.n_cells()) return false;
  for (CellIndex c = 0; c < a.n_cells(); ++c)
    if (groups(a, c) != groups(b, c)) return false;
  return true;
}

std::vector<Thing> things() {
  std::vector<Thing> all;
  all.push_back({"groups of cells, edges, faces", two_squares(tagged(), {}),
                 [](const PlanarMesh& read, const PlanarMesh& written) {
                   return labels_of(read).cell_tags == labels_of(written).cell_tags &&
                          labels_of(read).facet_tags == labels_of(written).facet_tags;
                 }});
  MeshLabels named = tagged();
  named.names = {{{2, 3}, "steel"}, {{1, 7}, "wall"}};
  all.push_back({"names of groups", two_squares(named, {}),
                 [](const PlanarMesh& read, const PlanarMesh& written) {
                   return labels_of(read).names == labels_of(written).names;
                 }});
  FileContent several;
  several.cell_entities = {1, 2};
  several.facet_entities = {1};
  several.entities[{2, 1}].groups = {3, 5};
  several.entities[{2, 2}].groups = {4};
  several.entities[{1, 1}].groups = {7};
  all.push_back({"several groups of an element", two_squares(tagged(), several), have_same_groups});
  FileContent fields;
  fields.node_fields = {field("heat", {1, 2, 3, 4, 5, 6})};
  fields.element_fields = {field("flow", {1.5, 2.5})};
  all.push_back({"fields at nodes and elements", two_squares({}, fields),
                 [](const PlanarMesh& read, const PlanarMesh& written) {
                   const auto &a = content_in(read), &b = content_in(written);
                   return a.node_fields.size() == 1 && a.element_fields.size() == 1 &&
                          a.node_fields[0].values == b.node_fields[0].values &&
                          a.element_fields[0].values == b.element_fields[0].values;
                 }});
  FileContent others;
  others.others[0] = elements({{4}});
  others.others[1] = elements({{0, 1}, {1, 4}});
  all.push_back({"points, edges, faces without a group", two_squares({}, others),
                 [](const PlanarMesh& read, const PlanarMesh&) {
                   return content_in(read).others[0].nodes.size() == 1 &&
                          content_in(read).others[1].nodes.size() == 2;
                 }});
  MeshLabels numbered;
  numbered.node_ids = {11, 12, 13, 14, 15, 17};
  numbered.cell_ids = {21, 23};
  all.push_back({"numbers of nodes and cells", two_squares(numbered, {}),
                 [](const PlanarMesh& read, const PlanarMesh& written) {
                   return labels_of(read).node_ids == labels_of(written).node_ids &&
                          labels_of(read).cell_ids == labels_of(written).cell_ids;
                 }});
  all.push_back({"fixed nodes", two_squares({}, {}, std::vector<bool>{1, 0, 0, 1, 0, 0}),
                 [](const PlanarMesh& read, const PlanarMesh& written) {
                   for (NodeIndex i = 0; i < read.n_nodes(); ++i)
                     if (read.topology().is_fixed(i) != written.topology().is_fixed(i))
                       return false;
                   return true;
                 }});
  FileContent periodic;
  periodic.periodic = {
      {.dimension = 1, .entity = 2, .partner = 1, .affine = {}, .nodes = {{2, 0}, {5, 3}}}};
  all.push_back({"periodic partners", two_squares({}, periodic),
                 [](const PlanarMesh& read, const PlanarMesh& written) {
                   return content_in(read).periodic.size() == 1 &&
                          content_in(read).periodic[0].nodes ==
                              content_in(written).periodic[0].nodes;
                 }});
  FileContent required;
  required.node_fields = {field("required", {0, 0, 0, 0, 1, 0})};
  all.push_back({"required elements, corners, ridges", two_squares({}, required),
                 [](const PlanarMesh& read, const PlanarMesh&) {
                   const FixedReasons reasons = read.topology().fixed_reasons(4);
                   const bool is_medit = content_in(read).format == "medit";
                   return has(reasons, is_medit ? FixedReason::marked : FixedReason::required);
                 }});
  FileContent plane;
  plane.plane = PlaneInSpace{Point<3>::Zero(), Point<3>::UnitX(), Point<3>::UnitZ(), {}};
  all.push_back({"a plane other than z = 0", two_squares({}, plane),
                 [](const PlanarMesh& read, const PlanarMesh&) {
                   return MeshView(read).point(5).isApprox(Point<3>(2, 0, 1));
                 }});
  return all;
}

/// Returns the rows of the manual's table: name -> cells.
std::map<std::string, std::vector<std::string>> table_of_manual() {
  std::map<std::string, std::vector<std::string>> rows;
  std::istringstream page(content_of(std::filesystem::path(SMOOTHFEM_SOURCE_DIR) /
                                     "docs/how-to/keep-what-a-file-says.md"));
  bool is_inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) is_inside = line == "## What each format holds";
    if (!is_inside || !line.starts_with("| ")) continue;
    std::vector<std::string> cells;
    std::istringstream parts(line.substr(1));
    for (std::string cell; std::getline(parts, cell, '|');) {
      const auto first = cell.find_first_not_of(' '), last = cell.find_last_not_of(' ');
      cells.push_back(first == cell.npos ? "" : cell.substr(first, last - first + 1));
    }
    const std::string name = cells.front();
    cells.erase(cells.begin());
    rows[name] = std::move(cells);
  }
  return rows;
}

class FormatTable : public FileTest {};

TEST_F(FormatTable, OfTheManualIsTrueInEachCell) {
  const auto table = table_of_manual();
  // The columns of the table, each with the files it is about.
  struct Column {
    std::vector<std::string> files;
    MeshWriteOptions options;
  };
  const std::vector<Column> columns{{{"x.msh"}, {.msh_version = MshVersion::v4_1}},
                                    {{"x.msh"}, {.msh_version = MshVersion::v2_2}},
                                    {{"x.vtk", "x.vtu"}, {}},
                                    {{"x.mesh"}, {}},
                                    {{"x.inp"}, {}},
                                    {{"x.mesh"}, {}}};
  for (const Thing& thing : things()) {
    const auto row = table.find(thing.row);
    ASSERT_NE(row, table.end()) << thing.row;
    ASSERT_GE(row->second.size(), columns.size()) << thing.row;
    for (std::size_t k = 0; k < columns.size(); ++k)
      for (const std::string& name : columns[k].files) {
        SCOPED_TRACE(thing.row + ", column " + std::to_string(k) + ", " + name);
        PlanarMesh mesh = thing.mesh;
        if (name == "x.mesh") {  // two formats share the extension
          FileContent content = content_in(mesh);
          content.format = k == 3 ? "medit" : "polygonal";
          MeshLabels labels = labels_of(mesh);
          labels.content = std::make_shared<const FileContent>(std::move(content));
          mesh = PlanarMesh(
              std::make_shared<const Topology>(2, mesh.n_nodes(), mesh.topology().cells(),
                                               mesh.topology().fixed_reasons(), std::move(labels)),
              mesh.copied_coordinates());
        }
        write_mesh(file(name), mesh, {}, columns[k].options);
        const MeshFile read = read_mesh(file(name));
        const auto* planar = std::get_if<PlanarMesh>(&read.mesh);
        const bool is_kept = planar && thing.is_kept(*planar, thing.mesh);
        const auto lost = losses(file(name), mesh);
        const std::string& said = row->second[k];
        EXPECT_EQ(is_kept, lost.empty()) << joined(lost);
        if (said.empty()) {
          EXPECT_FALSE(is_kept);
        }
        if (said == "yes" || said == "as fields") {
          EXPECT_TRUE(is_kept);
        }
      }
  }
}

}  // namespace
}  // namespace smoothfem
