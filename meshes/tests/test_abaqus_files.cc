// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "meshes/io/losses.h"
#include "meshes/io/mesh_file.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/mesh/interfaces.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string two_nodes = "1, 0, 0\n2, 1, 0\n3, 2, 0\n",
                  more_nodes = "4, 0, 1\n5, 1, 1\n6, 2, 1\n",
                  two_squares = "1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n";

class AbaqusFiles : public FileTest {
 protected:
  static const Topology& topology(const MeshFile& read) {
    return std::get<PlanarMesh>(read.mesh).topology();
  }
  /// Names of the groups of a cell.
  static std::vector<std::string> groups(const MeshFile& read, CellIndex cell) {
    const MeshLabels& labels = topology(read).labels();
    const auto& entities = labels.content->cell_entities;
    std::vector<std::string> names;
    for (const int group : groups_of(labels.content.get(), 2, entities.empty() ? 0 : entities[cell],
                                     labels.cell_tags[cell]))
      names.push_back(labels.names.at({2, group}));
    return names;
  }
};

TEST_F(AbaqusFiles, IncludedFilesAreReadAndWrittenInPlace) {
  std::filesystem::create_directory(file("deep"));
  file_with("deep/nodes.inp", more_nodes + "*INCLUDE, INPUT=deep/cells.inp");
  file_with("deep/cells.inp", "*Element, type=CPS4, elset=all\n" + two_squares);
  file_with("more.dat", "1\n");
  const auto path =
      file_with("a.inp", "*NODE\n" + two_nodes + "*Include,\ninput=\"deep/nodes.inp\"\n** end\n" +
                             "*ELSET, ELSET=\"a b\", INPUT=more.dat\n*STEP\n");
  const MeshFile read = read_mesh(path);
  EXPECT_EQ(topology(read).n_cells(), 2u);
  EXPECT_THAT(groups(read, 0), ElementsAre("all", "a b"));
  EXPECT_THAT(read.cell_lines, ElementsAre(6, 6));  // that of the keyword
  EXPECT_THAT(read.notes, ElementsAre(HasSubstr("includes 3 others, whose text is in place")));
  write_mesh(file("b.inp"), read.mesh);
  EXPECT_EQ(content_of(file("b.inp")), "*NODE\n" + two_nodes + more_nodes +
                                           "*Element, type=CPS4, elset=all\n" + two_squares +
                                           "** end\n*ELSET, ELSET=\"a b\"\n1\n*STEP\n");
  EXPECT_THAT(read_mesh(file("b.inp")).notes, IsEmpty());
}

TEST_F(AbaqusFiles, IncludesOnlyFilesOfItsFolder) {
  std::filesystem::create_directory(file("job"));
  file_with("secret.inp", "*NODE\n");
  file_with("job/loop.inp", "*INCLUDE, INPUT=more.inp\n");
  file_with("job/more.inp", "*INCLUDE, INPUT=loop.inp\n");
  file_with("job/bad.inp", "*NODE\n1, x\n");
  std::filesystem::create_symlink(file("secret.inp"), file("job/link.inp"));
  const auto error = [&](const std::string& name) {
    const auto path = file_with("job/a.inp", "** a comment\n*INCLUDE, INPUT=" + name + "\n");
    return input_error_of([&] { read_mesh(path); });
  };
  for (const std::string name : {"../secret.inp", "link.inp", "/etc/passwd"})
    EXPECT_THAT(error(name), HasSubstr("a.inp:2: the included file '" + name +
                                       "' is not in the folder of the mesh file"));
  EXPECT_THAT(error("none.inp"), HasSubstr("does not exist"));
  EXPECT_THAT(error("."), HasSubstr("is not a file"));
  EXPECT_THAT(error(""), HasSubstr("names no file"));
  EXPECT_THAT(error("loop.inp"), HasSubstr("more.inp:1: the included file 'loop.inp' includes"));
  EXPECT_THAT(error("a.inp"), HasSubstr("includes itself"));
  EXPECT_THAT(error("bad.inp"), HasSubstr("bad.inp:2: a coordinate is 'x'"));
}

