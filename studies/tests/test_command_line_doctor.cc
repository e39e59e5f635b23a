// SPDX-License-Identifier: GPL-3.0-or-later
/// Tests the commands `check` and `repair`, and the other commands on meshes with faults.
#include <nlohmann/json.hpp>

#include "meshes/io/mesh_view.h"
#include "smoothing/tests/volume_meshes.h"
#include "studies/tests/command_line.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;

class Doctored : public CommandLine {
 protected:
  /// Two squares of four triangles each. The edge between them has its nodes twice; one triangle
  /// runs clockwise.
  std::filesystem::path seam() const {
    return file_with("seam.vtk",
                     "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                     "POINTS 12 double\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n.4 .5 0\n1 .5 0\n"
                     "1 0 0\n2 0 0\n2 1 0\n1 1 0\n1.6 .5 0\n1 .5 0\nCELLS 10 40\n"
                     "3 0 1 4\n3 1 5 4\n3 5 2 4\n3 2 3 4\n3 4 3 0\n"
                     "3 6 7 10\n3 7 8 10\n3 10 8 9\n3 9 10 11\n3 6 10 11\n"
                     "CELL_TYPES 10\n5\n5\n5\n5\n5\n5\n5\n5\n5\n5\n");
  }
};

TEST_F(Doctored, CheckFindsWhatRepairRepairs) {
  seam();
  const Outcome found = smoothfem({"check", "seam.vtk"});
  EXPECT_EQ(found.exit_code, 1);
  EXPECT_THAT(found.out, HasSubstr("planar mesh, 12 nodes, 10 cells, 2 pieces"));
  EXPECT_THAT(found.out, HasSubstr("\n- 1 cell lists its nodes in the wrong direction"));
  EXPECT_THAT(found.out, HasSubstr("\n- 3 coincident nodes lie where another node lies"));
  EXPECT_EQ(found.err, "");
  const Outcome as_json = smoothfem({"check", "seam.vtk", "--json"});
  EXPECT_EQ(as_json.exit_code, 1);
  const auto json = nlohmann::json::parse(as_json.out);
  ASSERT_EQ(json.at("findings").size(), 2u);
  EXPECT_EQ(json["findings"][0].at("kind"), "reversed-cells");
  EXPECT_EQ(json["findings"][0].at("cell"), 8);
  EXPECT_EQ(json["findings"][1].at("count"), 3);
  const Outcome repaired = smoothfem({"repair", "seam.vtk", "-o", "whole.vtu"});
  EXPECT_EQ(repaired.exit_code, 0) << repaired.err;
  EXPECT_THAT(repaired.out, HasSubstr("merged 3 coincident nodes"));
  EXPECT_THAT(repaired.out, HasSubstr("turned over 1 of 10 cells"));
  const Outcome again = smoothfem({"check", "whole.vtu"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.out, HasSubstr("nothing is wrong"));
  file_with("bad.vtk", "nothing");
  EXPECT_EQ(smoothfem({"check", "bad.vtk"}).exit_code, 2);
  EXPECT_EQ(smoothfem({"repair", "bad.vtk", "-o", "out.vtk"}).exit_code, 2);
}

TEST_F(Doctored, ProcessesTogetherFindWhatOneFinds) {
  seam();
  for (const std::vector<std::string>& line :
       {std::vector<std::string>{"check", "seam.vtk"}, {"check", "seam.vtk", "--json"}}) {
    const Outcome alone = smoothfem(line), together = smoothfem_on_ranks(2, line);
    EXPECT_EQ(together.exit_code, 1) << together.err;
    EXPECT_EQ(together.out, alone.out);
  }
}

TEST_F(Doctored, SmoothMergesIfAskedAndSaysWhatItChanges) {
  seam();
  const std::vector<std::string> line{"smooth", "seam.vtk", "-m", "getme", "-o", "out.vtu"};
  const Outcome apart = smoothfem(line);
  EXPECT_EQ(apart.exit_code, 0) << apart.err;
  EXPECT_THAT(apart.err, HasSubstr("smoothfem: note: seam.vtk: turned over 1 of 10 cells"));
  EXPECT_THAT(apart.err, HasSubstr("smoothfem: warning: seam.vtk: 3 coincident nodes"));
  const PlanarMesh kept = read_planar(file("out.vtu")).mesh;
  EXPECT_EQ(kept.n_nodes(), 12u);
  EXPECT_EQ(kept.coordinates()[5], Point<2>(1.0, 0.5));
  auto merging = line;
  merging.push_back("--merge");
  const Outcome merged = smoothfem(merging);
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_THAT(merged.err, HasSubstr("the mesh now has 9 nodes instead of 12"));
  EXPECT_EQ(merged.err.find("warning"), std::string::npos) << merged.err;
  const PlanarMesh whole = read_planar(file("out.vtu")).mesh;
  EXPECT_EQ(whole.n_nodes(), 9u);
  EXPECT_FALSE(whole.topology().is_fixed(5));  // the middle of the seam
}

/// A grid of n cells in each direction under a finer one; their free nodes are moved.
template <int dim>
Mesh<dim> two_levels(std::uint32_t n) {
  const auto level = [](std::uint32_t m) {
    if constexpr (dim == 2)
      return test::grid_mesh(m, test::GridCells::quadrilaterals);
    else
      return test::box_mesh(m, m, m, test::BoxCells::hexahedra);
  };
  Mesh<dim> coarse = level(n), fine = level(2 * n);
  std::vector<Point<dim>> x = coarse.copied_coordinates();
  test::Cells cells;
  const auto add = [&](const Mesh<dim>& mesh, const auto& number) {
    for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
      auto& cell = cells.emplace_back();
      for (const NodeIndex i : mesh.topology().cell_nodes(c)) cell.push_back(number(i));
    }
  };
  add(coarse, [](NodeIndex i) { return i; });
  std::vector<NodeIndex> numbers;
  for (Point<dim> p : fine.coordinates()) {
    p *= 0.5;
    p[dim - 1] += n;
    const auto same = std::find(x.begin(), x.end(), p);
    numbers.push_back(static_cast<NodeIndex>(same - x.begin()));
    if (same == x.end()) x.push_back(p);
  }
  add(fine, [&](NodeIndex i) { return numbers[i]; });
  Mesh<dim> mesh(std::make_shared<const Topology>(dim, x.size(), test::rows_of(cells)), x);
  for (const NodeIndex i : mesh.topology().free_nodes())
    mesh.coordinates()[i] += Point<dim>::Constant(0.1);
  return mesh;
}

