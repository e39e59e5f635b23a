// SPDX-License-Identifier: GPL-3.0-or-later
// Criteria of these tests, for elements of degree 2 on domains with a curved boundary:
//
//   curved geometry     order 3 in L2, 2 in H1 (isoparametric elements; Ciarlet, Raviart 1972)
//   straight geometry   order 2 in L2, 3/2 in H1 (the boundary is of order h^2 off; Strang, Berger
//                       1973). Boundary values of a formula at the chords' own points would hide
//                       this: the discrete problem would be one on the polygon.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "fem/assembly/assembly.h"
#include "fem/assembly/error_norms.h"
#include "fem/poisson_solver.h"
#include "fem/tests/second_order.h"

namespace smoothfem {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

PoissonOptions exact_options(int degree, Geometry geometry = Geometry::curved) {
  PoissonOptions options;
  options.degree = degree;
  options.geometry = geometry;
  options.load = Load::quadrature;
  options.tensor_points.hexahedron = 4;
  options.cg_tolerance = 1e-12;
  options.condition_number = ConditionNumberMethod::none;
  options.jacobi_cg = Recorded::never;
  return options;
}

template <int dim>
SolutionRecord solve(const Mesh<dim>& mesh, const ManufacturedSolution<dim>& solution,
                     const PoissonOptions& options) {
  return PoissonSolver<dim>(&mesh, options).solve(mesh.coordinates(), solution);
}

/// The meshes of a domain.
template <int dim>
struct Domain {
  std::function<Mesh<dim>(std::size_t n)> mesh;
  std::size_t coarse;  ///< n of the coarser mesh
};

Domain<2> disc(bool triangles, bool complete) {
  return {[=](std::size_t n) {
            return second_order(ringed_square(n, triangles), complete, disc_of_square);
          },
          4};
}

Domain<3> shell(Cells cells, bool complete) {
  return {[=](std::size_t n) {
            return second_order(unit_cube(n, cells, 0.0), complete, shell_of_unit<3>);
          },
          3};
}

/// A quarter of a torus: the disc moves on a circle of radius 2.
Domain<3> pipe_bend(bool tetrahedra, bool complete) {
  return {[=](std::size_t n) {
            return second_order(
                extruded(ringed_square(n, tetrahedra), 2 * n), complete,
                [](const Point<3>& p) -> Point<3> {
                  const Point<2> q = disc_of_square({p.x(), p.y()});
                  const double angle = std::numbers::pi / 2.0 * p.z();
                  return {(2.0 + q.x()) * std::cos(angle), q.y(), (2.0 + q.x()) * std::sin(angle)};
                });
          },
          2};
}

template <int dim>
ManufacturedSolution<dim> smooth_solution() {
  return derived_solution<dim>(dim == 2 ? "exp(x)*sin(2*y + 1)" : "exp(x/2)*sin(y + 1)*cos(z)", "",
                               {});
}

struct Orders {
  double l2, h1;
};

template <int dim>
Orders orders_on(const Domain<dim>& domain, Geometry geometry, std::size_t coarse) {
  std::array<SolutionRecord, 2> records;
  for (std::size_t k = 0; k < 2; ++k) {
    records[k] =
        solve(domain.mesh(coarse << k), smooth_solution<dim>(), exact_options(2, geometry));
    EXPECT_EQ(records[k].status, "ok");
  }
  const Orders orders{std::log2(records[0].l2_error / records[1].l2_error),
                      std::log2(records[0].h1_error / records[1].h1_error)};
  return orders;
}

template <int dim>
void expect_orders(const Domain<dim>& domain) {
  const std::size_t coarse =
      std::getenv("SMOOTHFEM_LONG_TESTS") ? 2 * domain.coarse : domain.coarse;
  const Orders curved = orders_on(domain, Geometry::curved, coarse);
  EXPECT_NEAR(curved.l2, 3.0, 0.25);
  EXPECT_NEAR(curved.h1, 2.0, 0.2);
  const Orders straight = orders_on(domain, Geometry::straight, coarse);
  EXPECT_NEAR(straight.l2, 2.0, 0.25);
  EXPECT_NEAR(straight.h1, 1.5, 0.25);
}

TEST(CurvedCells, OrdersOnADiscOfTriangles) {
  expect_orders(disc(true, false));
}
TEST(CurvedCells, OrdersOnADiscOfTrianglesWithCentres) {
  expect_orders(disc(true, true));
}
TEST(CurvedCells, OrdersOnADiscOfQuadrilateralsWithoutCentres) {
  expect_orders(disc(false, false));
}
TEST(CurvedCells, OrdersOnADiscOfQuadrilaterals) {
  expect_orders(disc(false, true));
}
TEST(CurvedCells, OrdersOnAShellOfTetrahedra) {
  expect_orders(shell(Cells::tetrahedra, false));
}
TEST(CurvedCells, OrdersOnAShellOfHexahedra) {
  expect_orders(shell(Cells::hexahedra, true));
}

TEST(CurvedCells, OrdersOnAPipeBendOfTetrahedra) {
  expect_orders(pipe_bend(true, false));
}
TEST(CurvedCells, OrdersOnAPipeBendOfHexahedraWithoutCentres) {
  expect_orders(pipe_bend(false, false));
}

TEST(CurvedCells, OrdersWithDiffusivityAndNaturalConditionsOnArcs) {
  std::array<SolutionRecord, 2> records;
  auto options = exact_options(2);
  options.natural_groups = {"left", "right"};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto mesh =
        second_order(with_groups(unit_square(4U << k, Cells::mixed, 0.0)), false, shell_of_unit<2>);
    records[k] = solve(
        mesh, derived_solution<2>("exp(x)*sin(2*y + 1)", "2, x/2 ; x/2, 1 + y^2", {}), options);
  }
  EXPECT_NEAR(std::log2(records[0].l2_error / records[1].l2_error), 3.0, 0.25);
  EXPECT_NEAR(std::log2(records[0].h1_error / records[1].h1_error), 2.0, 0.2);
}

