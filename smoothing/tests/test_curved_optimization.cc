// SPDX-License-Identifier: GPL-3.0-or-later
/// The objective of curved cells, and the method that minimizes it by all nodes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "smoothing/base/parallel.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/periodic/mesh_rules.h"
#include "smoothing/second_order/curved_objective.h"
#include "smoothing/second_order/curved_quality.h"
#include "smoothing/tests/curved_cells.h"
#include "smoothing/tests/curved_meshes.h"
#include "smoothing/tests/dense_derivatives.h"

namespace smoothfem {
namespace {

using test::box_mesh;
using test::BoxCells;
using test::dense_derivatives;
using test::four_triangles;
using test::grid_mesh;
using test::GridCells;
using test::random_curved_mesh;

constexpr double straightness = 3.0;  // both terms count
constexpr std::array both_kinds{SecondOrderKind::complete, SecondOrderKind::serendipity};

/// A mesh of TRI6 with a node in the middle of each triangle: TRI7.
PlanarMesh with_triangle_centres(const PlanarMesh& mesh) {
  auto points = mesh.copied_coordinates();
  MeshLabels labels;
  auto midside = std::make_shared<MidsideNodes>();
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto old = mesh.topology().midside_nodes(c);
    std::vector<NodeIndex> row(old.begin(), old.end());
    row.push_back(static_cast<NodeIndex>(points.size()));
    Point<2> centre = Point<2>::Zero();
    for (const NodeIndex i : mesh.topology().cell_nodes(c)) centre += mesh.coordinates()[i] / 3.0;
    points.push_back(centre);
    midside->of_cells.append(row);
  }
  labels.midside = std::move(midside);
  return {std::make_shared<const Topology>(2, points.size(), mesh.topology().cells(), std::nullopt,
                                           std::move(labels)),
          points};
}

/// Small curved meshes of every type of cells.
template <int dim>
std::vector<Mesh<dim>> curved_meshes() {
  std::vector<Mesh<dim>> meshes;
  std::uint64_t seed = 10;
  for (const auto kind : both_kinds)
    for (const auto& [name, linear] : test::small_meshes<dim>())
      meshes.push_back(random_curved_mesh(linear, kind, ++seed));
  if constexpr (dim == 2) meshes.push_back(with_triangle_centres(meshes[0]));
  return meshes;
}

// --- Rules ---------------------------------------------------------------------------------------

class ReferenceRules : public testing::TestWithParam<SecondOrderType> {};

TEST_P(ReferenceRules, AreExactForDegreeThreeAndHaveTheCorners) {
  const auto [dim, n_corners, n_nodes] = GetParam();
  const auto rule = reference_rule(dim, n_corners);
  const auto factorial = [](int n) { return std::tgamma(n + 1.0); };
  /// The mean of x^i y^j z^k over the reference element.
  const auto mean = [&](int i, int j, int k) {
    const double line = 1.0 / (k + 1);
    const double triangle = 2.0 * factorial(i) * factorial(j) / factorial(i + j + 2);
    const double square = 1.0 / ((i + 1.0) * (j + 1.0));
    if (n_corners == 3) return triangle;
    if (dim == 2) return square;
    if (n_corners == 4)
      return 6.0 * factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3);
    if (n_corners == 5)  // integral of (1-z)^(i+j+2) z^k
      return 3.0 * square * factorial(i + j + 2) * factorial(k) / factorial(i + j + k + 3);
    return (n_corners == 6 ? triangle : square) * line;
  };
  for (int i = 0; i <= 3; ++i)
    for (int j = 0; i + j <= 3; ++j)
      for (int k = 0; i + j + k <= 3 && (dim == 3 || k == 0); ++k) {
        double sum = 0.0;
        for (const auto& [x, weight] : rule)
          sum += weight * std::pow(x[0], i) * std::pow(x[1], j) * std::pow(x[2], k);
        EXPECT_NEAR(sum, mean(i, j, k), 1e-14) << i << j << k;
      }
  for (const auto& [x, weight] : rule) EXPECT_GT(weight, 0.0);
  const auto& nodes = shape_functions(dim, n_nodes).nodes();
  for (std::size_t k = 0; k < n_corners; ++k) {
    const bool is_apex = n_corners == 5 && k == 4;
    EXPECT_EQ(std::any_of(rule.begin(), rule.end(), [&](const auto& p) { return p.x == nodes[k]; }),
              !is_apex);
  }
}

INSTANTIATE_TEST_SUITE_P(Types, ReferenceRules, testing::ValuesIn(second_order_types),
                         [](const auto& info) { return name_of(info.param); });

