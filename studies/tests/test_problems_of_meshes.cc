// SPDX-License-Identifier: GPL-3.0-or-later
// Studies of meshes that say something about the problem: materials, hanging nodes, periodic
// partners.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "fem/tests/second_order.h"
#include "meshes/io/mesh_file.h"
#include "smoothing/second_order/curved_quality.h"
#include "studies/framework/run/constraints/hanging_nodes.h"
#include "studies/framework/run/constraints/periodic_nodes.h"
#include "studies/framework/run/run_study.h"
#include "studies/framework/run/study_meshes.h"
#include "studies/tests/study_tests.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ProblemOfMesh : public FileTest {
 protected:
  /// Runs a study of degree 1 of the mesh file mesh.msh.
  fs::path run(const std::string& folder, const std::string& more) const {
    const auto study = read_study(file_with(
        "own.prm",
        "set meshes = mesh\nset methods = laplace\nset timing runs = 1\n"
        "subsection mesh mesh\n set file = mesh.msh\nend\n"
        "subsection finite elements\n set cg tolerance = 1e-13\n set load = quadrature\nend\n" +
            more));
    run_study(study, {.out = file(folder), .mesh_dir = {}, .quiet = true, .n_threads = 2});
    return file(folder);
  }
  std::string refused(const std::string& more) const {
    const std::string message = input_error_of([&] { run("refused", more); });
    EXPECT_EQ(files_in(file("refused")), std::set<std::string>{});
    return message;
  }
  CsvTable summary(const std::string& folder) const {
    return CsvTable(content_of(file(folder) / "summary.csv"));
  }
  double largest(const std::string& folder, const std::string& column) const {
    double value = 0.0;
    for (const auto& row : summary(folder).rows) {
      EXPECT_EQ(row.at("status"), "ok");
      value = std::max(value, std::stod(row.at(column)));
    }
    return value;
  }
};

/// Writes unit squares of a 6 x 4 grid whose cells have the tags 3, "cold", for x < 2 and 8, "hot".
/// Nodes inside of the groups are moved.
void write_two_groups(const fs::path& path) {
  constexpr NodeIndex width = 7, height = 5;
  std::vector<Point<2>> x;
  MeshLabels labels;
  labels.names = {{{2, 3}, "cold"}, {{2, 8}, "hot"}};
  CompressedRows<NodeIndex> cells;
  for (NodeIndex j = 0; j < height; ++j)
    for (NodeIndex i = 0; i < width; ++i) {
      const bool moves = i != 2 && i % (width - 1) != 0 && j % (height - 1) != 0;
      x.emplace_back(i + (moves ? 0.2 * std::sin(i + 3.0 * j) : 0.0), j);
      if (i + 1 == width || j + 1 == height) continue;
      const NodeIndex a = j * width + i;
      cells.append(std::vector{a, a + 1, a + width + 1, a + width});
      labels.cell_tags.push_back(i < 2 ? 3 : 8);
    }
  const std::size_t n_nodes = x.size();
  write_mesh(path, PlanarMesh(std::make_shared<const Topology>(2, n_nodes, std::move(cells),
                                                               std::nullopt, std::move(labels)),
                              std::move(x)));
}

TEST_F(ProblemOfMesh, GroupsHaveTheirDiffusivity) {
  write_two_groups(file("mesh.msh"));
  const std::string u = " set u = if(x < 2, x - 2, (x - 2)/5) + y/2\n";
  const std::string degree = "set degrees = 1\nset refined degrees = 1\nsubsection solution\n" + u;
  run("one", degree + " set diffusivity group=hot = 5\nend\n");
  EXPECT_LT(largest("one", "l2_error"), 1e-10);
  const CsvTable refined(content_of(file("one") / "refined.csv"));
  for (const auto& row : refined.rows) EXPECT_LT(std::stod(row.at("l2_error")), 1e-10);
  run("both", degree + " set diffusivity group = 3 = 1\n set diffusivity group=8=5\nend\n");
  EXPECT_LT(largest("both", "l2_error"), 1e-10);
  EXPECT_THAT(content_of(file("both") / "provenance.json"), HasSubstr("diffusivity group 8"));
  // Results of one diffusivity are not taken for those of another.
  const std::string twice = " set u = if(x < 2, x - 2, (x - 2)/5) + y\n";
  run("both", "set degrees = 1\nset refined degrees = 1\nsubsection solution\n" + twice +
                  " set diffusivity group=8 = 5\nend\n");
  EXPECT_LT(largest("both", "l2_error"), 1e-10);
  EXPECT_NE(content_of(file("both") / "summary.csv"), content_of(file("one") / "summary.csv"));
}