TEST_F(AbaqusFiles, FacetsKeepTheNumbersOfAnotherFormat) {
  const auto path =
      file_with("a.msh",
                "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n"
                "$EndNodes\n$Elements\n3\n4 1 2 3 1 1 2\n2 1 2 3 1 2 3\n9 2 2 5 1 1 2 3\n"
                "$EndElements\n");
  write_mesh(file("b.inp"), read_mesh(path).mesh);
  const std::string content = content_of(file("b.inp"));
  EXPECT_THAT(content, HasSubstr("\n4, 1, 2\n"));
  EXPECT_THAT(content, HasSubstr("\n2, 2, 3\n"));
  EXPECT_THAT(content, HasSubstr("\n9, 1, 2, 3\n"));
}

TEST_F(AbaqusFiles, FacetsFollowCellsWithoutNumbers) {
  const PlanarMesh grid = test::grid_mesh(1, test::GridCells::triangles);
  FileContent content;
  content.facet_ids = {1};
  MeshLabels labels;
  labels.facets.append(std::vector<NodeIndex>{0, 1});
  labels.facet_tags = {7};
  labels.content = std::make_shared<const FileContent>(std::move(content));
  const PlanarMesh mesh(std::make_shared<const Topology>(2, grid.n_nodes(), grid.topology().cells(),
                                                         std::nullopt, std::move(labels)),
                        grid.copied_coordinates());
  write_mesh(file("a.inp"), mesh);
  EXPECT_THAT(content_of(file("a.inp")), HasSubstr("\n3, 1, 2\n"));
}

TEST_F(AbaqusFiles, AllSetsOfAnElementComeOut) {
  const auto path =
      file_with("a.inp", "*NODE\n" + two_nodes + more_nodes + "*ELEMENT, TYPE=CPS4, ELSET=EALL\n" +
                             two_squares + "*ELSET, ELSET=steel\n1\n*ELSET, ELSET=glue\n2\n" +
                             "*ELSET, ELSET=both\nsteel, glue\n*ELSET, ELSET=_S1, INTERNAL\n1\n");
  const MeshFile read = read_mesh(path);
  EXPECT_THAT(groups(read, 0), ElementsAre("EALL", "steel", "both"));
  EXPECT_THAT(groups(read, 1), ElementsAre("EALL", "glue", "both"));
  EXPECT_THAT(cell_materials(topology(read)), ElementsAre(0, 1));
  EXPECT_THAT(losses(file("b.vtu"), read.mesh), ElementsAre(HasSubstr("(both, glue, steel)")));
  for (const std::string name : {"b.msh", "c.inp"}) {
    SCOPED_TRACE(name);
    write_mesh(file(name), read_mesh(file(name == "c.inp" ? "b.msh" : "a.inp")).mesh);
    const MeshFile again = read_mesh(file(name));
    for (const CellIndex c : {0, 1})
      EXPECT_THAT(groups(again, c), ::testing::UnorderedElementsAreArray(groups(read, c)));
  }
}

TEST_F(AbaqusFiles, ManySetsOfManyElementsTakeBoundedMemory) {
  std::string text = "*NODE\n", elements = "*ELEMENT, TYPE=S4\n";
  constexpr int n = 3000;
  for (int i = 1; i <= n; ++i) {
    const std::string label = std::to_string(i), other = std::to_string(i + n);
    text += label + "," + label + ",0\n" + other + "," + label + ",1\n";
    if (i < n)
      elements += label + "," + label + "," + std::to_string(i + 1) + "," +
                  std::to_string(i + n + 1) + "," + other + "\n";
  }
  text += elements;
  for (int i = 1; i < n; ++i) {
    text += "*ELSET, ELSET=s" + std::to_string(i) + ", GENERATE\n1,";
    text += std::to_string(n) + "\n";
  }
  const MeshFile read = read_mesh(file_with("a.inp", text));
  EXPECT_THAT(read.notes, ElementsAre(HasSubstr("too many sets of elements")));
}

}  // namespace
}  // namespace smoothfem