TEST(CurvedCells, OrdersOfDegreeOneOnShellsOfOtherCells) {
  for (const Cells cells : {Cells::prisms, Cells::pyramids, Cells::mixed_volume}) {
    std::array<SolutionRecord, 2> records;
    const auto domain = shell(cells, false);
    for (std::size_t k = 0; k < 2; ++k)
      records[k] = solve(domain.mesh(4U << k), smooth_solution<3>(), exact_options(1));
    EXPECT_NEAR(std::log2(records[0].l2_error / records[1].l2_error), 2.0, 0.25) << name_of(cells);
    EXPECT_NEAR(std::log2(records[0].h1_error / records[1].h1_error), 1.0, 0.2) << name_of(cells);
  }
}

class CurvedCellsTest : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Elements, CurvedCellsTest, testing::ValuesIn(all_cases()),
                         [](const auto& info) { return name_of(info.param); });

/// Runs body.operator()<dim>(mesh) on both kinds of meshes of second order.
template <class Body>
void on_curved_meshes(const Case& c, const Body& body) {
  for (const bool complete : {false, true})
    c.on_mesh(4, 2, 0.2, [&]<int dim>(const Mesh<dim>& linear) {
      body(second_order(with_groups(linear), complete, shell_of_unit<dim>));
    });
}

/// Linear functions are in the space if the mapping is in that of the element. The bubble of a node
/// in the middle of triangles is not.
template <class Body>
void on_isoparametric_meshes(const Case& c, const Body& body) {
  if (c.degree == 1) GTEST_SKIP() << "linear functions are not in the space";
  const bool has_triangles = c.cells == Cells::triangles || c.cells == Cells::mixed;
  on_curved_meshes(c, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto& of_cells = mesh.topology().midside()->of_cells;
    for (CellIndex cell = 0; has_triangles && cell < mesh.n_cells(); ++cell)
      if (of_cells[cell].size() == 4 && mesh.topology().cell_nodes(cell).size() == 3) return;
    body(mesh);
  });
}

TEST_P(CurvedCellsTest, LinearSolutionsAreExactWithNaturalConditionsToo) {
  on_isoparametric_meshes(GetParam(), [&]<int dim>(const Mesh<dim>& mesh) {
    for (const bool natural : {false, true}) {
      auto options = exact_options(2);
      if (natural) options.natural_groups = {"left", "right"};
      options.cg_tolerance = 1e-14;
      const auto record = solve(mesh, manufactured_solution<dim>("linear"), options);
      EXPECT_EQ(record.status, "ok");
      EXPECT_LT(record.e_max, 1e-12);
      EXPECT_LT(record.l2_error, 1e-12);
      EXPECT_LT(record.h1_error, 1e-11);
    }
  });
}

TEST_P(CurvedCellsTest, EveryNodeHasAValueAndItsError) {
  on_curved_meshes(GetParam(), [&]<int dim>(const Mesh<dim>& mesh) {
    const auto& u = manufactured_solution<dim>("sine");
    PoissonSolver<dim> solver(&mesh, exact_options(GetParam().degree));
    (void)solver.solve(mesh.coordinates(), u);
    const auto values = solver.discrete_solution(mesh, u).node_values,
               errors = solver.nodal_errors();
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      EXPECT_NEAR(errors[i], std::abs(u.value(mesh.coordinates()[i]) - values[i]), 1e-15);
  });
}