/// Degree 2 has linear functions on curved cells, and quadratic ones on straight cells.
TEST_F(ProblemOfMesh, CellsOfSecondOrderAreCurvedUnlessTheGeometryIsStraight) {
  const auto bent_inside = [](const Point<2>& p) -> Point<2> {
    return p + Point<2>::Constant(3.0 * p.x() * p.y() * (1.0 - p.x()) * (1.0 - p.y()));
  };
  write_mesh(file("mesh.msh"), second_order(unit_square(4, Cells::mixed, 0.1), false, bent_inside));
  const auto problem = [](const std::string& u) {
    return "set degrees = 2\nsubsection solution\n set u = " + u + "\nend\n";
  };
  const std::string straight = "subsection finite elements\n set geometry = straight\nend\n";
  run("linear", problem("x + 2*y"));
  EXPECT_LT(largest("linear", "l2_error"), 1e-10);
  run("curved", problem("x^2 - x*y"));
  EXPECT_GT(largest("curved", "l2_error"), 1e-6);
  EXPECT_THAT(content_of(file("curved") / "provenance.json"),
              HasSubstr("\"geometry\": \"curved\""));
  run("straight", problem("x^2 - x*y") + straight);
  EXPECT_LT(largest("straight", "l2_error"), 1e-10);
  EXPECT_THAT(content_of(file("straight") / "provenance.json"),
              HasSubstr("\"geometry\": \"straight\""));
  // Results of one geometry are not taken for those of the other.
  run("curved", problem("x^2 - x*y") + straight);
  EXPECT_LT(largest("curved", "l2_error"), 1e-10);
  EXPECT_THAT(refused(problem("x") + "set refined degrees = 2\n"),
              testing::AllOf(HasSubstr("mesh mesh"), HasSubstr("refined"), HasSubstr("straight")));
  EXPECT_THAT(
      refused(problem("x") +
              "set solvers = poisson, stock\nsubsection solver stock\n set type = deal.II\nend\n"),
      testing::AllOf(HasSubstr("solver stock"), HasSubstr("set geometry = straight")));
}

TEST_F(ProblemOfMesh, GeneratedCellsOfSecondOrderAreKeptWithTheirNodes) {
  const auto with_methods = [](const std::string& methods) {
    return "set meshes = disc\nset methods = " + methods +
           "\nset timing runs = 1\nset degrees = 2\nsubsection mesh disc\n set domain = disc\n"
           " set order = 2\n set edge scale = 16\n set distort to = 0.7\nend\n"
           "subsection solution\n set u = x^2\nend\n";
  };
  std::vector<std::string> meshes;
  for (const std::string methods : {"laplace", "laplace, getme-simultaneous"}) {
    run_study(read_study(file_with("disc.prm", with_methods(methods))),
              {.out = file("out"), .mesh_dir = {}, .quiet = true, .n_threads = 1});
    meshes.push_back(content_of(file("out") / "meshes/disc_initial.vtk"));
  }
  EXPECT_EQ(meshes[0], meshes[1]);
  const AnyMesh mesh = read_mesh(file("out") / "meshes/disc_getme-simultaneous.vtu").mesh;
  const auto sizes = curved_cell_sizes(std::get<PlanarMesh>(mesh));
  EXPECT_NEAR(std::accumulate(sizes.begin(), sizes.end(), 0.0), std::numbers::pi, 1e-4);
  EXPECT_THAT(content_of(file("out") / "provenance.json"), HasSubstr("of second order"));
}