// --- Objective -----------------------------------------------------------------------------------

/// Compares along random directions of all unknowns.
template <int dim>
void expect_central_differences(Mesh<dim> mesh) {
  constexpr double h = 1e-6;
  CurvedObjective<dim> objective(mesh.shared_topology(), straightness);
  const auto exact = dense_derivatives(objective, mesh, HessianModel::exact);
  const auto start = mesh.copied_coordinates();
  const double scale = exact.hessian.norm();
  ASSERT_GT(exact.gradient.size(), 0);
  test::Random random(6);
  for (int k = 0; k < 2; ++k) {
    Eigen::VectorXd direction(exact.gradient.size());
    for (auto& number : direction) number = random();
    const auto at = [&](double t) {
      for (std::size_t i = 0; i < objective.unknown_nodes().size(); ++i) {
        const NodeIndex node = objective.unknown_nodes()[i];
        mesh.coordinates()[node] =
            start[node] + t * direction.segment<dim>(static_cast<Eigen::Index>(dim * i));
      }
      return std::pair(objective.value(std::as_const(mesh).coordinates()),
                       dense_derivatives(objective, mesh, HessianModel::exact).gradient);
    };
    const auto [above, gradient_above] = at(h);
    const auto [below, gradient_below] = at(-h);
    const double length = direction.norm();
    EXPECT_NEAR(exact.gradient.dot(direction), (above - below) / (2.0 * h), 1e-7 * scale * length);
    // In space the matrix has single precision.
    EXPECT_LT((exact.hessian * direction - (gradient_above - gradient_below) / (2.0 * h)).norm(),
              1e-6 * scale * length);
  }
}

TEST(CurvedObjective, DerivativesAgreeWithCentralDifferences) {
  for (const auto& mesh : curved_meshes<2>()) expect_central_differences(mesh);
  for (const auto& mesh : curved_meshes<3>()) expect_central_differences(mesh);
  PlanarMesh polygons = test::honeycomb_mesh();  // linear cells
  test::distort(polygons, 0.2, 4);
  expect_central_differences(polygons);
}

TEST(CurvedObjective, ConvexModelHasTheGradientAndNoNegativeCurvature) {
  const auto check = []<int dim>(double rounding) {
    for (const auto& mesh : curved_meshes<dim>()) {
      CurvedObjective<dim> objective(mesh.shared_topology(), straightness);
      const auto exact = dense_derivatives(objective, mesh, HessianModel::exact);
      const auto convex = dense_derivatives(objective, mesh, HessianModel::convex);
      EXPECT_LT((exact.gradient - convex.gradient).norm(), 1e-13 * exact.hessian.norm());
      const Eigen::VectorXd eigenvalues =
          convex.hessian.template selfadjointView<Eigen::Lower>().eigenvalues();
      EXPECT_GT(eigenvalues.minCoeff(), -rounding * eigenvalues.maxCoeff());
    }
  };
  check.template operator()<2>(1e-12);
  check.template operator()<3>(1e-5);
}

/// Affine cells have the same inverse mean ratio everywhere.
template <int dim>
void expect_value_of_corners(Mesh<dim> corners) {
  Eigen::Matrix<double, dim, dim> map = Eigen::Matrix<double, dim, dim>::Identity();
  map(0, 0) = 1.7;
  map(0, 1) = 0.4;
  map(1, 0) = -0.2;
  for (auto& x : corners.coordinates()) x = map * x;
  const double of_corners =
      ShapeObjective<dim>(corners.shared_topology()).value(std::as_const(corners).coordinates());
  EXPECT_GT(of_corners, 1.02 * static_cast<double>(corners.n_cells()));
  EXPECT_NEAR(CurvedObjective<dim>(corners.shared_topology(), straightness)
                  .value(std::as_const(corners).coordinates()),
              of_corners, 1e-12 * of_corners);
  for (const auto kind : both_kinds) {
    const Mesh<dim> mesh = with_midside_nodes(corners, kind);
    EXPECT_NEAR(
        CurvedObjective<dim>(mesh.shared_topology(), straightness).value(mesh.coordinates()),
        of_corners, 1e-12 * of_corners);
  }
}

