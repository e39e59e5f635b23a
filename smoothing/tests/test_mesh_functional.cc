// SPDX-License-Identifier: GPL-3.0-or-later
// What methods that know a solution move nodes by: metrics, their fields, Huang's functional, and
// the nodes themselves.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "smoothing/geometry/cell_size.h"
#include "smoothing/solution/error_metric.h"
#include "smoothing/solution/mesh_functional.h"
#include "smoothing/solution/movable_nodes.h"
#include "smoothing/tests/planar_meshes.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

PlanarMesh square_mesh(std::uint32_t n, bool triangles) {
  std::vector<Point<2>> points;
  CompressedRows<NodeIndex> cells;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) points.emplace_back(i, j);
  for (NodeIndex j = 0; j < n; ++j)
    for (NodeIndex i = 0; i < n; ++i) {
      const NodeIndex a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      if (triangles) {
        cells.append(std::vector{a, b, c});
        cells.append(std::vector{a, c, d});
      } else {
        cells.append(std::vector{a, b, c, d});
      }
    }
  const std::size_t n_nodes = points.size();
  return {std::make_shared<Topology>(2, n_nodes, std::move(cells)), std::move(points)};
}

template <int dim>
Mesh<dim> regular_mesh(bool simplices) {
  if constexpr (dim == 2)
    return square_mesh(4, simplices);
  else
    return test::box_mesh(3, 3, 3,
                          simplices ? test::BoxCells::tetrahedra : test::BoxCells::hexahedra);
}

template <int dim>
Mesh<dim> bent_mesh(bool simplices, double amount) {
  auto mesh = regular_mesh<dim>(simplices);
  for (const NodeIndex i : mesh.topology().free_nodes())
    for (int d = 0; d < dim; ++d)
      mesh.coordinates()[i][d] += amount * std::sin(1.0 + 3.0 * i + 5.0 * d);
  return mesh;
}

template <int dim>
std::vector<double> sizes_of(const Mesh<dim>& mesh) {
  std::vector<double> sizes;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) sizes.push_back(signed_cell_size(mesh, c));
  return sizes;
}

/// A metric that differs in any two places.
template <int dim>
TensorField<dim> varying_field(const Mesh<dim>& mesh) {
  std::vector<CellTensor<dim>> of_cells;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const Point<dim>& p = mesh.coordinates()[mesh.topology().cell_nodes(c)[0]];
    Point<dim> direction = Point<dim>::Ones();
    direction[0] = std::sin(p[0] + 0.5 * p[1]);
    of_cells.push_back(CellTensor<dim>::Identity() + 0.5 * direction * direction.transpose());
  }
  return TensorField<dim>(mesh, of_cells, sizes_of(mesh));
}

template <class Check>
void for_all_cells(const Check& check) {
  for (const bool simplices : {true, false}) {
    check.template operator()<2>(simplices);
    check.template operator()<3>(simplices);
  }
}

/// With the same curvature everywhere all cells should be alike.
TEST(ErrorMetric, IsTheIdentityForOneCurvature) {
  const std::vector<CellTensor<3>> hessians(2, -7.0 * CellTensor<3>::Identity());
  for (const auto& m : error_metric<3>(hessians, std::vector{1.0, 3.0}, 4.0))
    EXPECT_LT((m - CellTensor<3>::Identity()).norm(), 1e-6);
  const std::vector<CellTensor<2>> none(2, CellTensor<2>::Zero());
  for (const auto& m : error_metric<2>(none, std::vector{1.0, 3.0}, 4.0))
    EXPECT_EQ(m, (CellTensor<2>::Identity()));
}

/// Two cells of size 1, one of them without curvature. By hand, for d = 2 and curvature l along x:
/// sqrt(det M) = ((a + l)^2 + a^2)^(1/4) / 2^(1/4) ((a + l) a)^(1/4) in one cell and a in the
/// other. Together they are 2 c a. Then M is scaled to an integral of 2.
TEST(ErrorMetric, OfOneBentCellMatchesHandComputation) {
  CellTensor<2> bent = CellTensor<2>::Zero();
  bent(0, 0) = 5.0;
  constexpr double c = 3.0;
  const auto metric = error_metric<2>(std::vector<CellTensor<2>>{bent, CellTensor<2>::Zero()},
                                      std::vector{1.0, 1.0}, c);
  const double scale = metric[1](0, 0);  // 1 / c
  EXPECT_NEAR(scale, 1.0 / c, 1e-9);
  EXPECT_NEAR(std::sqrt(metric[0].determinant()), 2.0 - scale, 1e-9);
  EXPECT_NEAR(metric[0](0, 1), 0.0, 1e-12);
  const double ratio = metric[0](0, 0) / metric[0](1, 1);  // (a + l) / a
  const double root = std::pow((ratio * ratio + 1.0) / 2.0, 0.25) * std::pow(ratio, 0.25);
  EXPECT_NEAR(root, 2.0 * c - 1.0, 1e-6);
}

TEST(TensorField, DoesNotDependOnTheStartOfTheSearch) {
  for_all_cells([]<int dim>(bool simplices) {
    const auto mesh = bent_mesh<dim>(simplices, 0.15);
    const auto field = varying_field(mesh);
    for (CellIndex target = 0; target < mesh.n_cells(); target += 3) {
      Point<dim> point = Point<dim>::Zero();
      const auto nodes = mesh.topology().cell_nodes(target);
      for (const NodeIndex i : nodes) point += mesh.coordinates()[i] / nodes.size();
      CellIndex near = target, far = 0;
      const auto here = field.at(point, near), there = field.at(point, far);
      EXPECT_LT((here.tensor - there.tensor).norm(), 1e-9) << target;
      // Linear around the point, unless it lies on a border.
      constexpr double h = 1e-6;
      for (int d = 0; d < dim && simplices; ++d) {
        const Point<dim> offset = h * Point<dim>::Unit(d);
        const CellTensor<dim> difference =
            (field.at(point + offset, near).tensor - field.at(point - offset, near).tensor) /
            (2.0 * h);
        EXPECT_LT((difference - here.derivatives[d]).norm(), 1e-6);
      }
    }
  });
}