/// A facet approximates the circle with an error of the order 2, like the elements.
TEST_F(ProblemOfMesh, DiffusivityByTagConvergesAroundADisc) {
  std::vector<double> l2;
  for (const std::string scale : {"8", "4"}) {
    const auto study = read_study(file_with(
        "disc.prm",
        "set meshes = disc\nset methods = laplace\nset timing runs = 1\nset degrees = 1\n"
        "subsection mesh disc\n set domain = square-disc\n set edge scale = " +
            scale +
            "\n set distort within = 0.2\nend\nsubsection solution\n set name = interface-circle\n"
            " set diffusivity = piecewise by tag\nend\n"));
    run_study(study, {.out = file(scale), .mesh_dir = {}, .quiet = true, .n_threads = 2});
    l2.push_back(largest(scale, "l2_error"));
  }
  EXPECT_NEAR(std::log2(l2[0] / l2[1]), 2.0, 0.4);
}

TEST_F(ProblemOfMesh, WrongGroupsAreRefused) {
  write_two_groups(file("mesh.msh"));
  const auto with = [&](const std::string& solution) {
    return refused("set degrees = 1\nsubsection solution\n" + solution + "end\n");
  };
  EXPECT_THAT(with(" set u = x\n set diffusivity group=hott = 5\n"),
              testing::AllOf(HasSubstr("mesh mesh"), HasSubstr("'hott'"), HasSubstr("'hot'")));
  EXPECT_THAT(with(" set u = x\n set diffusivity group=hot = 5\n"), HasSubstr("normal flux"));
  EXPECT_THAT(with(" set name = sine\n set diffusivity group=hot = 5\n"), HasSubstr("formula 'u'"));
  EXPECT_THAT(with(" set name = sine\n set diffusivity = piecewise by tag\n"),
              HasSubstr("interface-plane"));
  EXPECT_THAT(with(" set name = interface-plane\n set diffusivity = piecewise by tag\n"),
              HasSubstr("both sides"));
  EXPECT_THAT(refused("set degrees = 1\nset methods = energy-descent\nsubsection solution\n"
                      " set u = y\n set diffusivity group=hot = 5\nend\n"),
              HasSubstr("energy-descent"));
}

/// Returns n cells in each direction of the unit square or cube, and 2 n in its neighbour at x > 1:
/// nodes of the latter hang on sides of the former.
template <int dim>
Mesh<dim> two_levels(std::size_t n, Cells kind) {
  const Mesh<dim> coarse = unit_mesh<dim>(n, kind, 0.0), fine = unit_mesh<dim>(2 * n, kind, 0.0);
  auto x = coarse.copied_coordinates();
  CompressedRows<NodeIndex> cells = coarse.topology().cells();
  std::vector<NodeIndex> numbers;
  for (const auto& p : fine.coordinates()) {
    const Point<dim> moved = p + Point<dim>::Unit(0);
    const auto same = std::find_if(x.begin(), x.end(),
                                   [&](const Point<dim>& q) { return (q - moved).norm() < 1e-12; });
    numbers.push_back(static_cast<NodeIndex>(same - x.begin()));
    if (same == x.end()) x.push_back(moved);
  }
  std::vector<NodeIndex> row;
  for (CellIndex c = 0; c < fine.n_cells(); ++c) {
    row.clear();
    for (const NodeIndex node : fine.topology().cell_nodes(c)) row.push_back(numbers[node]);
    cells.append(row);
  }
  const std::size_t n_nodes = x.size();
  return {std::make_shared<const Topology>(dim, n_nodes, std::move(cells)), std::move(x)};
}

class HangingNodes : public testing::TestWithParam<Cells> {
 protected:
  template <int dim>
  static SolutionRecord solve(const Mesh<dim>& mesh, const ManufacturedSolution<dim>& solution) {
    PoissonOptions options{.degree = 1,
                           .load = Load::quadrature,
                           .cg_tolerance = 1e-13,
                           .condition_number = ConditionNumberMethod::none,
                           .jacobi_cg = Recorded::never};
    options.ties = std::make_shared<const NodeTies>(joined_ties(hanging_ties(mesh), {}));
    return PoissonSolver<dim>(&mesh, options).solve(mesh.coordinates(), solution);
  }
};

INSTANTIATE_TEST_SUITE_P(Elements, HangingNodes,
                         testing::Values(Cells::triangles, Cells::quadrilaterals, Cells::tetrahedra,
                                         Cells::hexahedra),
                         [](const auto& info) { return std::string(name_of(info.param)); });

