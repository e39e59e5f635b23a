// SPDX-License-Identifier: GPL-3.0-or-later
// Files into which Gmsh has split a mesh.
#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include "distributed/examine_parts.h"
#include "distributed/files/pieces.h"
#include "distributed/partition.h"
#include "distributed/tests/folder.h"
#include "distributed/tests/smooth_pieces.h"
#include "fem/tests/all_ranks.h"
#include "meshes/io/gmsh/msh_parts.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/tools/gmsh_session.h"
#include "smoothing/loop/smooth.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;
using test::all_ranks;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// How Gmsh writes a mesh in three parts.
struct Variant {
  int dim;
  bool is_binary, has_ghosts, has_topology;
};

/// A square or a box with groups of elements of two dimensions, whose tags do not begin at 1.
/// Writes whole.msh, and parts.msh in files.
void write_files(const test::Folder& folder, const Variant& variant) {
  all_ranks().on_root([&] {
    GmshSession session;
    session.set_option("Mesh.MeshSizeMax", 0.3);
    session.set_option("Mesh.Binary", variant.is_binary);
    session.set_option("Mesh.PartitionCreateGhostCells", variant.has_ghosts);
    session.set_option("Mesh.PartitionCreateTopology", variant.has_topology);
    session.set_option("Mesh.PartitionSplitMeshFiles", 1);
    session.run("model", [&] {
      namespace occ = gmsh::model::occ;
      if (variant.dim == 3)
        occ::addBox(0, 0, 0, 1, 1, 1);
      else
        occ::addRectangle(0, 0, 0, 1, 1);
      occ::synchronize();
      gmsh::model::addPhysicalGroup(variant.dim, {1}, 7);
      gmsh::model::addPhysicalGroup(variant.dim - 1, {1}, 8);
      gmsh::model::mesh::generate(variant.dim);
      gmsh::write((folder / "whole.msh").string());
      gmsh::model::mesh::partition(3);
      gmsh::write((folder / "parts.msh").string());
    });
  });
}

template <int dim>
std::size_t smoothed(const fs::path& in, const fs::path& out) {
  const auto part = test::smooth_pieces<dim>(all_ranks(), Pieces(all_ranks(), in), out);
  return part.topology().part()->n_cells_of_whole();
}

std::map<std::size_t, Point<3>> nodes_by_tag(const fs::path& path) {
  const MeshParts parts = read_mesh_parts(path);
  std::map<std::size_t, Point<3>> nodes;
  for (std::size_t i = 0; i < parts.coordinates.size(); ++i)
    nodes[parts.node_ids[i]] = parts.coordinates[i];
  return nodes;
}

TEST(GmshParts, AreTheWholeMesh) {
  const test::Folder folder;
  for (const Variant& variant : {Variant{3, false, false, true}, Variant{3, true, true, true},
                                 Variant{3, false, true, false}, Variant{2, true, true, true},
                                 Variant{2, false, false, false}}) {
    write_files(folder, variant);
    const auto smooth_both = [&]<int dim>() {
      const std::size_t n = smoothed<dim>(folder / "whole.msh", folder / "whole_out.msh");
      EXPECT_EQ(smoothed<dim>(folder / "parts_2.msh", folder / "out.msh"), n);
    };
    variant.dim == 3 ? smooth_both.template operator()<3>() : smooth_both.template operator()<2>();
    all_ranks().on_root([&] {
      const auto before = nodes_by_tag(folder / "whole.msh"),
                 whole = nodes_by_tag(folder / "whole_out.msh");
      EXPECT_NE(whole, before);
      std::size_t n = 0;
      for (int k = 1; k <= 3; ++k) {  // also nodes of ghost elements
        const auto name = std::to_string(k) + ".msh";
        for (const auto& [tag, point] : nodes_by_tag(folder / ("out_" + name))) {
          EXPECT_EQ(point, whole.at(tag));
          ++n;
        }
        const MeshParts in = read_mesh_parts(folder / ("parts_" + name)),
                        out = read_mesh_parts(folder / ("out_" + name));
        const auto dim = static_cast<std::size_t>(variant.dim);
        EXPECT_EQ(out.elements[dim].ids, in.elements[dim].ids);
        EXPECT_EQ(out.notes, in.notes);
      }
      EXPECT_GT(n, whole.size());
      if (variant.has_ghosts) return;  // Gmsh 4.8 crashes when it frees copies that it has read
      const GmshSession session;
      session.run("model", [&] { EXPECT_NO_THROW(gmsh::merge((folder / "out_2.msh").string())); });
    });
  }
}

TEST(GmshParts, AreExaminedAsOneMesh) {
  const test::Folder folder;
  write_files(folder, {3, true, true, true});
  auto read = Pieces(all_ranks(), folder / "parts_1.msh").read(ReadFor::examination);
  const auto seen = examine_parts(all_ranks(), std::move(std::get<ScatteredMesh<3>>(read)));
  EXPECT_TRUE(seen.findings.empty());
  if (!all_ranks().is_root()) return;
  const auto expected = examine(read_mesh_parts(folder / "whole.msh"));
  EXPECT_EQ(seen.n_nodes, expected.n_nodes);
  EXPECT_EQ(seen.n_cells, expected.n_cells);
  EXPECT_EQ(seen.n_pieces, 1u);
}

TEST(GmshParts, AllFilesMustBeThere) {
  const test::Folder folder;
  write_files(folder, {2, true, false, true});
  const auto error_with = [&](const char* name) {
    (void)all_ranks().any(false);
    try {
      const Pieces pieces(all_ranks(), folder / name);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto expect_on_root = [&](const std::string& error, const std::string& text) {
    EXPECT_FALSE(error.empty());
    if (all_ranks().is_root()) {
      EXPECT_THAT(error, HasSubstr(text));
    }
  };
  const Pieces pieces(all_ranks(), folder / "parts_3.msh");
  if (all_ranks().is_root()) {
    EXPECT_THAT(pieces.notes(),
                testing::ElementsAre(HasSubstr("files parts_1.msh to parts_3.msh")));
  }
  EXPECT_EQ(pieces.default_output(), folder / "parts_smoothed.msh");
  EXPECT_EQ(msh_part_file("a/b.msh", 12), "a/b_12.msh");
  EXPECT_EQ(msh_part_file("a/b_1.msh", 12), "a/b_12.msh");
  EXPECT_THAT([&] { pieces.require_output(folder / "parts.msh"); },
              ThrowsMessage<InputError>(HasSubstr("would replace")));
  EXPECT_THAT([&] { pieces.require_output(folder / "parts.vtu"); },
              ThrowsMessage<InputError>(HasSubstr("give a name that ends with .msh")));
  all_ranks().on_root([&] { fs::copy(folder / "parts_1.msh", folder / "first.msh"); });
  expect_on_root(error_with("first.msh"), "its name does not end with _1.msh");
  all_ranks().on_root([&] {
    fs::copy(folder / "parts_1.msh", folder / "parts_2.msh", fs::copy_options::overwrite_existing);
  });
  expect_on_root(error_with("parts_1.msh"), "parts_2.msh: the file does not have part 2, but");
  all_ranks().on_root([&] { fs::remove(folder / "parts_2.msh"); });
  expect_on_root(error_with("parts_1.msh"), "parts_2.msh: there is no such file, but");
}

}  // namespace
}  // namespace smoothfem