TEST(CurvedObjective, OfAffineCellsIsThatOfTheirCorners) {
  PlanarMesh triangles = grid_mesh(4, GridCells::triangles);
  test::distort(triangles, 0.3, 2);
  expect_value_of_corners(triangles);
  expect_value_of_corners(grid_mesh(4, GridCells::quadrilaterals));
  VolumeMesh tetrahedra = box_mesh(2, 2, 2, BoxCells::tetrahedra);
  test::distort(tetrahedra, 0.3, 2);
  expect_value_of_corners(tetrahedra);
  for (const auto cells : {BoxCells::hexahedra, BoxCells::prisms, BoxCells::pyramids})
    expect_value_of_corners(box_mesh(2, 2, 2, cells));
}

/// One TRI6 with the corners of the reference triangle. Only the middle of the side between the
/// second and the third corner moves, by d. Its shape function is 4 x y. With the ideal triangle,
/// mean(S) = W^-1 + d g', where W^-1 has columns (1, 0) and (-1, 2) / sqrt 3.
TEST(CurvedObjective, BendingOfATriangleByHand) {
  CompressedRows<NodeIndex> cells;
  cells.append(std::array<NodeIndex, 3>{0, 1, 2});
  const std::vector<Point<2>> corners{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
  PlanarMesh mesh =
      with_midside_nodes(PlanarMesh(std::make_shared<const Topology>(2, 3, cells), corners));
  const NodeIndex middle = mesh.topology().midside_nodes(0)[1];
  ASSERT_EQ(mesh.coordinates()[middle], Point<2>(0.5, 0.5));
  const Point<2> d(0.03, 0.05);
  mesh.coordinates()[middle] += d;
  // Gradients by the ideal coordinates: (W^-1)' (4 y, 4 x) = (4 y, (8 x - 4 y) / sqrt 3). Means of
  // x^2, y^2, xy, x over the triangle: 1/6, 1/6, 1/12, 1/3.
  const double of_gradients = 16.0 / 6.0 + (64.0 / 6.0 + 16.0 / 6.0 - 64.0 / 12.0) / 3.0;
  const double root = std::sqrt(3.0);
  Eigen::Matrix2d mean;
  mean << 1.0, -1.0 / root, 0.0, 2.0 / root;
  mean += d * Point<2>(4.0 / 3.0, (8.0 - 4.0) / (3.0 * root)).transpose();
  const double bending = d.squaredNorm() * of_gradients / mean.squaredNorm();
  const auto value = [&](double weight) {
    return CurvedObjective<2>(mesh.shared_topology(), weight)
        .value(std::as_const(mesh).coordinates());
  };
  EXPECT_NEAR(value(2.0) - value(0.0), 2.0 * bending, 1e-14);
}

/// Cells with straight edges do not bend, whatever their shape; others do.
TEST(CurvedObjective, BendingOfStraightCellsIsZero) {
  const auto values = []<int dim>(const Mesh<dim>& mesh) {
    return std::array{CurvedObjective<dim>(mesh.shared_topology(), 0.0).value(mesh.coordinates()),
                      CurvedObjective<dim>(mesh.shared_topology(), 1e3).value(mesh.coordinates())};
  };
  const auto check = [&]<int dim>() {
    for (const auto kind : both_kinds)
      for (auto& [name, corners] : test::small_meshes<dim>()) {
        Mesh<dim> mesh = corners;
        test::distort(mesh, 0.2, 5);
        const auto [without, with] = values(with_midside_nodes(mesh, kind));
        EXPECT_NEAR(with, without, 1e-11 * without) << name;
      }
    for (const auto& mesh : curved_meshes<dim>()) {
      const auto [without, with] = values(mesh);
      EXPECT_GT(with, 1.01 * without);
    }
  };
  check.template operator()<2>();
  check.template operator()<3>();
}

TEST(CurvedObjective, IsInfiniteForCellsWithoutProof) {
  PlanarMesh mesh = four_triangles({1.0, 1.0}, 0.45);
  const CurvedObjective<2> objective(mesh.shared_topology(), straightness);
  EXPECT_LT(objective.value(mesh.coordinates()), std::numeric_limits<double>::infinity());
  const NodeIndex sagging = mesh.topology().midside_nodes(0)[0];
  mesh.coordinates()[sagging].y() = 0.51;
  EXPECT_EQ(objective.value(mesh.coordinates()), std::numeric_limits<double>::infinity());
}

TEST(CurvedObjective, IsInfiniteForCellsThatAreInvalidBetweenThePoints) {
  const SecondOrderType type{2, 4, 9};
  PlanarMesh mesh = with_midside_nodes(grid_mesh(1, GridCells::quadrilaterals));
  const CurvedObjective<2> objective(mesh.shared_topology(), straightness);
  test::Random random(8);
  std::size_t n_between = 0;
  for (int i = 0; i < 400; ++i) {
    const auto nodes = test::random_cell<2>(type, 0.2, random);
    std::size_t k = 0;
    for (const auto row : {mesh.topology().cell_nodes(0), mesh.topology().midside_nodes(0)})
      for (const NodeIndex node : row) mesh.coordinates()[node] = nodes[k++];
    bool is_valid_at_points = true;
    for (const auto& [x, weight] : reference_rule(2, 4))
      is_valid_at_points =
          is_valid_at_points && test::jacobian(nodes, shape_functions(2, 9).gradients(x)) > 0.0;
    const bool is_valid = mesh_quality(mesh).n_invalid == 0;
    n_between += is_valid_at_points && !is_valid;
    EXPECT_EQ(std::isfinite(objective.value(std::as_const(mesh).coordinates())), is_valid) << i;
  }
  EXPECT_GT(n_between, 0u);
}

TEST(CurvedObjective, LimitsStopBeforeCellsBecomeInvalid) {
  for (const auto& mesh : curved_meshes<2>()) {
    const CurvedObjective<2> objective(mesh.shared_topology(), straightness);
    auto to = mesh.copied_coordinates();
    test::Random random(3);
    for (const NodeIndex i : objective.unknown_nodes())
      for (int d = 0; d < 2; ++d) to[i][d] += random();
    std::vector<double> limits;
    EXPECT_LT(objective.limits(mesh.coordinates(), to, 0.9, limits), 1.0);
    for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
      // As far as the first of its nodes may go, the whole cell may.
      double least = 1.0;
      std::vector<Point<2>> points;
      for (const auto row : {mesh.topology().cell_nodes(c), mesh.topology().midside_nodes(c)})
        for (const NodeIndex i : row) least = std::min(least, limits[i]);
      for (const auto row : {mesh.topology().cell_nodes(c), mesh.topology().midside_nodes(c)})
        for (const NodeIndex i : row)
          points.push_back(mesh.coordinates()[i] + least * (to[i] - mesh.coordinates()[i]));
      EXPECT_TRUE(is_proven_valid(std::span<const Point<2>>(points)) ||
                  mesh.topology().midside_nodes(c).empty());
    }
  }
}