TEST_P(HangingNodes, AreTiedToTheSideAround) {
  with_dimension(dimension_of(GetParam()), [&]<int dim>() {
    const auto mesh = two_levels<dim>(2, GetParam());
    const NodeTies ties = hanging_ties(mesh);
    EXPECT_EQ(ties.nodes.size(), dim == 2 ? 2U : 16U);
    for (const auto& tie : ties.nodes) {
      Point<dim> mean = Point<dim>::Zero();
      for (const auto& [master, weight] : tie.masters) mean += weight * mesh.coordinates()[master];
      EXPECT_LT((mean - mesh.coordinates()[tie.node]).norm(), 1e-12);
    }
    for (std::size_t f = 0; f < mesh.topology().boundary_facets().size(); ++f) {
      const auto facet = mesh.topology().boundary_facets()[f];
      std::vector<NodeIndex> nodes(facet.begin(), facet.end());
      std::sort(nodes.begin(), nodes.end());
      const bool inside = std::all_of(nodes.begin(), nodes.end(), [&](NodeIndex i) {
        return std::abs(mesh.coordinates()[i].x() - 1.0) < 1e-12;
      });
      EXPECT_EQ(ties.inner_facets.contains(nodes), inside);
    }
  });
}

TEST_P(HangingNodes, KeepLinearFunctionsExactAndTheOrder) {
  with_dimension(dimension_of(GetParam()), [&]<int dim>() {
    std::vector<double> l2;
    for (const std::size_t n : {4UL, 8UL}) {
      const auto mesh = two_levels<dim>(n, GetParam());
      EXPECT_LT(solve(mesh, manufactured_solution<dim>("linear")).h1_error, 1e-10);
      l2.push_back(solve(mesh, derived_solution<dim>("sin(2*x)*cos(3*y)", "", {})).l2_error);
    }
    EXPECT_NEAR(std::log2(l2[0] / l2[1]), 2.0, 0.3);
  });
}

TEST_F(ProblemOfMesh, HangingNodesAreRefusedOrConstrained) {
  write_mesh(file("mesh.msh"), two_levels<2>(4, Cells::quadrilaterals));
  const std::string linear = "subsection solution\n set u = 1 + 2*x - 3*y\nend\n";
  EXPECT_THAT(refused("set degrees = 1\n" + linear),
              testing::AllOf(HasSubstr("4 hanging nodes"), HasSubstr("hanging nodes = constrain")));
  const std::string solvers =
      "set solvers = poisson, plate, convected\n"
      "subsection solver plate\n set type = elasticity\n set u = x + 2*y ; 3*x - y\nend\n"
      "subsection solver convected\n set type = convection-diffusion\n set velocity = 1 ; 2\nend\n";
  run("out", "set degrees = 1\nset hanging nodes = constrain\n" + linear + solvers);
  for (const std::string error : {"h1_error", "plate.h1_error", "convected.h1_error"})
    EXPECT_LT(largest("out", error), 1e-9) << error;
  EXPECT_THAT(content_of(file("out") / "provenance.json"), HasSubstr("4 hanging nodes"));
  for (const auto& [more, word] : std::map<std::string, std::string>{
           {"set degrees = 1, 2\n", "degree 2"},
           {"set degrees = 1\nset refined degrees = 1\n", "refined"},
           {"set degrees = 1\nset methods = energy-descent\n", "energy-descent"}})
    EXPECT_THAT(refused("set hanging nodes = constrain\n" + more + linear), HasSubstr(word));
  EXPECT_THAT(refused("set degrees = 2\nset hanging nodes = constrain\nset solvers = plate\n"
                      "subsection solver plate\n set type = elasticity\n set u = x ; y\nend\n"),
              HasSubstr("hanging and periodic nodes need finite elements of degree 1"));
}

