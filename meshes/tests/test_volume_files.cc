#include "meshes/tests/mesh_tests.h"
#include "smoothing/mesh/cell_size.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using test::BoxCells;

VolumeMesh read_volume(const std::filesystem::path& path) {
  return std::get<VolumeMesh>(read_mesh(path).mesh);
}

/// A box with everything that labels can hold, and coordinates that need all digits.
VolumeMesh labelled_box(BoxCells kind) {
  VolumeMesh mesh = test::box_mesh(2, 2, 4, kind);
  for (auto& point : mesh.coordinates())
    point = Point<3>(point.x() / 3.0 + 1e-17, point.y() / 7.0, point.z() * 1.1 - 1e-300);
  const Topology& topology = mesh.topology();
  MeshLabels labels;
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    labels.cell_tags.push_back(c % 3 == 0 ? 12 : 4);
    labels.cell_ids.push_back(10 * c + 7);
  }
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i) labels.node_ids.push_back(3 * i + 2);
  const auto& boundary = topology.boundary_facets();
  for (const int tag : {5, 2})
    for (std::size_t f = 0; f < boundary.size(); f += static_cast<std::size_t>(tag)) {
      labels.facets.append(boundary[f]);
      labels.facet_tags.push_back(tag);
    }
  labels.names = {{{3, 12}, "steel"}, {{3, 4}, "air gap"}, {{2, 5}, "inlet"}, {{2, 2}, "wall"}};
  std::vector<bool> fixed = topology.on_boundary();
  fixed[topology.free_nodes().front()] = true;
  return {std::make_shared<const Topology>(3, mesh.n_nodes(), topology.cells(), fixed, labels),
          mesh.coordinates()};
}

/// (nodes, tag) of cells or facets, in an order that does not depend on the file.
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

const char* const kind_names[] = {"tetrahedra", "pyramids", "prisms", "hexahedra", "mixed"};

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
  EXPECT_EQ(read.coordinates(), mesh.coordinates());
  if (format().name != "gmsh") {  // the only one that keeps no fixed nodes
    EXPECT_EQ(read.topology().free_nodes(), mesh.topology().free_nodes());
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
  EXPECT_EQ(read.coordinates(), mesh.coordinates());
  EXPECT_EQ(sorted_rows(read.topology().cells(), {}), sorted_rows(mesh.topology().cells(), {}));
  EXPECT_EQ(read.topology().free_nodes(), mesh.topology().free_nodes());
  EXPECT_EQ(read.topology().labels(), MeshLabels());
}

INSTANTIATE_TEST_SUITE_P(
    Volumes, VolumeFormats,
    ::testing::Combine(::testing::ValuesIn(volume_formats()),
                       ::testing::Values(BoxCells::tetrahedra, BoxCells::pyramids, BoxCells::prisms,
                                         BoxCells::hexahedra, BoxCells::mixed)),
    [](const auto& info) {
      return std::get<0>(info.param).name + "_" +
             kind_names[static_cast<int>(std::get<1>(info.param))];
    });

}  // namespace
}  // namespace smoothfem