// --- Nodes that may move -------------------------------------------------------------------------

TEST(FreeNodesOfSecondOrder, AreInsideAndNotOfFixedCorners) {
  // Two squares of a 2 x 2 grid on the left have another material.
  const PlanarMesh grid = grid_mesh(2, GridCells::quadrilaterals);
  MeshLabels labels;
  for (CellIndex c = 0; c < 4; ++c) {
    double x = 0.0;
    for (const NodeIndex i : grid.topology().cell_nodes(c)) x += grid.coordinates()[i].x();
    labels.cell_tags.push_back(x < 4.0 ? 1 : 2);
  }
  const auto free_of = [&](bool with_materials, bool marks_centre) {
    const Topology plain(2, 9, grid.topology().cells(), std::nullopt,
                         with_materials ? labels : MeshLabels());
    auto reasons = plain.fixed_reasons();
    add_implied_reasons(plain, reasons);
    if (marks_centre)
      for (NodeIndex i = 0; i < 9; ++i)
        if (!plain.on_boundary()[i]) reasons[i] |= bit(FixedReason::marked);
    const PlanarMesh mesh(std::make_shared<const Topology>(2, 9, grid.topology().cells(), reasons,
                                                           with_materials ? labels : MeshLabels()),
                          grid.copied_coordinates());
    return free_nodes_of_second_order(with_midside_nodes(mesh).topology()).size();
  };
  EXPECT_EQ(free_of(false, false), 1u + 4u + 4u);  // centre, edges inside, cells
  EXPECT_EQ(free_of(true, false), 2u + 4u);        // two edges and the centre are on the interface
  EXPECT_EQ(free_of(false, true), 0u);             // all cells and edges inside have the centre
}

// --- Method --------------------------------------------------------------------------------------

template <int dim>
SmoothingResult smooth_by(const std::string& name, Mesh<dim>& mesh) {
  auto method = make_method<dim>(name);
  if (name == "curved-optimization") method.set("straightness", std::to_string(straightness));
  return smooth(mesh, method);
}

