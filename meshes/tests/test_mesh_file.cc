// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/mesh_file.h"

#include "meshes/tests/mesh_tests.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;
using MeshFiles = FileTest;

TEST_F(MeshFiles, ReportsPathsThatCannotBeRead) {
  const std::string missing = file("missing.vtu").string();
  EXPECT_EQ(input_error_of([&] { read_planar(missing); }),
            missing + ": there is no such file; check the path");
  std::filesystem::create_directory(file("folder.msh"));
  EXPECT_THAT(input_error_of([&] { read_planar(file("folder.msh")); }), HasSubstr("is a folder"));
  std::filesystem::create_symlink("/dev/zero", file("endless.vtk"));
  EXPECT_THAT(input_error_of([&] { read_planar(file("endless.vtk")); }), HasSubstr("is a device"));
  EXPECT_THAT(
      input_error_of([&] { read_planar(file_with("a.step", "solid")); }),
      HasSubstr("the extension .step is not known; choose one of .inp, .msh, .mesh, .pvtu, .vtk, "
                ".vtu"));
  EXPECT_THAT(input_error_of([&] { read_planar(file("mesh")); }), HasSubstr("has no extension"));
}

std::vector<MeshFormat> planar_formats() {
  std::vector<MeshFormat> formats = mesh_formats();
  std::erase_if(formats, [](const MeshFormat& format) { return !format.holds_planar_meshes; });
  return formats;
}

class EveryFormat : public FileTest, public ::testing::WithParamInterface<MeshFormat> {
 protected:
  std::filesystem::path target(const std::string& stem) const {
    return file(stem + GetParam().extension);
  }
};

TEST_P(EveryFormat, RefusesEmptyBlankAndRandomFiles) {
  EXPECT_THAT(input_error_of([&] { read_planar(file_with(target("a").filename(), "")); }),
              HasSubstr("the file is empty"));
  for (const std::string content : {"\n\n\n", "junk", "\xff\xfe\x01\x02\n\n"})
    EXPECT_THAT(input_error_of([&] { read_planar(file_with(target("b").filename(), content)); }),
                ::testing::StartsWith(target("b").string() + ":"));
}

TEST_P(EveryFormat, RoundTripKeepsCoordinatesCellsAndFixedNodes) {
  std::vector<bool> fixed(10, true);
  fixed[0] = fixed[4] = false;
  const bool holds_all = GetParam().holds_polygons && GetParam().holds_fixed_nodes;
  const PlanarMesh mesh = holds_all ? mixed_mesh(true, {}, fixed) : mixed_mesh(false);
  write_mesh(target("deeper/folder/a"), mesh);
  expect_same_mesh(read_planar(target("deeper/folder/a")).mesh, mesh);
}

TEST_P(EveryFormat, RoundTripKeepsLabels) {
  if (!GetParam().holds_physical_names) return;
  MeshLabels labels;
  labels.cell_tags = {7, 7, 3, 3, 7, 3};
  labels.facets.append(std::vector<NodeIndex>{1, 2});
  labels.facets.append(std::vector<NodeIndex>{0, 1});
  labels.facet_tags = {5, 4};
  labels.names = {{{2, 7}, "steel, 2 = hard"}, {{2, 3}, "air gap"}, {{1, 5}, "inlet"}};
  labels.node_ids = {4, 5, 6, 8, 9, 10, 11, 12, 13, 1000000};
  labels.cell_ids = {2, 3, 4, 7, 8, 9};
  write_mesh(target("a"), mixed_mesh(false, labels));
  EXPECT_EQ(read_planar(target("a")).mesh.topology().labels(), labels);
}