template <int dim>
std::vector<NodeIndex> nodes_of_the_seam(const Mesh<dim>& mesh, double height) {
  std::vector<NodeIndex> nodes;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    if (mesh.coordinates()[i][dim - 1] == height) nodes.push_back(i);
  return nodes;
}

TEST_F(Doctored, HangingNodesStayWhereTheyAre) {
  const PlanarMesh planar = two_levels<2>(3);
  const VolumeMesh volume = two_levels<3>(2);
  write_mesh(file("planar.msh"), planar);
  write_mesh(file("volume.msh"), volume);
  const auto smoothed = [&](const std::string& name, std::vector<std::string> options) {
    options.insert(options.begin(), {"smooth", name, "-m", "getme-simultaneous", "-o", "out.msh"});
    const Outcome outcome = smoothfem(options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("the mesh does not conform: "));
    return read_mesh(file("out.msh")).mesh;
  };
  const auto expect_seam_stays = [](const auto& before, const AnyMesh& result, double height) {
    const auto& after = std::get<std::decay_t<decltype(before)>>(result);
    const auto seam = nodes_of_the_seam(before, height);
    EXPECT_GT(seam.size(), 6u);
    for (const NodeIndex i : seam) EXPECT_EQ(after.coordinates()[i], before.coordinates()[i]);
    EXPECT_NE(after.copied_coordinates(), before.copied_coordinates());
  };
  expect_seam_stays(planar, smoothed("planar.msh", {}), 3.0);
  expect_seam_stays(planar, smoothed("planar.msh", {"--fix", "free"}), 3.0);
  expect_seam_stays(planar, smoothed("planar.msh", {"--untangle", "--boundary", "slide"}), 3.0);
  expect_seam_stays(volume, smoothed("volume.msh", {}), 2.0);
  expect_seam_stays(volume, smoothed("volume.msh", {"--boundary", "slide"}), 2.0);
}

TEST_F(Doctored, QualityWarnsAndStudiesRefuse) {
  write_mesh(file("hanging.msh"), two_levels<2>(3));
  const Outcome quality = smoothfem({"quality", "hanging.msh"});
  EXPECT_EQ(quality.exit_code, 0);
  EXPECT_THAT(quality.out,
              HasSubstr("warning      the mesh does not conform: 3 hanging nodes lie"));
  const auto json = nlohmann::json::parse(smoothfem({"quality", "hanging.msh", "--json"}).out);
  EXPECT_EQ(json.at("findings")[0].at("count"), 3);
  seam();
  for (const std::string name : {"hanging.msh", "seam.vtk"}) {
    file_with("a.prm", "set meshes = m\nset methods = laplace\nsubsection mesh m\n set file = " +
                           name + "\nend\n");
    const Outcome study = smoothfem({"study", "a.prm", "--out", "results", "--quiet"});
    EXPECT_EQ(study.exit_code, 2);
    EXPECT_THAT(study.err, HasSubstr("a study needs a mesh that conforms"));
    EXPECT_FALSE(std::filesystem::exists(file("results")));
  }
}

TEST_F(Doctored, AStudyNotesThatItTurnedCellsOver) {
  file_with("square.mesh",
            "planar_polygonal_mesh\nnodes 5\n0 0\n1 0\n1 1\n0 1\n.4 .5\npolygons 4\n3 0 4 1\n"
            "3 1 2 4\n3 2 3 4\n3 3 0 4\nfixed_node_indices 4\n0\n1\n2\n3\n");
  file_with("a.prm",
            "set meshes = m\nset methods = laplace\nsubsection mesh m\n set file = square.mesh\n"
            "end\n");
  const Outcome study = smoothfem({"study", "a.prm", "--out", "results", "--no-figures"});
  EXPECT_EQ(study.exit_code, 0) << study.err;
  EXPECT_THAT(study.err, HasSubstr("square.mesh: turned over 1 of 4 cells"));
  const auto json = nlohmann::json::parse(content_of(file("results/provenance.json")));
  EXPECT_THAT(json.at("meshes")[0].at("changes")[0].get<std::string>(), HasSubstr("turned over"));
}

}  // namespace
}  // namespace smoothfem
