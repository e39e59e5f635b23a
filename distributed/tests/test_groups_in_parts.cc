// SPDX-License-Identifier: GPL-3.0-or-later
// An element may be in several physical groups. Parts must see all of them, as the whole mesh does.
#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include "distributed/files/pieces.h"
#include "distributed/files/split.h"
#include "distributed/tests/folder.h"
#include "distributed/tests/smooth_pieces.h"
#include "fem/tests/all_ranks.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/mesh_file.h"
#include "meshes/tools/gmsh_session.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using test::all_ranks;
using test::Folder;
using test::grid_mesh;
using test::GridCells;
using testing::HasSubstr;

constexpr const char* method_name = "smart-laplace";
constexpr NodeIndex middle_of_square = 12, middle_of_cube = 13;

/// A mesh of 4 x 4 or 2 x 2 x 2 cells, at least one for each of seven processes, whose middle node
/// is off its place.
template <int dim>
Mesh<dim> small_mesh(MeshLabels labels, FileContent content) {
  Mesh<dim> mesh = [] {
    if constexpr (dim == 2)
      return grid_mesh(4, GridCells::quadrilaterals);
    else
      return test::box_mesh(2, 2, 2, test::BoxCells::hexahedra);
  }();
  auto points = mesh.copied_coordinates();
  points[dim == 2 ? middle_of_square : middle_of_cube][0] += 0.1;
  content.format = "gmsh";
  content.version = "4.1";
  labels.content = std::make_shared<const FileContent>(std::move(content));
  return {std::make_shared<const Topology>(dim, mesh.n_nodes(), mesh.topology().cells(),
                                           std::nullopt, std::move(labels)),
          std::move(points)};
}

/// Two halves of a square, which are entities with these groups.
PlanarMesh two_halves(const std::vector<int>& left, const std::vector<int>& right) {
  MeshLabels labels;
  FileContent content;
  for (const int side : {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1}) {
    content.cell_entities.push_back(1 + side);
    labels.cell_tags.push_back(side == 0 ? left.front() : right.front());
  }
  content.entities[{2, 1}].groups = left;
  content.entities[{2, 2}].groups = right;
  return small_mesh<2>(std::move(labels), std::move(content));
}

/// A facet inside, in two groups.
template <int dim>
Mesh<dim> with_inner_facet(const std::vector<NodeIndex>& facet) {
  MeshLabels labels;
  FileContent content;
  labels.facets.append(facet);
  labels.facet_tags = {5};
  content.facet_entities = {1};
  content.entities[{dim - 1, 1}].groups = {5, 6};
  return small_mesh<dim>(std::move(labels), std::move(content));
}

/// An edge or a point inside, in two groups.
VolumeMesh with_inner_element(const std::vector<NodeIndex>& nodes) {
  const auto dimension = static_cast<int>(nodes.size()) - 1;
  FileContent content;
  OtherElements& elements = content.others[static_cast<std::size_t>(dimension)];
  elements.nodes.append(nodes);
  elements.tags = {5};
  elements.entities = {1};
  content.entities[{dimension, 1}].groups = {5, 6};
  return small_mesh<3>({}, std::move(content));
}

template <int dim>
Mesh<dim> read(const std::filesystem::path& path) {
  return std::get<Mesh<dim>>(read_mesh(path, {.turns_over = false}).mesh);
}

/// Smooths the whole mesh and its parts, from files of all kinds that hold several groups.
template <int dim>
void expect_same_in_parts(const Mesh<dim>& mesh, bool moves) {
  const Folder folder;
  all_ranks().on_root([&] {
    write_mesh(folder / "text.msh", mesh, {}, {.binary = false});
    write_mesh(folder / "blocks.msh", mesh, {}, {.binary = true});
    write_mesh(folder / "sets.inp", mesh);
    write_in_pieces(read<dim>(folder / "text.msh"), 3, folder / "pieces.pvtu");
  });
  const auto middle = static_cast<NodeIndex>(mesh.n_nodes() / 2);
  for (const char* name : {"text.msh", "blocks.msh", "sets.inp"}) {
    const auto in = folder / name, out = folder / (std::string("out_") + name);
    auto whole = read<dim>(in);
    auto method = make_method<dim>(method_name);
    smooth(whole, method);
    if (in.extension() == ".msh") {  // Abaqus has no edges and points of groups
      EXPECT_EQ(whole.coordinates()[middle] != mesh.coordinates()[middle], moves) << name;
    }
    test::smooth_pieces<dim>(all_ranks(), Pieces(all_ranks(), in), out, method_name);
    all_ranks().on_root([&] {
      EXPECT_EQ(read<dim>(out).copied_coordinates(), whole.copied_coordinates()) << name;
    });
  }
  if (moves) return;
  // Pieces of VTK hold one group only. The nodes between the sets of groups are marked.
  const auto part = test::smooth_pieces<dim>(
      all_ranks(), Pieces(all_ranks(), folder / "pieces.pvtu"), folder / "out.pvtu", method_name);
  const auto nodes = part.topology().part()->nodes();
  for (NodeIndex i = 0; i < part.n_nodes(); ++i)
    if (nodes[i] == middle) {
      EXPECT_EQ(part.coordinates()[i], mesh.coordinates()[middle]);
    }
}

TEST(GroupsInParts, InterfacesBetweenOverlappingGroupsStay) {
  expect_same_in_parts(two_halves({3}, {3, 4}), false);
  expect_same_in_parts(two_halves({3, 4}, {3, 5}), false);
  expect_same_in_parts(two_halves({3, 4}, {4, 3}), true);
  expect_same_in_parts(two_halves({3}, {3}), true);
}

TEST(GroupsInParts, InnerElementsOfSeveralGroupsStay) {
  expect_same_in_parts(with_inner_facet<2>({7, middle_of_square}), false);
  expect_same_in_parts(with_inner_facet<3>({4, 5, 14, middle_of_cube}), false);
  expect_same_in_parts(with_inner_element({4, middle_of_cube}), false);
  expect_same_in_parts(with_inner_element({middle_of_cube}), false);
  expect_same_in_parts(with_inner_element({3, 4}), true);
}

/// Each file has entities of its own.
TEST(GroupsInParts, FilesOfGmshsPartitionsHaveAllGroups) {
  for (const bool is_binary : {false, true})
    for (const auto& [right, moves] : {std::pair{std::vector{3, 4}, false}, {{3}, true}}) {
      const Folder folder;
      const auto mesh = two_halves({3}, right);
      all_ranks().on_root([&] {
        write_mesh(folder / "whole.msh", mesh);
        GmshSession session;
        session.set_option("Mesh.Binary", is_binary);
        session.set_option("Mesh.PartitionSplitMeshFiles", 1);
        session.run("parts", [&] {
          gmsh::merge((folder / "whole.msh").string());
          gmsh::model::mesh::partition(2);
          gmsh::write((folder / "parts.msh").string());
        });
      });
      const auto part =
          test::smooth_pieces<2>(all_ranks(), Pieces(all_ranks(), folder / "parts_1.msh"),
                                 folder / "out.msh", method_name);
      const auto nodes = part.topology().part()->nodes();
      for (NodeIndex i = 0; i < part.n_nodes(); ++i)
        if (nodes[i] == middle_of_square + 1) {  // tags count from 1
          EXPECT_EQ(part.coordinates()[i] != mesh.coordinates()[middle_of_square], moves);
        }
    }
}

}  // namespace
}  // namespace smoothfem