TEST_P(EveryFormat, KeepsOrRefusesPolygons) {
  const std::string message = input_error_of([&] { write_mesh(target("a"), mixed_mesh(true)); });
  // Medit shares its extension with a format that holds polygons, which is taken then.
  if (GetParam().holds_polygons || GetParam().name == "medit")
    EXPECT_EQ(message, "");
  else
    EXPECT_THAT(message, HasSubstr("cell 3 has 5 nodes, and " + GetParam().extension +
                                   " files hold only triangles and quadrilaterals; use one of "
                                   ".mesh, .vtk, .vtu"));
}

TEST_P(EveryFormat, ReportsTargetsThatCannotBeWritten) {
  const auto path = std::filesystem::path("/dev/null") / target("a").filename();
  EXPECT_THAT(input_error_of([&] { write_mesh(path, mixed_mesh(false)); }),
              HasSubstr("cannot write " + path.string()));
}

TEST_P(EveryFormat, ReportsAFullDiskAndKeepsTheOldFile) {
  const auto path = file_with(target("a").filename(), "old");
  const PlanarMesh mesh = mixed_mesh(false);  // clang's OpenMP creates a file at its start
  const std::string message = [&] {
    const FullDisk disk(200);
    return input_error_of([&] { write_mesh(path, mesh); });
  }();
  EXPECT_THAT(message, ::testing::StartsWith("cannot write " + path.string() + ": "));
  EXPECT_EQ(content_of(path), "old");
  EXPECT_EQ(n_entries(), 1u);
}

TEST_P(EveryFormat, FieldsMustFitTheMesh) {
  MeshFields fields;
  fields.cell["quality"] = {1.0, 2.0};
  EXPECT_THAT(input_error_of([&] { write_mesh(target("a"), mixed_mesh(false), fields); }),
              HasSubstr("the cell field 'quality' has 2 values, but the mesh needs 6"));
  fields = {};
  fields.point["u"] = {1.0};
  EXPECT_THAT(input_error_of([&] { write_mesh(target("a"), mixed_mesh(false), fields); }),
              HasSubstr("the point field 'u' has 1 values, but the mesh needs 10"));
}

/// The first n bytes of a file are an error or the whole mesh (if only blanks or optional parts are
/// missing). They never give an incomplete mesh, and never a crash.
TEST_P(EveryFormat, DetectsTruncatedFiles) {
  const PlanarMesh mesh = mixed_mesh(false);
  write_mesh(target("whole"), mesh);
  const std::string whole = content_of(target("whole"));
  std::size_t n_refused = 0, n_tried = 0;
  for (std::size_t n = 1; n < whole.size(); n += 1 + whole.size() / 200, ++n_tried) {
    const auto path = file_with(target("cut").filename(), whole.substr(0, n));
    try {
      const PlanarFile read = read_planar(path);
      EXPECT_EQ(read.mesh.copied_coordinates(), mesh.copied_coordinates())
          << n << " of " << whole.size();
      EXPECT_EQ(read.mesh.topology().cells(), mesh.topology().cells()) << n;
    } catch (const InputError& error) {
      ++n_refused;
      EXPECT_THAT(error.what(), ::testing::StartsWith(path.string()));
    }
  }
  EXPECT_GT(n_refused, n_tried / 2);
}

/// A changed byte gives another mesh or an InputError: no other exception, crash or endless loop.
TEST_P(EveryFormat, SurvivesDamagedFiles) {
  write_mesh(target("whole"), mixed_mesh(false));
  const std::string whole = content_of(target("whole"));
  std::size_t n_refused = 0;
  for (std::size_t n = 0; n < whole.size(); n += 1 + whole.size() / 300) {
    std::string damaged = whole;
    damaged[n] = static_cast<char>(damaged[n] ^ 0x41);
    const auto path = file_with(target("damaged").filename(), damaged);
    n_refused += !input_error_of([&] { read_planar(path); }).empty();
  }
  EXPECT_GT(n_refused, 50u);
}

INSTANTIATE_TEST_SUITE_P(MeshFiles, EveryFormat, ::testing::ValuesIn(planar_formats()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace smoothfem
