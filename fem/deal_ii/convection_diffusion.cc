// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/solver_gmres.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_ilu.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fem/deal_ii/kelly.h"
#include "fem/deal_ii/lagrange_space.h"
#include "fem/deal_ii/solution_functions.h"
#include "fem/deal_ii/triangulation_solver.h"
#include "fem/solutions/displacement.h"
#include "smoothing/base/scoped_timer.h"

namespace smoothfem {
namespace {

/// -eps laplace(u) + b . grad u = f with the study's u on the boundary; by Galerkin's method, or
/// with streamline diffusion (SUPG) of Brooks and Hughes 1982.
template <int dim>
class ConvectionDiffusion final : public TriangulationSolver<dim> {
 public:
  SolverTraits traits() const override {
    return {.degrees = {1, 2},
            .needs_mpi = true,
            .needs_solution = true,
            .takes_ties = true,
            .has_indicators = true};
  }

  Parameters parameters() override {
    return {{"diffusion", "eps", &eps_, 0.0, std::numeric_limits<double>::infinity(), true},
            {"velocity", "b as formulas 'b_x ; b_y' (and '; b_z')", &velocity_text_},
            {"stabilization", "of the convection: supg or none",
             Choice{&stabilization_, {"supg", "none"}}},
            {"gmres_tolerance", "tolerance for |r| / |b|", &gmres_tolerance_, 0.0, 1.0, true},
            {"points", "Gauss points per direction on cells that are not simplices; 0: degree + 4",
             &points_, 0.0, 20.0}};
  }

  void check_parameters() const override {
    if (velocity_text_.empty())
      throw InputError("convection-diffusion needs a velocity, such as 'set velocity = 1 ; 0'");
    (void)VectorFormula<dim>("velocity", velocity_text_);
  }

  std::vector<NumberDescription> numbers() const override {
    return {
        {"n_dofs", "", "Number of degrees of freedom."},
        {"l2_error", "", "Error in the L2 norm, by quadrature."},
        {"h1_error", "", "Error in the H1 norm, by quadrature."},
        {"overshoot", "",
         "Largest amount by which a nodal value is outside the range of u at all nodes."},
        {"peclet_max", "", "Largest Peclet number |b| h / (2 eps) of a cell."},
        {"gmres_iterations", "", "Iterations of GMRES(100) with an incomplete LU factorization."},
        {"gmres_seconds", "s", "Time of GMRES."}};
  }

  void use_solution(const ManufacturedSolution<dim>& solution) override {
    if (solution.diffusivity || !solution.material_of_kind.empty())
      throw InputError(
          "convection-diffusion has its own diffusion; leave the solution's diffusivity out");
    solution_ = solution;
  }

 protected:
  void setup(const Mesh<dim>& /*mesh*/, const dealii::Triangulation<dim>& triangulation,
             unsigned int degree) override {
    velocity_.emplace("velocity", velocity_text_);
    space_ = std::make_unique<LagrangeSpace<dim>>(triangulation, degree, 1,
                                                  static_cast<unsigned int>(points_), this->ties());
    dealii::DynamicSparsityPattern pattern(space_->dofs.n_dofs());
    dealii::DoFTools::make_sparsity_pattern(space_->dofs, pattern,
                                            boundary_values(*space_, solution_), false);
    matrix_.clear();
    pattern_.copy_from(pattern);
    matrix_.reinit(pattern_);
    load_.reinit(space_->dofs.n_dofs());
  }

  SolverResult solve(const dealii::Triangulation<dim>& /*triangulation*/) override {
    const auto constraints = boundary_values(*space_, solution_);
    const double peclet = assemble(constraints);
    const auto u = solution_of_system(constraints);
    const auto error = [&](dealii::VectorTools::NormType norm) {
      return error_of(u, *space_, solution_, norm);
    };
    SolverResult result{.numbers = {{"n_dofs", static_cast<double>(u.size())},
                                    {"l2_error", error(dealii::VectorTools::L2_norm)},
                                    {"h1_error", error(dealii::VectorTools::H1_norm)},
                                    {"overshoot", overshoot(u)},
                                    {"peclet_max", peclet}}};
    run_gmres(result);
    return result;
  }

  dealii::Vector<float> indicators(const dealii::Triangulation<dim>& /*triangulation*/) override {
    const auto constraints = boundary_values(*space_, solution_);
    assemble(constraints);
    return kelly_means(*space_, solution_of_system(constraints));
  }

 private:
  dealii::Vector<double> solution_of_system(
      const dealii::AffineConstraints<double>& constraints) const {
    dealii::SparseDirectUMFPACK factors;
    factors.initialize(matrix_);
    dealii::Vector<double> u(load_.size());
    factors.vmult(u, load_);
    constraints.distribute(u);
    return u;
  }

  /// Returns the extent of a cell in the direction of a vector.
  template <class Cell>
  static double extent(const Cell& cell, const dealii::Tensor<1, dim>& direction) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const unsigned int v : cell->vertex_indices()) {
      const double along = direction * cell->vertex(v);
      low = std::min(low, along);
      high = std::max(high, along);
    }
    return (high - low) / direction.norm();
  }