TEST(TensorField, OutsideIsThatOfTheBoundary) {
  const auto mesh = regular_mesh<2>(true);
  const auto field = varying_field(mesh);
  CellIndex a = 0, b = 0;
  EXPECT_LT((field.at({-0.5, 1.0}, a).tensor - field.at({0.0, 1.0}, b).tensor).norm(), 0.3);
}

/// J is the identity: theta d^(dp/2) + (1 - 2 theta) d^(dp/2) on each unit of size.
TEST(MeshFunctional, OfItsReferenceMatchesHandComputation) {
  for_all_cells([]<int dim>(bool simplices) {
    const auto mesh = regular_mesh<dim>(simplices);
    MeshFunctional<dim> functional(mesh);
    const std::vector<CellTensor<dim>> metric(mesh.n_cells(), CellTensor<dim>::Identity());
    functional.set_metric(TensorField<dim>(mesh, metric, sizes_of(mesh)));
    const double size = dim == 2 ? 16.0 : 27.0;
    EXPECT_NEAR(functional.value(mesh), size * 2.0 / 3.0 * std::pow(dim, 0.75 * dim), 1e-9);
    for (const NodeIndex i : mesh.topology().free_nodes())
      EXPECT_LT(functional.gradient()[i].norm(), 1e-9);
    EXPECT_GT(functional.value(bent_mesh<dim>(simplices, 0.1)),
              size * 2.0 / 3.0 * std::pow(dim, 0.75 * dim));
  });
}

TEST(MeshFunctional, GradientAgreesWithDifferences) {
  for_all_cells([]<int dim>(bool simplices) {
    const auto mesh = bent_mesh<dim>(simplices, 0.1);
    MeshFunctional<dim> functional(regular_mesh<dim>(simplices));
    functional.set_metric(varying_field(bent_mesh<dim>(simplices, 0.15)));
    functional.value(mesh);
    const auto gradient = functional.gradient();
    constexpr double h = 1e-6;
    double derivative = 0.0, scale = 0.0;
    auto forth = mesh, back = mesh;
    for (const NodeIndex i : mesh.topology().free_nodes()) {
      Point<dim> direction;
      for (int d = 0; d < dim; ++d) direction[d] = std::cos(2.0 + 7.0 * i + 3.0 * d);
      forth.coordinates()[i] += h * direction;
      back.coordinates()[i] -= h * direction;
      derivative += gradient[i].dot(direction);
      scale += gradient[i].norm();
    }
    const double difference = (functional.value(forth) - functional.value(back)) / (2.0 * h);
    EXPECT_NEAR(derivative, difference, 1e-6 * scale);
  });
}

TEST(MeshFunctional, IsInfiniteForInvalidMeshes) {
  for_all_cells([]<int dim>(bool simplices) {
    auto mesh = regular_mesh<dim>(simplices);
    MeshFunctional<dim> functional(mesh);
    functional.set_metric(varying_field(mesh));
    mesh.coordinates()[mesh.topology().free_nodes()[0]] += 1.5 * Point<dim>::Ones();
    EXPECT_TRUE(std::isinf(functional.value(mesh)));
  });
}

TEST(MovableNodes, SlideOnStraightLinesAndPlaneFaces) {
  const auto mesh = regular_mesh<3>(false);  // 3 x 3 x 3
  const MovableNodes<3> fixed(mesh, false), sliding(mesh, true);
  EXPECT_EQ(fixed.nodes(), mesh.topology().free_nodes());
  EXPECT_EQ(sliding.nodes().size(), 64u - 8u);
  const Point<3> movement(1.0, 2.0, 3.0);
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    if (!sliding.contains(i)) continue;
    Point<3> expected = movement;
    for (int d = 0; d < 3; ++d)
      if (const double x = mesh.coordinates()[i][d]; x == 0.0 || x == 3.0) expected[d] = 0.0;
    EXPECT_LT((sliding.along(i, movement) - expected).norm(), 1e-12) << i;
  }
}

TEST(MovableNodes, StayOnCurvedBoundariesAndBetweenParts) {
  auto mesh = square_mesh(4, true);
  EXPECT_EQ(MovableNodes<2>(mesh, true).nodes().size(), 25u - 4u);
  auto bent = mesh;
  for (NodeIndex i = 0; i <= 4; ++i) bent.coordinates()[i].y() = -0.01 * i * (4.0 - i);
  EXPECT_EQ(MovableNodes<2>(bent, true).nodes().size(), 25u - 4u - 3u);
  MeshLabels labels;
  labels.facets.append(std::vector<NodeIndex>{0, 1});
  labels.facet_tags.push_back(7);
  const Mesh<2> tagged(std::make_shared<Topology>(2, mesh.n_nodes(), mesh.topology().cells(),
                                                  std::nullopt, std::move(labels)),
                       mesh.copied_coordinates());
  const MovableNodes<2> nodes(tagged, true);
  EXPECT_FALSE(nodes.contains(1));
  EXPECT_TRUE(nodes.contains(2));
}

}  // namespace
}  // namespace smoothfem
