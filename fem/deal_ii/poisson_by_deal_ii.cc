// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "fem/deal_ii/kelly.h"
#include "fem/deal_ii/lagrange_space.h"
#include "fem/deal_ii/solution_functions.h"
#include "fem/deal_ii/symmetric_system.h"
#include "fem/deal_ii/triangulation_solver.h"

namespace smoothfem {
namespace {

using dealii::VectorTools::NormType;

/// -div(A grad u) = f with u given on the whole boundary, as deal.II's tutorials solve it: step-4
/// with the formulas of a study.
template <int dim>
class PoissonByDealII final : public TriangulationSolver<dim> {
 public:
  SolverTraits traits() const override {
    return {.degrees = {1, 2, 3, 4},
            .needs_mpi = true,
            .needs_solution = true,
            .takes_ties = true,
            .takes_ranks = true,
            .has_indicators = true};
  }

  Parameters parameters() override {
    return {{"cg_tolerance", "tolerance for |r| / |b|", &cg_tolerance_, 0.0, 1.0, true},
            {"points", "Gauss points per direction on cells that are not simplices; 0: degree + 4",
             &points_, 0.0, 20.0}};
  }

  std::vector<NumberDescription> numbers() const override {
    auto all = SymmetricSystem::descriptions();
    all.push_back({"l2_error", "", "Error in the L2 norm, by quadrature."});
    all.push_back({"h1_error", "", "Error in the H1 norm, by quadrature."});
    all.push_back(
        {"kelly_estimate", "",
         "Square root of the sum of the squares of deal.II's Kelly error indicators, "
         "of -laplace(u) = f (meshes of one type of cells, not of pyramids and prisms)."});
    return all;
  }

  void use_solution(const ManufacturedSolution<dim>& solution) override {
    if (!solution.material_of_kind.empty())
      throw InputError(
          "the solver deal.II has no diffusivity of groups of cells; give it as a formula of the "
          "position");
    solution_ = solution;
  }

 protected:
  void setup(const Mesh<dim>& /*mesh*/, const dealii::Triangulation<dim>& triangulation,
             unsigned int degree) override {
    space_ = std::make_unique<LagrangeSpace<dim>>(triangulation, degree, 1,
                                                  static_cast<unsigned int>(points_), this->ties());
    system_ = std::make_unique<SymmetricSystem>(*space_, boundary_values(*space_, solution_));
  }

  SolverResult solve(const dealii::Triangulation<dim>& /*triangulation*/) override {
    const auto constraints = boundary_values(*space_, solution_);
    assemble(constraints);
    SolverResult result{.numbers = system_->solve(constraints, {}, cg_tolerance_)};
    const auto error = [&](NormType norm) {
      return error_of(system_->solution, *space_, solution_, norm);
    };
    result.numbers.push_back({"l2_error", error(NormType::L2_norm)});
    result.numbers.push_back({"h1_error", error(NormType::H1_norm)});
    if (has_kelly(*space_) && !solution_.diffusivity)
      result.numbers.push_back(
          {"kelly_estimate", kelly_estimate(*space_, system_->solution, this->ranks())});
    return result;
  }

  dealii::Vector<float> indicators(const dealii::Triangulation<dim>& /*triangulation*/) override {
    const auto constraints = boundary_values(*space_, solution_);
    assemble(constraints);
    system_->solve_accurately(constraints, {});
    return kelly_means(*space_, system_->solution);
  }

 private:
  void assemble(const dealii::AffineConstraints<double>& constraints) {
    system_->assemble(
        *space_, constraints,
        [&](const dealii::FEValues<dim>& values, const auto& /*cell*/,
            dealii::FullMatrix<double>& cell_matrix, dealii::Vector<double>& cell_load) {
          for (const unsigned int q : values.quadrature_point_indices()) {
            const Point<dim> p = point_from(values.quadrature_point(q));
            const auto a = diffusivity_at(p);
            const double f = solution_.load(p);
            for (const unsigned int i : values.dof_indices()) {
              const auto flux = a * values.shape_grad(i, q);
              for (const unsigned int j : values.dof_indices())
                cell_matrix(i, j) += flux * values.shape_grad(j, q) * values.JxW(q);
              cell_load(i) += values.shape_value(i, q) * f * values.JxW(q);
            }
          }
        });
  }

  dealii::Tensor<2, dim> diffusivity_at(const Point<dim>& p) const {
    dealii::Tensor<2, dim> a;
    if (!solution_.diffusivity) return dealii::unit_symmetric_tensor<dim>();
    const auto given = solution_.diffusivity(p);
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) a[i][j] = given(i, j);
    return a;
  }

  double cg_tolerance_ = 1e-8;
  int points_ = 0;
  ManufacturedSolution<dim> solution_;
  std::unique_ptr<LagrangeSpace<dim>> space_;
  std::unique_ptr<SymmetricSystem> system_;
};

const RegisteredSolver registered_poisson(
    {.name = "deal.II",
     .title = "deal.II",
     .description = "the study's problem -div(A grad u) = f with u on the boundary, by deal.II's "
                    "DoFHandler, FEValues, AffineConstraints and SolverCG",
     .source = "deal.II's tutorial program step-4"},
    solver_in_plane_and_space<PoissonByDealII>());

}  // namespace
}  // namespace smoothfem