/// Writes a unit mesh whose nodes at x = 1 are periodic partners of those at x = 0.
void write_periodic(const fs::path& path, bool everywhere) {
  const auto plain = unit_square(8, Cells::triangles, 0.15);
  auto content = std::make_shared<FileContent>();
  for (const int d : everywhere ? std::vector{0, 1} : std::vector{0}) {
    PeriodicEntity entity{
        .dimension = 1, .entity = 2 + 10 * d, .partner = 1 + 10 * d, .affine = {}, .nodes = {}};
    for (NodeIndex i = 0; i < plain.n_nodes(); ++i)
      for (NodeIndex j = 0; j < plain.n_nodes(); ++j)
        if ((plain.coordinates()[i] - plain.coordinates()[j] - Point<2>::Unit(d)).norm() < 1e-12)
          entity.nodes.push_back({i, j});
    content->periodic.push_back(entity);
  }
  MeshLabels labels;
  labels.content = content;
  write_mesh(path, PlanarMesh(std::make_shared<const Topology>(2, plain.n_nodes(),
                                                               plain.topology().cells(),
                                                               std::nullopt, std::move(labels)),
                              plain.copied_coordinates()));
}

TEST_F(ProblemOfMesh, PeriodicPartnersHaveTheSameUnknown) {
  write_periodic(file("mesh.msh"), false);
  const std::string wave = "subsection solution\n set u = sin(2*pi*x + 1)*cos(y)\nend\n";
  run("given", "set degrees = 1\n" + wave);
  EXPECT_THAT(content_of(file("given") / "provenance.json"), HasSubstr("periodic = constrain"));
  EXPECT_EQ(summary("given").rows.front().at("n_free"), "49");
  run("tied", "set degrees = 1\nset periodic = constrain\n" + wave);
  EXPECT_EQ(summary("tied").rows.front().at("n_free"), "56");
  EXPECT_LT(largest("tied", "l2_error"), 0.05);
  const std::string solver =
      "set solvers = other\nsubsection solver other\n set type = deal.II\nend\n" + wave;
  run("changed", "set degrees = 1\n" + solver);
  EXPECT_EQ(summary("changed").rows.front().at("other.n_free"), "49");
  run("changed", "set degrees = 1\nset periodic = constrain\n" + solver);
  EXPECT_EQ(summary("changed").rows.front().at("other.n_free"), "56") << "solved again";
  EXPECT_THAT(refused("set degrees = 1\nset periodic = constrain\n"
                      "subsection solution\n set u = x*y\nend\n"),
              HasSubstr("not that at its periodic partner"));
  EXPECT_THAT(refused("set degrees = 1\nset periodic = constrain\n"
                      "subsection solution\n set u = x*(1-x)*y\nend\n"),
              HasSubstr("the solution's gradient at"));
  write_mesh(file("mesh.msh"), unit_square(8, Cells::triangles, 0.15));
  run("plain", "set degrees = 1\nset periodic = constrain\n" + wave);
  EXPECT_THAT(content_of(file("plain") / "provenance.json"),
              HasSubstr("the mesh has no periodic partners"));
  write_periodic(file("mesh.msh"), true);
  EXPECT_THAT(refused("set degrees = 1\nset periodic = constrain\n" + wave),
              HasSubstr("whole boundary is periodic"));
}

/// An interrupted run goes on with everything that the mesh says.
TEST_F(ProblemOfMesh, ResumedMeshesAreTheSame) {
  write_two_groups(file("mesh.msh"));
  const auto study = read_study(file_with(
      "own.prm",
      "set meshes = own, generated\nset methods = laplace\nset timing runs = 1\n"
      "set degrees = 1\nsubsection mesh own\n set file = mesh.msh\n set distort to = 0.7\nend\n"
      "subsection mesh generated\n set domain = square-halves\n set edge scale = 8\n"
      " set distort to = 0.6\nend\n"
      "subsection solution\n set u = y\nend\n"));
  for (const auto& description : study.meshes) {
    const KeptResults kept(file("out") / "kept");
    auto first = prepare_mesh<2>(description, study, {}, nullptr);
    write_initial_mesh(first, file("out"), kept);
    ASSERT_TRUE(kept.find_mesh(first.kept_name));
    const auto again = prepare_mesh<2>(description, study, {}, &kept);
    EXPECT_EQ(again.mesh.copied_coordinates(), first.mesh.copied_coordinates());
    EXPECT_EQ(again.mesh.topology().labels(), first.mesh.topology().labels());
    EXPECT_EQ(again.mesh.topology().labels().cell_tags.size(), first.mesh.n_cells());
    EXPECT_EQ(again.mesh.topology().fixed_reasons(), first.mesh.topology().fixed_reasons());
  }
}

}  // namespace
}  // namespace smoothfem