TEST(CurvedOptimization, IsBetterThanStraightEdgesBelowABulge) {
  PlanarMesh initial = four_triangles({1.0, 0.9}, 0.35);
  const CurvedObjective<2> objective(initial.shared_topology(), straightness);
  PlanarMesh curved = initial;
  const SmoothingResult result = smooth_by("curved-optimization", curved);
  EXPECT_EQ(result.quality.q_min, mesh_quality(curved).q_min);
  for (const std::string straightening : {"getme", "global-optimization"}) {
    PlanarMesh straight = initial;
    smooth_by(straightening, straight);
    EXPECT_LT(objective.value(std::as_const(curved).coordinates()),
              objective.value(std::as_const(straight).coordinates()));
    EXPECT_GT(mesh_quality(curved).q_min, 1.05 * mesh_quality(straight).q_min) << straightening;
  }
}

template <int dim>
void expect_descent_by_inner_nodes(const Mesh<dim>& initial) {
  CurvedObjective<dim> objective(initial.shared_topology(), straightness);
  std::vector<bool> may_move(initial.n_nodes(), false);
  for (const NodeIndex i : objective.unknown_nodes()) may_move[i] = true;
  Mesh<dim> mesh = initial;
  auto method = make_method<dim>("curved-optimization");
  method.set("straightness", std::to_string(straightness));
  double last = objective.value(initial.coordinates());
  const double first = last;
  smooth(mesh, method, [&](const IterationRecord& record, const Mesh<dim>& now) {
    const double value = objective.value(now.coordinates());  // infinite without proofs
    EXPECT_LE(value, last);
    EXPECT_EQ(record.quality.q_mean, mesh_quality(now).q_mean);
    last = value;
  });
  EXPECT_LT(last, first);
  for (NodeIndex i = 0; i < initial.n_nodes(); ++i)
    if (!may_move[i]) {
      EXPECT_EQ(std::as_const(mesh).coordinates()[i], initial.coordinates()[i]) << i;
    }
  const auto start = dense_derivatives(objective, initial, HessianModel::exact);
  const auto end = dense_derivatives(objective, mesh, HessianModel::exact);
  EXPECT_LT(end.gradient.norm(), 0.02 * start.gradient.norm());
}

TEST(CurvedOptimization, LowersTheObjectiveInEveryStepToAStationaryPoint) {
  for (const auto& mesh : curved_meshes<2>()) expect_descent_by_inner_nodes(mesh);
  for (const auto& mesh : curved_meshes<3>()) expect_descent_by_inner_nodes(mesh);
}

TEST(CurvedOptimization, StartsFromRepairedCellsAndReportsThem) {
  PlanarMesh mesh = four_triangles({1.0, 1.0}, 0.7);
  const SmoothingResult result = smooth_by("curved-optimization", mesh);
  EXPECT_EQ(result.midside.n_repaired, 1u);
  EXPECT_EQ(result.midside.n_relaxed_on_boundary, 1u);
  EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
}

TEST(CurvedOptimization, LeavesNoCurvedCellWorseIfAsked) {
  for (const auto& initial : curved_meshes<2>()) {
    PlanarMesh mesh = initial;
    auto method = make_method<2>("curved-optimization");
    method.set("floor", "initial");
    smooth(mesh, method);
    EXPECT_GE(mesh_quality(mesh).q_min, mesh_quality(initial).q_min);
  }
}

TEST(CurvedOptimization, IsNotMixedWithStagesThatMoveCorners) {
  PlanarMesh mesh = four_triangles({1.2, 0.9}, 0.2);
  auto method = make_method<2>("curved-optimization");
  for (auto& stage : stages_of<2>("laplace")) method.stages.push_back(std::move(stage));
  try {
    smooth(mesh, method);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("stages that move corners only"));
  }
}

TEST(CurvedOptimization, IsRefusedWherePartnersMoveTogether) {
  PlanarMesh mesh = four_triangles({1.2, 0.9}, 0.2);
  auto method = make_method<2>("curved-optimization");
  try {
    smooth_by_rules(mesh, method, {.joins_periodic = true});
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("cannot move together with periodic partners"));
  }
}

/// Large enough for several blocks of cells.
TEST(CurvedOptimization, DoesNotDependOnThreads) {
  const int n = n_threads();
  const PlanarMesh initial =
      random_curved_mesh(grid_mesh(66, GridCells::triangles), SecondOrderKind::complete, 4);
  ASSERT_GT(initial.topology().blocks().size(), 1u);
  std::vector<std::vector<Point<2>>> results;
  for (const int threads : {1, 2}) {
    set_n_threads(threads);
    PlanarMesh mesh = initial;
    auto method = make_method<2>("curved-optimization");
    method.set("max_iterations", "3");
    smooth(mesh, method);
    results.push_back(mesh.copied_coordinates());
  }
  set_n_threads(n);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_NE(results[0], initial.copied_coordinates());
}

}  // namespace
}  // namespace smoothfem
