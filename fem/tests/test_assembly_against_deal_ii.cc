// SPDX-License-Identifier: GPL-3.0-or-later
// deal.II's own path through FEValues as the oracle of the kernels for matrices, loads and norms.
#include <deal.II/lac/full_matrix.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fem/assembly/assembly.h"
#include "fem/assembly/error_norms.h"
#include "fem/elements/reference_element.h"
#include "fem/tests/fe_values_oracle.h"
#include "fem/tests/second_order.h"

namespace smoothfem {
namespace {

/// The oracle's dof at the same point as each dof of smoothfem.
template <int dim>
std::vector<unsigned int> same_dofs(const Oracle<dim>& oracle,
                                    const std::vector<Point<dim>>& points) {
  const auto oracle_points = oracle.dof_points();
  EXPECT_EQ(oracle_points.size(), points.size());
  std::vector<unsigned int> same;
  for (const auto& p : points)
    for (unsigned int j = 0; j < oracle_points.size(); ++j)
      if ((p - oracle_points[j]).norm() < 1e-12) same.push_back(j);
  EXPECT_EQ(same.size(), points.size());
  return same;
}

class AgainstFEValuesTest : public testing::TestWithParam<Case> {};

std::vector<Case> cases_of_one_type() {
  auto cases = all_cases();
  std::erase_if(
      cases, [](const Case& c) { return c.cells == Cells::mixed || c.cells > Cells::hexahedra; });
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Elements, AgainstFEValuesTest, testing::ValuesIn(cases_of_one_type()),
                         [](const auto& info) { return name_of(info.param); });

/// Stiffness and mass matrix over all dofs.
template <int dim>
std::array<dealii::FullMatrix<double>, 2> matrices_of(const Oracle<dim>& oracle) {
  const unsigned int n = oracle.dofs().n_dofs();
  dealii::FullMatrix<double> stiffness(n, n), mass(n, n);
  oracle.for_each_cell([&](const auto& values, const auto& indices) {
    for (const unsigned int q : values.quadrature_point_indices())
      for (const unsigned int i : values.dof_indices())
        for (const unsigned int j : values.dof_indices()) {
          stiffness(indices[i], indices[j]) +=
              values.shape_grad(i, q) * values.shape_grad(j, q) * values.JxW(q);
          mass(indices[i], indices[j]) +=
              values.shape_value(i, q) * values.shape_value(j, q) * values.JxW(q);
        }
  });
  return {stiffness, mass};
}

TEST_P(AgainstFEValuesTest, MatrixAndLoadAgree) {
  const auto check = [&]<int dim>(const Mesh<dim>& mesh) {
    const auto space =
        make_finite_element_space(&mesh, GetParam().degree, TensorPoints{.hexahedron = 4});
    const auto& solution = manufactured_solution<dim>(dim == 2 ? "gear" : "volume");
    PoissonSystem system = make_system(*space);
    assemble(*space, mesh.copied_coordinates(), solution, Load::nodal, system);

    const Oracle<dim> oracle(mesh, static_cast<unsigned int>(GetParam().degree));
    const auto [stiffness, mass] = matrices_of(oracle);
    const auto points = space->dof_points(mesh.copied_coordinates());
    const auto same = same_dofs(oracle, points);
    ASSERT_EQ(space->n_own, space->n_free);
    for (std::size_t i = 0; i < space->n_free; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      double load = 0.0;
      for (std::size_t dof = 0; dof < space->n_dofs; ++dof) {
        load += mass(same[i], same[dof]) * solution.load(points[dof]);
        const double entry = stiffness(same[i], same[dof]);
        if (dof >= space->n_free)
          load -= entry * solution.value(points[dof]);
        else
          EXPECT_NEAR(system.matrix.coeff(row, static_cast<Eigen::Index>(dof)), entry, 1e-13);
      }
      EXPECT_NEAR(system.right_hand_side[row], load, 1e-11);
    }
  };
  GetParam().on_mesh(4, 3, 0.3, check);
}

TEST_P(AgainstFEValuesTest, LoadByQuadratureAgrees) {
  const auto check = [&]<int dim>(const Mesh<dim>& mesh) {
    const auto space =
        make_finite_element_space(&mesh, GetParam().degree, TensorPoints{.hexahedron = 4});
    // Without boundary values, and with a load that the rules of both sides integrate exactly.
    const ManufacturedSolution<dim> solution{
        .name = "load alone",
        .formula = "",
        .source = "",
        .value = [](const Point<dim>&) { return 0.0; },
        .value_and_gradient = {},
        .load = [](const Point<dim>& p) { return 1.0 + p.x() - 2.0 * p[dim - 1]; }};
    PoissonSystem system = make_system(*space);
    assemble(*space, mesh.copied_coordinates(), solution, Load::quadrature, system);

    const Oracle<dim> oracle(mesh, static_cast<unsigned int>(GetParam().degree));
    const auto positions = oracle.dof_points();
    dealii::Vector<double> load(oracle.dofs().n_dofs());
    oracle.for_each_cell([&](const auto& values, const auto& indices) {
      for (const unsigned int q : values.quadrature_point_indices())
        for (const unsigned int i : values.dof_indices()) {
          double f = 0.0;  // linear, so equal to its interpolant
          for (const unsigned int j : values.dof_indices())
            f += values.shape_value(j, q) * solution.load(positions[indices[j]]);
          load[indices[i]] += f * values.shape_value(i, q) * values.JxW(q);
        }
    });
    const auto same = same_dofs(oracle, space->dof_points(mesh.copied_coordinates()));
    for (std::size_t i = 0; i < space->n_free; ++i)
      EXPECT_NEAR(system.right_hand_side[static_cast<Eigen::Index>(i)], load[same[i]], 1e-14);
  };
  GetParam().on_mesh(4, 3, 0.3, check);
}

TEST_P(AgainstFEValuesTest, NormsAgreeWithIntegrateDifference) {
  const auto check = [&]<int dim>(const Mesh<dim>& mesh) {
    const auto space =
        make_finite_element_space(&mesh, GetParam().degree, TensorPoints{.hexahedron = 4});
    const auto& solution = manufactured_solution<dim>("sine");
    const auto points = space->dof_points(mesh.copied_coordinates());
    const auto n = static_cast<Eigen::Index>(points.size());
    Eigen::VectorXd exact(n), discrete(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      exact[i] = solution.value(points[static_cast<std::size_t>(i)]);
      discrete[i] = exact[i] + 0.1 * std::cos(7.0 * static_cast<double>(i));
    }
    const auto norms = error_norms(*space, mesh.copied_coordinates(), solution, exact, discrete);

    const Oracle<dim> oracle(mesh, static_cast<unsigned int>(GetParam().degree));
    const auto same = same_dofs(oracle, points);
    dealii::Vector<double> u_h(same.size()), difference(same.size());
    for (Eigen::Index i = 0; i < n; ++i) {
      u_h[same[static_cast<std::size_t>(i)]] = discrete[i];
      difference[same[static_cast<std::size_t>(i)]] = exact[i] - discrete[i];
    }
    const ManufacturedSolution<dim> zero{
        .name = "zero",
        .formula = "",
        .source = "",
        .value = [](const Point<dim>&) { return 0.0; },
        .value_and_gradient = [](const Point<dim>&) -> ValueAndGradient<dim> {
          return {0.0, Point<dim>::Zero()};
        },
        .load = {}};
    using dealii::VectorTools::H1_norm;
    using dealii::VectorTools::L2_norm;
    EXPECT_NEAR(norms.l2_error / oracle.error(solution, u_h, L2_norm), 1.0, 1e-12);
    EXPECT_NEAR(norms.h1_error / oracle.error(solution, u_h, H1_norm), 1.0, 1e-12);
    EXPECT_NEAR(norms.e_l2 / oracle.error(zero, difference, L2_norm), 1.0, 1e-12);
    EXPECT_NEAR(norms.e_h1 / oracle.error(zero, difference, H1_norm), 1.0, 1e-12);
    EXPECT_NEAR(
        norms.e_max,
        (exact - discrete).head(static_cast<Eigen::Index>(space->n_free)).cwiseAbs().maxCoeff(),
        1e-15);
  };
  GetParam().on_mesh(4, 3, 0.3, check);
}

TEST_P(AgainstFEValuesTest, MatrixAndErrorsAgreeOnCurvedCells) {
  const auto check = [&]<int dim>(const Mesh<dim>& linear) {
    const bool simplices = linear.topology().cell_nodes(0).size() == dim + 1;
    const auto mesh = second_order(linear, !simplices, shell_of_unit<dim>);
    const auto space =
        make_finite_element_space(&mesh, GetParam().degree, TensorPoints{.hexahedron = 4});
    const auto x = space->local_coordinates(mesh.coordinates());
    const auto& solution = manufactured_solution<dim>("sine");
    PoissonSystem system = make_system(*space);
    assemble(*space, x, solution, Load::none, system);

    const auto degree = static_cast<unsigned int>(GetParam().degree);
    Oracle<dim> oracle(mesh, degree);
    oracle.use_midside_nodes(mesh);
    // The integrands are rational: both sides need the same rule.
    const auto rule = oracle_rule<dim>(simplices, 2, true);
    const unsigned int n = oracle.dofs().n_dofs();
    dealii::FullMatrix<double> stiffness(n, n);
    oracle.for_each_cell(rule, [&](const auto& values, const auto& indices) {
      for (const unsigned int q : values.quadrature_point_indices())
        for (const unsigned int i : values.dof_indices())
          for (const unsigned int j : values.dof_indices())
            stiffness(indices[i], indices[j]) +=
                values.shape_grad(i, q) * values.shape_grad(j, q) * values.JxW(q);
    });
    const auto points = space->dof_points(x);
    const auto same = same_dofs(oracle, points);
    Eigen::VectorXd u_h(static_cast<Eigen::Index>(points.size()));
    dealii::Vector<double> same_u_h(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      u_h[static_cast<Eigen::Index>(i)] = same_u_h[same[i]] =
          std::cos(7.0 * static_cast<double>(i));
      for (std::size_t j = 0; i < space->n_free && j < space->n_free; ++j)
        EXPECT_NEAR(system.matrix.coeff(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)),
                    stiffness(same[i], same[j]), 1e-12);
    }
    const auto norms = error_norms(*space, x, solution, u_h, u_h);
    EXPECT_NEAR(
        norms.l2_error / oracle.error(solution, same_u_h, dealii::VectorTools::L2_norm, rule), 1.0,
        1e-12);
    EXPECT_NEAR(
        norms.h1_error / oracle.error(solution, same_u_h, dealii::VectorTools::H1_norm, rule), 1.0,
        1e-12);
  };
  GetParam().on_mesh(4, 2, 0.2, check);
}

/// Integral of x^a y^b z^c over the reference simplex: a! b! c! / (a + b + c + dim)!.
double simplex_monomial(int dim, const std::array<int, 3>& powers) {
  double value = 1.0;
  for (const int power : powers) value *= std::tgamma(power + 1);
  return value / std::tgamma(powers[0] + powers[1] + powers[2] + dim + 1);
}

/// Every monomial up to a degree; the rules' points are the values of the linear shape functions.
void expect_exact(const QuadratureTable& table, int dim, int degree) {
  for (int a = 0; a <= degree; ++a)
    for (int b = 0; a + b <= degree; ++b)
      for (int c = 0; c <= (dim == 3 ? degree - a - b : 0); ++c) {
        double sum = 0.0;
        for (std::size_t q = 0; q < table.n_points; ++q) {
          const double* x = &table.geometry[static_cast<std::size_t>(dim + 1) * q];
          sum += table.weights[q] * std::pow(x[1], a) * std::pow(x[2], b) *
                 (dim == 3 ? std::pow(x[3], c) : 1.0);
        }
        EXPECT_NEAR(sum, simplex_monomial(dim, {a, b, c}), 1e-14)
            << "x^" << a << " y^" << b << " z^" << c;
      }
}

TEST(ReferenceElement, SimplexRulesIntegrateMonomialsExactly) {
  for (const int degree : {1, 2}) {
    const auto triangle = make_reference_element(ElementType::triangle, degree, 8);
    expect_exact(triangle.matrices, 2, 5);
    expect_exact(triangle.errors, 2, 11);
    const auto tetrahedron = make_reference_element(ElementType::tetrahedron, degree, 8);
    expect_exact(tetrahedron.matrices, 3, 5);
    expect_exact(tetrahedron.errors, 3, degree == 1 ? 5 : 7);
  }
}

TEST(ReferenceElement, ShapeFunctionsAddUpToOne) {
  for (const auto type : {ElementType::triangle, ElementType::quadrilateral,
                          ElementType::tetrahedron, ElementType::hexahedron})
    for (const int degree : {1, 2}) {
      const auto element = make_reference_element(type, degree, 4);
      const auto dim = static_cast<std::size_t>(dimension_of(type));
      for (const auto* table : {&element.matrices, &element.errors})
        for (std::size_t q = 0; q < table->n_points; ++q) {
          double sum = 0.0;
          std::vector<double> gradient(dim, 0.0);
          for (std::size_t i = 0; i < element.n_dofs; ++i) {
            sum += table->shape[q * element.n_dofs + i];
            for (std::size_t d = 0; d < dim; ++d)
              gradient[d] += table->shape_gradient[dim * (q * element.n_dofs + i) + d];
          }
          EXPECT_NEAR(sum, 1.0, 1e-14);
          for (const double derivative : gradient) EXPECT_NEAR(derivative, 0.0, 1e-13);
        }
    }
}

}  // namespace
}  // namespace smoothfem