  /// Returns the largest Peclet number.
  double assemble(const dealii::AffineConstraints<double>& constraints) {
    matrix_ = 0.0;
    load_ = 0.0;
    double largest = 0.0;
    const auto integrate = [&](const dealii::FEValues<dim>& values, const auto& cell,
                               dealii::FullMatrix<double>& cell_matrix,
                               dealii::Vector<double>& cell_load) {
      for (const unsigned int q : values.quadrature_point_indices())
        largest = std::max(largest, add_point(values, cell, q, cell_matrix, cell_load));
    };
    space_->add_integrals(integrate, constraints, matrix_, load_, dealii::update_hessians);
    return largest;
  }

  /// Adds (eps grad u, grad v) + (b . grad u, v) and, with SUPG, tau (-eps laplace(u) + b . grad u,
  /// b . grad v) at a point, and the same of f. Returns the Peclet number.
  template <class Cell>
  double add_point(const dealii::FEValues<dim>& values, const Cell& cell, unsigned int q,
                   dealii::FullMatrix<double>& cell_matrix,
                   dealii::Vector<double>& cell_load) const {
    const Point<dim> p = point_from(values.quadrature_point(q));
    dealii::Tensor<1, dim> b;
    const auto given = velocity_->at(p);
    for (int d = 0; d < dim; ++d) b[d] = given[d];
    const double f = eps_ * solution_.load(p) + given.dot(solution_.value_and_gradient(p).gradient);
    const double size = b.norm();
    double peclet = 0.0, tau = 0.0;
    if (size > 0.0) {
      const double h = extent(cell, b) / cell->get_fe().degree;
      peclet = size * h / (2.0 * eps_);
      if (stabilization_ == 0) tau = h / (2.0 * size) * upwinding(peclet);
    }
    const double weight = values.JxW(q);
    for (const unsigned int i : values.dof_indices()) {
      const double test = values.shape_value(i, q) + tau * (b * values.shape_grad(i, q));
      for (const unsigned int j : values.dof_indices()) {
        const double along = b * values.shape_grad(j, q);
        const double residual = along - eps_ * dealii::trace(values.shape_hessian(j, q));
        cell_matrix(i, j) += weight * (eps_ * (values.shape_grad(i, q) * values.shape_grad(j, q)) +
                                       along * values.shape_value(i, q) +
                                       tau * (b * values.shape_grad(i, q)) * residual);
      }
      cell_load(i) += weight * test * f;
    }
    return peclet;
  }

  /// Returns coth(Pe) - 1/Pe, with which linear elements are exact at the nodes in one dimension.
  static double upwinding(double peclet) {
    constexpr double small = 1e-3;
    return peclet < small ? peclet / 3.0 : 1.0 / std::tanh(peclet) - 1.0 / peclet;
  }

  double overshoot(const dealii::Vector<double>& u) const {
    double low = std::numeric_limits<double>::infinity(), high = -low, beyond = 0.0;
    for (const auto& [dof, p] : space_->support_points()) {
      const double exact = solution_.value(point_from(p));
      low = std::min(low, exact);
      high = std::max(high, exact);
    }
    for (const double value : u) beyond = std::max({beyond, low - value, value - high});
    return beyond;
  }

  void run_gmres(SolverResult& result) {
    constexpr unsigned int restart = 100, most_iterations = 2000;
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double seconds = 0.0, iterations = unknown;
    try {
      const ScopedTimer timer(seconds);
      dealii::SparseILU<double> ilu;
      ilu.initialize(matrix_);
      dealii::SolverControl control(most_iterations, gmres_tolerance_ * load_.l2_norm());
      using Gmres = dealii::SolverGMRES<dealii::Vector<double>>;
      dealii::Vector<double> u(load_.size());
      Gmres(control, typename Gmres::AdditionalData(restart + 2)).solve(matrix_, u, load_, ilu);
      iterations = control.last_step();
    } catch (const dealii::SolverControl::NoConvergence&) {
      result.status = "gmres not converged";
    }
    result.numbers.push_back({"gmres_iterations", iterations});
    result.numbers.push_back({"gmres_seconds", std::isnan(iterations) ? unknown : seconds});
  }

  double eps_ = 1.0, gmres_tolerance_ = 1e-8;
  std::string velocity_text_;
  int stabilization_ = 0, points_ = 0;
  ManufacturedSolution<dim> solution_;
  std::optional<VectorFormula<dim>> velocity_;
  std::unique_ptr<LagrangeSpace<dim>> space_;
  dealii::SparsityPattern pattern_;
  dealii::SparseMatrix<double> matrix_;
  dealii::Vector<double> load_;
};

const RegisteredSolver registered_convection_diffusion(
    {.name = "convection-diffusion",
     .title = "Convection-diffusion",
     .description = "-eps laplace(u) + b . grad u = f with the study's u on the boundary, by "
                    "Galerkin's method or with streamline diffusion (SUPG)",
     .source = "Brooks, Hughes 1982; deal.II's tutorial program step-9"},
    solver_in_plane_and_space<ConvectionDiffusion>());

}  // namespace
}  // namespace smoothfem
