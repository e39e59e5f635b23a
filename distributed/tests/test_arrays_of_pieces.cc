// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces that lack an array of others make another result, and pieces without cells are left out.
// The program must say both.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "distributed/files/refine.h"
#include "distributed/files/split.h"
#include "distributed/tests/example_meshes.h"
#include "distributed/tests/folder.h"
#include "distributed/tests/smooth_pieces.h"
#include "fem/tests/all_ranks.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;
using test::all_ranks;
using test::content_of;
using test::Folder;
using test::grid_mesh;
using test::GridCells;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

/// Gives an array of a piece a name that says nothing.
void hide(const fs::path& list, std::size_t piece, const std::string& name) {
  all_ranks().on_root([&] {
    std::string text = content_of(piece_file(list, piece));
    const std::string wanted = "Name=\"" + name + "\"";
    const std::size_t at = text.find(wanted);
    ASSERT_NE(at, std::string::npos) << name;
    std::ofstream(piece_file(list, piece), std::ios::binary)
        << text.replace(at, wanted.size(), "Name=\"other\"");
  });
}

/// Returns the notes of smoothing, examining and refining, on the root.
std::vector<std::vector<std::string>> all_notes(const fs::path& list) {
  const Pieces smoothed(all_ranks(), list), examined(all_ranks(), list);
  (void)smoothed.read();
  (void)examined.read(ReadFor::examination);
  return {smoothed.notes(), examined.notes(),
          refine_pieces(all_ranks(), list, list.parent_path() / "finer.pvtu").notes};
}

TEST(ArraysOfPieces, APieceWithoutOneIsNamed) {
  for (const std::string name : {"physical_tag", "GlobalNodeId", "GlobalCellId", "fixed"}) {
    const Folder folder;
    const fs::path list = folder / "split.pvtu";
    all_ranks().on_root([&] {
      write_in_pieces(test::two_materials(grid_mesh(4, GridCells::triangles), 0.2, 3), 3, list);
    });
    hide(list, 1, name);
    const auto one = all_notes(list);
    hide(list, 2, name);
    const auto two = all_notes(list);
    if (!all_ranks().is_root()) continue;
    for (const auto& notes : one)
      EXPECT_THAT(notes, ElementsAre(HasSubstr("split_0001.vtu has no array '" + name +
                                               "', but split_0000.vtu has: ")));
    for (const auto& notes : two)
      EXPECT_THAT(notes, ElementsAre(HasSubstr("split_0001.vtu and another piece have no array '" +
                                               name + "', but split_0000.vtu has: ")));
  }
}

/// One labelled facet, so that two of three pieces have no element with a tag.
TEST(ArraysOfPieces, AreTheSameInPiecesOfThisProgram) {
  const Folder folder;
  const auto mesh = grid_mesh(4, GridCells::triangles);
  MeshLabels labels;
  labels.facets.append(mesh.topology().boundary_facets()[0]);
  labels.facet_tags = {7};
  const PlanarMesh labelled(
      std::make_shared<const Topology>(2, mesh.n_nodes(), mesh.topology().cells(), std::nullopt,
                                       std::move(labels)),
      mesh.copied_coordinates());
  const fs::path list = folder / "split.pvtu", out = folder / "smoothed.pvtu";
  all_ranks().on_root([&] { write_in_pieces(labelled, 3, list); });
  test::smooth_pieces<2>(all_ranks(), Pieces(all_ranks(), list), out);
  for (const fs::path& path : {list, out})
    for (const auto& notes : all_notes(path)) EXPECT_THAT(notes, IsEmpty()) << path;
  const Pieces finer(all_ranks(), folder / "finer.pvtu");
  (void)finer.read();
  EXPECT_THAT(finer.notes(), IsEmpty());
  for (std::size_t p = 0; p < 3; ++p)
    EXPECT_THAT(content_of(piece_file(out, p)), HasSubstr("physical_tag"));
}

/// Lists a piece without cells before the others, as programs write it for a process without
/// cells.
void add_empty_piece(const fs::path& list, const std::string& name) {
  all_ranks().on_root([&] {
    std::ofstream(list.parent_path() / name)
        << "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">"
           "<UnstructuredGrid><Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"><Points/><Cells/>"
           "</Piece></UnstructuredGrid></VTKFile>";
    std::string text = content_of(list);
    const std::size_t at = text.find("<Piece ");
    ASSERT_NE(at, std::string::npos);
    std::ofstream(list, std::ios::binary)
        << text.insert(at, "<Piece Source=\"" + name + "\"/>\n    ");
  });
}

TEST(EmptyPieces, AreLeftOutAndNamed) {
  const Folder folder;
  const fs::path list = folder / "split.pvtu", out = folder / "smoothed.pvtu";
  all_ranks().on_root([&] {
    write_in_pieces(test::two_materials(grid_mesh(4, GridCells::triangles), 0.2, 3), 3, list);
  });
  const auto expected = test::smooth_pieces<2>(all_ranks(), Pieces(all_ranks(), list), out);
  add_empty_piece(list, "empty.vtu");
  const Pieces pieces(all_ranks(), list);
  EXPECT_THAT(pieces.notes(),
              ElementsAre("empty.vtu has no cells; the mesh is read from the other pieces"));
  const auto smoothed = test::smooth_pieces<2>(all_ranks(), pieces, out);
  EXPECT_EQ(smoothed.copied_coordinates(), expected.copied_coordinates());
  add_empty_piece(list, "other.vtu");
  for (const auto& notes : all_notes(list))
    EXPECT_THAT(notes, ElementsAre("other.vtu and another piece have no cells; the mesh is read "
                                   "from the other pieces"));
}

TEST(EmptyPieces, OneMustHaveCells) {
  const Folder folder;
  const fs::path list = folder / "split.pvtu";
  all_ranks().on_root([&] {
    std::ofstream(list) << "<VTKFile><PUnstructuredGrid><Piece /></PUnstructuredGrid></VTKFile>";
  });
  add_empty_piece(list, "empty.vtu");
  all_ranks().on_root([&] {
    std::string text = content_of(list);
    std::ofstream(list) << text.erase(text.find("<Piece />"), 9);
  });
  EXPECT_THAT([&] { (void)Pieces(all_ranks(), list); },
              ThrowsMessage<InputError>(HasSubstr("split.pvtu: its pieces have no cells")));
}

}  // namespace
}  // namespace smoothfem