TEST_P(CurvedCellsTest, SizesAreThoseOfTheCurvedDomain) {
  on_curved_meshes(GetParam(), [&]<int dim>(const Mesh<dim>& mesh) {
    // The L2 norm of u = 1 against u_h = 0 is the root of the size.
    const auto size = [&](Geometry geometry) {
      const auto space = make_finite_element_space(&mesh, GetParam().degree, {.hexahedron = 4}, {},
                                                   {}, nullptr, geometry);
      const Eigen::VectorXd zeros =
          Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space->n_local));
      const auto norms = error_norms(*space, space->local_coordinates(mesh.coordinates()),
                                     derived_solution<dim>("1 + 0*x", "", {}), zeros, zeros);
      return norms.l2_error * norms.l2_error;
    };
    const double pi = std::numbers::pi, exact = dim == 2 ? 0.75 * pi : 14.0 / 9.0 * pi;
    EXPECT_NEAR(size(Geometry::curved) / exact, 1.0, dim == 2 ? 1e-3 : 2e-2);
    EXPECT_GT(std::abs(size(Geometry::straight) / exact - 1.0), dim == 2 ? 1e-2 : 5e-2);
  });
}

TEST_P(CurvedCellsTest, NeighboursShareTheirEdgesAndFacesIfOnlySomeHaveMidsideNodes) {
  on_isoparametric_meshes(GetParam(), [&]<int dim>(const Mesh<dim>& mesh) {
    MeshLabels labels = mesh.topology().labels();
    auto some = std::make_shared<MidsideNodes>();
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      some->of_cells.append(c % 2 == 0 ? mesh.topology().midside_nodes(c)
                                       : std::span<const NodeIndex>());
    labels.midside = std::move(some);
    const Mesh<dim> partly(
        std::make_shared<const Topology>(dim, mesh.n_nodes(), mesh.topology().cells(), std::nullopt,
                                         std::move(labels)),
        mesh.copied_coordinates());
    const auto record =
        solve(partly, manufactured_solution<dim>("linear"), exact_options(GetParam().degree));
    EXPECT_EQ(record.status, "ok");
    EXPECT_LT(record.e_max, 1e-11);
    EXPECT_LT(record.h1_error, 1e-10);
  });
}

TEST_P(CurvedCellsTest, MidsideNodesInTheMiddleChangeNothing) {
  for (const bool complete : {false, true})
    GetParam().on_mesh(4, 3, 0.2, [&]<int dim>(const Mesh<dim>& linear) {
      const auto& solution = manufactured_solution<dim>(dim == 2 ? "gear" : "volume");
      const auto options = exact_options(GetParam().degree);
      const auto curved = solve(second_order(linear, complete), solution, options),
                 expected = solve(linear, solution, options);
      EXPECT_EQ(curved.status, expected.status);
      EXPECT_EQ(curved.n_dofs, expected.n_dofs);
      EXPECT_EQ(curved.n_free, expected.n_free);
      // On tetrahedra of degree 1 the rules of errors and loads differ.
      const double tolerance =
          GetParam().cells == Cells::tetrahedra && GetParam().degree == 1 ? 0.05 : 1e-8;
      EXPECT_NEAR(curved.e_max / expected.e_max, 1.0, tolerance);
      EXPECT_NEAR(curved.l2_error / expected.l2_error, 1.0, tolerance);
      EXPECT_NEAR(curved.h1_error / expected.h1_error, 1.0, tolerance);
      EXPECT_NEAR(curved.e_h1 / expected.e_h1, 1.0, tolerance);
    });
}

TEST_P(CurvedCellsTest, QuadraticSolutionsAreExactOnStraightSides) {
  if (GetParam().degree == 1) GTEST_SKIP() << "not in the space";
  GetParam().on_mesh(4, 3, 0.2, [&]<int dim>(const Mesh<dim>& linear) {
    const auto record = solve(second_order(linear, true), manufactured_solution<dim>("quadratic"),
                              exact_options(2));
    EXPECT_LT(record.e_max, 1e-11);
    EXPECT_LT(record.h1_error, 1e-10);
  });
}

