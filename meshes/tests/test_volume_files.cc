// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tests/labelled_box.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using test::BoxCells;

/// Returns (nodes, tag) of cells or facets, in an order that does not depend on the file.
std::vector<std::pair<std::vector<NodeIndex>, int>> sorted_rows(
    const CompressedRows<NodeIndex>& rows, const std::vector<int>& tags) {
  std::vector<std::pair<std::vector<NodeIndex>, int>> result;
  for (std::size_t i = 0; i < rows.size(); ++i)
    result.push_back({{rows[i].begin(), rows[i].end()}, tags.empty() ? 0 : tags[i]});
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<MeshFormat> volume_formats() {
  std::vector<MeshFormat> formats = mesh_formats();
  std::erase_if(formats, [](const MeshFormat& format) { return !format.holds_volume_meshes; });
  return formats;
}

class VolumeFormats : public FileTest,
                      public ::testing::WithParamInterface<std::tuple<MeshFormat, BoxCells>> {
 protected:
  const MeshFormat& format() const { return std::get<0>(GetParam()); }
  std::filesystem::path target() const { return file("a" + format().extension); }
};

TEST_P(VolumeFormats, RoundTripKeepsEverything) {
  const VolumeMesh mesh = labelled_box(std::get<1>(GetParam()));
  ASSERT_NO_THROW(require_valid(mesh));
  write_mesh(target(), mesh);
  const VolumeMesh read = read_volume(target());
  EXPECT_EQ(read.copied_coordinates(), mesh.copied_coordinates());
  if (format().name != "gmsh") {  // the only format that does not keep fixed nodes
    EXPECT_EQ(nodes_free_but_for_interfaces(read.topology()), mesh.topology().free_nodes());
  }
  const MeshLabels &found = read.topology().labels(), &expected = mesh.topology().labels();
  EXPECT_EQ(sorted_rows(read.topology().cells(), found.cell_tags),
            sorted_rows(mesh.topology().cells(), expected.cell_tags));
  EXPECT_EQ(sorted_rows(found.facets, found.facet_tags),
            sorted_rows(expected.facets, expected.facet_tags));
  if (format().holds_physical_names) {
    EXPECT_EQ(found.names, expected.names);
  }
  if (format().holds_numbers) {
    EXPECT_EQ(read.topology().cells(), mesh.topology().cells());
    EXPECT_EQ(found.cell_ids, expected.cell_ids);
    EXPECT_EQ(found.node_ids, expected.node_ids);
  }
}

TEST_P(VolumeFormats, RoundTripWithoutLabels) {
  const VolumeMesh mesh = test::box_mesh(2, 1, 4, std::get<1>(GetParam()));
  write_mesh(target(), mesh);
  const VolumeMesh read = read_volume(target());
  EXPECT_EQ(read.copied_coordinates(), mesh.copied_coordinates());
  EXPECT_EQ(sorted_rows(read.topology().cells(), {}), sorted_rows(mesh.topology().cells(), {}));
  EXPECT_EQ(nodes_free_but_for_interfaces(read.topology()), mesh.topology().free_nodes());
  EXPECT_EQ(read.topology().labels(), MeshLabels());
}

INSTANTIATE_TEST_SUITE_P(
    Volumes, VolumeFormats,
    ::testing::Combine(::testing::ValuesIn(volume_formats()),
                       ::testing::Values(BoxCells::tetrahedra, BoxCells::pyramids, BoxCells::prisms,
                                         BoxCells::hexahedra, BoxCells::mixed)),
    [](const auto& info) {
      return std::get<0>(info.param).name + "_" + name_of(std::get<1>(info.param));
    });

class DamagedVolumes : public FileTest, public ::testing::WithParamInterface<MeshFormat> {
 protected:
  /// Calls look(n, path) for files made from the bytes of a complete one.
  template <class Damage, class Look>
  void for_damaged_files(const VolumeMesh& mesh, const Damage& damage, const Look& look) {
    const std::string extension = GetParam().extension;
    write_mesh(file("whole" + extension), mesh);
    const std::string whole = content_of(file("whole" + extension));
    for (std::size_t n = 1; n < whole.size(); n += 1 + whole.size() / 300)
      look(file_with("damaged" + extension, damage(whole, n)));
  }
};

TEST_P(DamagedVolumes, DetectsTruncatedFiles) {
  const VolumeMesh mesh = labelled_box(BoxCells::prisms);
  for_damaged_files(
      mesh, [](const std::string& whole, std::size_t n) { return whole.substr(0, n); },
      [&](const std::filesystem::path& path) {
        try {
          const VolumeMesh read = read_volume(path);
          EXPECT_EQ(read.copied_coordinates(), mesh.copied_coordinates());
          EXPECT_EQ(read.topology().cells(), mesh.topology().cells());
          EXPECT_EQ(read.topology().labels().facets.size(), mesh.topology().labels().facets.size());
        } catch (const InputError& error) {
          EXPECT_THAT(error.what(), ::testing::StartsWith(path.string()));
        }
      });
}

/// Checks properties of every mesh, also of one that a damaged file happens to give.
template <int dim, int spacedim>
void expect_sound(const Mesh<dim, spacedim>& mesh) {
  const Topology& topology = mesh.topology();
  const MeshLabels& labels = topology.labels();
  const std::size_t n_nodes = mesh.n_nodes(), n_cells = mesh.n_cells();
  EXPECT_EQ(mesh.copied_coordinates().size(), n_nodes);
  for (const auto& point : mesh.coordinates()) EXPECT_TRUE(point.allFinite());
  EXPECT_GT(n_cells, 0u);
  for (const auto* rows : {&topology.cells(), &labels.facets})
    for (const NodeIndex node : rows->entries()) EXPECT_LT(node, n_nodes);
  EXPECT_EQ(labels.facet_tags.size(), labels.facets.size());
  EXPECT_THAT(labels.cell_tags.size(), ::testing::AnyOf(0u, n_cells));
  EXPECT_THAT(labels.cell_ids.size(), ::testing::AnyOf(0u, n_cells));
  EXPECT_THAT(labels.node_ids.size(), ::testing::AnyOf(0u, n_nodes));
}

/// A changed byte gives an InputError that names the file, or another mesh; both happen. One kind
/// of change turns digits into letters, the other one into other digits.
TEST_P(DamagedVolumes, ChangedBytesAreRefusedOrGiveAConsistentMesh) {
  std::size_t n_refused = 0, n_read = 0;
  for (const char change : {0x41, 0x01})
    for_damaged_files(
        labelled_box(BoxCells::mixed),
        [&](std::string whole, std::size_t n) {
          whole[n] = static_cast<char>(whole[n] ^ change);
          return whole;
        },
        [&](const std::filesystem::path& path) {
          const std::string error = input_error_of([&] {
            const MeshFile file = read_mesh(path);
            std::visit([](const auto& mesh) { expect_sound(mesh); }, file.mesh);
            ++n_read;
          });
          if (error.empty()) return;
          ++n_refused;
          EXPECT_THAT(error, ::testing::StartsWith(path.string()));
        });
  EXPECT_GT(n_refused, 50u);
  EXPECT_GT(n_read, 50u);
}

INSTANTIATE_TEST_SUITE_P(Volumes, DamagedVolumes, ::testing::ValuesIn(volume_formats()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace smoothfem
