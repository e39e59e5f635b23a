// deal.II's own path through FEValues as the oracle of the assembly kernel.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/full_matrix.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fem/assembly.h"
#include "fem/reference_element.h"
#include "fem/tests/unit_square.h"

namespace smoothfem {
namespace {

struct Oracle {
  std::vector<Point<2>> points;                ///< of the dofs
  dealii::FullMatrix<double> stiffness, mass;  ///< over all dofs
};

Oracle assemble_by_fe_values(const PlanarMesh& mesh, bool triangles, unsigned int degree) {
  std::vector<dealii::Point<2>> vertices;
  for (const auto& p : mesh.coordinates()) vertices.emplace_back(p.x(), p.y());
  std::vector<dealii::CellData<2>> cells;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = mesh.topology().cell_nodes(c);
    dealii::CellData<2> cell(static_cast<unsigned int>(nodes.size()));
    for (std::size_t k = 0; k < nodes.size(); ++k)
      cell.vertices[triangles ? k : (k < 2 ? k : 5 - k)] = nodes[k];
    cells.push_back(cell);
  }
  dealii::Triangulation<2> triangulation;
  triangulation.create_triangulation(vertices, cells, dealii::SubCellData());

  std::unique_ptr<dealii::FiniteElement<2>> element, geometry;
  dealii::Quadrature<2> rule;
  if (triangles) {
    element = std::make_unique<dealii::FE_SimplexP<2>>(degree);
    geometry = std::make_unique<dealii::FE_SimplexP<2>>(1);
    rule = dealii::QGaussSimplex<2>(4);
  } else {
    element = std::make_unique<dealii::FE_Q<2>>(degree);
    geometry = std::make_unique<dealii::FE_Q<2>>(1);
    rule = dealii::QGauss<2>(8);
  }
  const dealii::MappingFE<2> mapping(*geometry);
  dealii::DoFHandler<2> dofs(triangulation);
  dofs.distribute_dofs(*element);
  std::vector<dealii::Point<2>> places(dofs.n_dofs());
  dealii::DoFTools::map_dofs_to_support_points(mapping, dofs, places);

  Oracle oracle;
  for (const auto& p : places) oracle.points.emplace_back(p[0], p[1]);
  oracle.stiffness.reinit(dofs.n_dofs(), dofs.n_dofs());
  oracle.mass.reinit(dofs.n_dofs(), dofs.n_dofs());
  dealii::FEValues<2> values(
      mapping, *element, rule,
      dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
  std::vector<dealii::types::global_dof_index> indices(element->n_dofs_per_cell());
  for (const auto& cell : dofs.active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(indices);
    for (unsigned int q = 0; q < rule.size(); ++q)
      for (unsigned int i = 0; i < indices.size(); ++i)
        for (unsigned int j = 0; j < indices.size(); ++j) {
          oracle.stiffness(indices[i], indices[j]) +=
              values.shape_grad(i, q) * values.shape_grad(j, q) * values.JxW(q);
          oracle.mass(indices[i], indices[j]) +=
              values.shape_value(i, q) * values.shape_value(j, q) * values.JxW(q);
        }
  }
  return oracle;
}

class AssemblyTest : public testing::TestWithParam<std::tuple<bool, int>> {};

INSTANTIATE_TEST_SUITE_P(Elements, AssemblyTest,
                         testing::Combine(testing::Bool(), testing::Values(1, 2)));

TEST_P(AssemblyTest, MatrixAndLoadAgreeWithFEValues) {
  const auto [triangles, degree] = GetParam();
  const auto mesh = unit_square(4, triangles ? Cells::triangles : Cells::quadrilaterals, 0.3);
  const auto space = make_finite_element_space(mesh, degree, 8);
  const auto& solution = manufactured_solution("gear");
  PoissonSystem system = make_system(*space);
  assemble(*space, mesh.coordinates(), solution, Load::nodal, system);

  const Oracle oracle = assemble_by_fe_values(mesh, triangles, static_cast<unsigned int>(degree));
  const auto points = space->dof_points(mesh.coordinates());
  ASSERT_EQ(oracle.points.size(), points.size());
  std::vector<unsigned int> same(points.size());  // the oracle's dof at the same place
  for (std::size_t i = 0; i < points.size(); ++i)
    for (unsigned int j = 0; j < points.size(); ++j)
      if ((points[i] - oracle.points[j]).norm() < 1e-12) same[i] = j;

  for (std::size_t i = 0; i < space->n_free; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const unsigned int oracle_row = same[space->free_dofs[i]];
    double load = 0.0;
    for (std::size_t dof = 0; dof < space->n_dofs; ++dof) {
      load += oracle.mass(oracle_row, same[dof]) * solution.load(points[dof]);
      const double stiffness = oracle.stiffness(oracle_row, same[dof]);
      if (space->free_number[dof] == FiniteElementSpace::absent)
        load -= stiffness * solution.value(points[dof]);
      else
        EXPECT_NEAR(system.matrix.coeff(row, space->free_number[dof]), stiffness, 1e-13);
    }
    EXPECT_NEAR(system.right_hand_side[row], load, 1e-11);
  }
}

/// integral of x^a y^b over the reference triangle: a! b! / (a + b + 2)!.
double triangle_monomial(int a, int b) {
  return std::tgamma(a + 1) * std::tgamma(b + 1) / std::tgamma(a + b + 3);
}

TEST(ReferenceElement, TriangleRulesIntegrateMonomialsExactly) {
  const auto element = make_reference_element(ElementType::triangle, 1, 8);
  for (const auto& [table, degree] :
       {std::pair(&element.matrices, 5), std::pair(&element.errors, 11)})
    for (int a = 0; a <= degree; ++a)
      for (int b = 0; a + b <= degree; ++b) {
        double sum = 0.0;
        for (std::size_t q = 0; q < table->n_points; ++q)
          sum += table->weights[q] * std::pow(table->geometry[3 * q + 1], a) *
                 std::pow(table->geometry[3 * q + 2], b);
        EXPECT_NEAR(sum, triangle_monomial(a, b), 1e-14) << "x^" << a << " y^" << b;
      }
}

TEST(ReferenceElement, ShapeFunctionsAddUpToOneAndAreOneAtTheirOwnDof) {
  for (const auto type : {ElementType::triangle, ElementType::quadrilateral})
    for (const int degree : {1, 2}) {
      const auto element = make_reference_element(type, degree, 8);
      for (const auto* table : {&element.matrices, &element.errors})
        for (std::size_t q = 0; q < table->n_points; ++q) {
          double sum = 0.0, dx = 0.0;
          for (std::size_t i = 0; i < element.n_dofs; ++i) {
            sum += table->shape[q * element.n_dofs + i];
            dx += table->shape_gradient[2 * (q * element.n_dofs + i)];
          }
          EXPECT_NEAR(sum, 1.0, 1e-14);
          EXPECT_NEAR(dx, 0.0, 1e-13);
        }
    }
}

}  // namespace
}  // namespace smoothfem