TEST_P(CurvedCellsTest, StraightGeometryTakesBoundaryValuesAloneFromMidsideNodes) {
  on_curved_meshes(GetParam(), [&]<int dim>(const Mesh<dim>& mesh) {
    MeshLabels labels = mesh.topology().labels();
    labels.midside = nullptr;
    const Mesh<dim> corners(
        std::make_shared<const Topology>(dim, mesh.n_nodes(), mesh.topology().cells(), std::nullopt,
                                         std::move(labels)),
        mesh.copied_coordinates());
    const auto& solution = manufactured_solution<dim>(dim == 2 ? "gear" : "volume");
    const auto system_of = [&](const Mesh<dim>& of, Geometry geometry) {
      const auto space = make_finite_element_space(&of, GetParam().degree, {.hexahedron = 4}, {},
                                                   {}, nullptr, geometry);
      PoissonSystem system = make_system(*space);
      assemble(*space, space->local_coordinates(of.coordinates()), solution, Load::nodal, system);
      return system;
    };
    const auto straight = system_of(mesh, Geometry::straight),
               linear = system_of(corners, Geometry::straight),
               curved = system_of(mesh, Geometry::curved);
    const Eigen::Index n_free = straight.matrix.cols();
    EXPECT_EQ(straight.matrix.coeffs().matrix(), linear.matrix.coeffs().matrix());
    EXPECT_EQ(straight.exact.head(n_free), linear.exact.head(n_free));
    const Eigen::Index n_given = straight.exact.size() - n_free;
    ASSERT_GT(n_given, 0);
    EXPECT_EQ(straight.exact.tail(n_given), curved.exact.tail(n_given));
    if (GetParam().degree == 2) {
      EXPECT_NE(straight.exact.tail(n_given), linear.exact.tail(n_given));
    }
  });
}

TEST(CurvedCells, BoundaryValuesAreTakenOnTheArc) {
  for (const bool triangles : {false, true}) {
    const auto mesh = disc(triangles, false).mesh(3);
    const auto space = make_finite_element_space(&mesh, 2, TensorPoints{});
    const auto points = space->dof_points(space->local_coordinates(mesh.coordinates()));
    for (std::size_t dof = space->n_columns; dof < space->n_local; ++dof)
      EXPECT_NEAR(points[dof].norm(), 1.0, 1e-15);
    EXPECT_EQ(space->n_own_boundary, 2 * 4 * 3U);
  }
}

TEST(CurvedCells, ChosenRulesAreAsAccurateAsOnStraightHexahedra) {
  for (const int degree : {1, 2}) {
    const auto mesh = second_order(unit_cube(2, Cells::hexahedra, 0.2), true, shell_of_unit<3>);
    const auto matrix = [&](int n_points) {
      const auto space = make_finite_element_space(&mesh, degree, {.hexahedron = n_points});
      PoissonSystem system = make_system(*space);
      assemble(*space, space->local_coordinates(mesh.coordinates()),
               manufactured_solution<3>("sine"), Load::none, system);
      return system.matrix;
    };
    const SparseMatrix fine = matrix(20);
    EXPECT_LT((matrix(0) - fine).norm(), adaptive_quadrature::tolerance * fine.norm());
  }
}

TEST(CurvedCells, RefuseFoldedCellsByName) {
  auto mesh = second_order(unit_square(2, Cells::triangles, 0.0), false);
  const NodeIndex node = mesh.topology().midside_nodes(3)[0];
  PoissonSolver<2> solver(&mesh, exact_options(2));
  (void)solver.solve(mesh.coordinates(), manufactured_solution<2>("sine"));
  mesh.coordinates()[node] += Point<2>(0.24, 0.4);
  EXPECT_THAT([&] { (void)solver.solve(mesh.coordinates(), manufactured_solution<2>("sine")); },
              ThrowsMessage<CellError>(HasSubstr("is folded inside by its midside nodes")));
  const auto straight = exact_options(2, Geometry::straight);
  EXPECT_EQ(solve(mesh, manufactured_solution<2>("sine"), straight).status, "ok");
}

TEST(CurvedCells, RefuseTiedNodes) {
  const auto linear = unit_square(3, Cells::quadrilaterals, 0.0);
  const auto mesh = second_order(linear, true);
  auto options = exact_options(1);
  options.ties = std::make_shared<const NodeTies>(periodic_in_x(linear));
  EXPECT_THAT([&] { PoissonSolver<2>(&mesh, options); },
              ThrowsMessage<InputError>(HasSubstr("geometry = straight")));
  options.geometry = Geometry::straight;
  EXPECT_NO_THROW(PoissonSolver<2>(&mesh, options));
}

}  // namespace
}  // namespace smoothfem
