// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/adaptivity/energy_solver.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "fem/adaptivity/energy.h"
#include "fem/assembly/assembly.h"
#include "fem/linear_algebra/conjugate_gradients.h"
#include "fem/linear_algebra/trilinos_matrix.h"
#include "fem/space/natural_load.h"

namespace smoothfem {

namespace {

/// One rule for all cells of a type, so that J and its gradient belong to one function.
constexpr TensorPoints tensor_points{.quadrilateral = 5, .hexahedron = 4};

/// Solves systems with matrices of one pattern. Collective.
class LinearSolver {
 public:
  template <int dim>
  LinearSolver(const FiniteElementSpace<dim>& space, const SparseMatrix& matrix)
      : n_free_(space.n_free) {
    // For so few rows in space, factorization is faster than multigrid.
    constexpr std::size_t few = 3000;
    const bool is_small = space.n_free < few;
    if (space.ranks.size() == 1 && (dim == 2 || is_small)) {
      cholesky_ = std::make_unique<Cholesky>();
      cholesky_->analyzePattern(matrix);
      return;
    }
    sliced_ = std::make_unique<SlicedMatrix>(matrix, space.ranks, space.halo);
    if (!is_small) multigrid_ = std::make_unique<TrilinosMatrix>(space);
  }

  /// Returns true if there is a solution. x gets this rank's columns.
  bool solve(const SparseMatrix& matrix, const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    if (cholesky_) {
      cholesky_->factorize(matrix);
      if (cholesky_->info() != Eigen::Success) return false;
      x = cholesky_->solve(b);
      return true;
    }
    sliced_->set_values(matrix);
    if (multigrid_) {
      multigrid_->set_values(matrix);
      multigrid_->set_up_multigrid();
    }
    constexpr double tolerance = 1e-9;  // the energy has its square as error
    const auto cg = conjugate_gradients(
        *sliced_, b, x,
        {.tolerance = tolerance, .max_iterations = 10 * n_free_, .stop_if_indefinite = true},
        preconditioner());
    return cg.end == ConjugateGradientsEnd::converged;
  }

 private:
  using Cholesky = Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>;

  Preconditioner preconditioner() const {
    if (!multigrid_) return jacobi_preconditioner(*sliced_);
    return
        [this](const Eigen::VectorXd& r, Eigen::VectorXd& z) { multigrid_->apply_multigrid(r, z); };
  }

  std::size_t n_free_;
  std::unique_ptr<Cholesky> cholesky_;
  std::unique_ptr<SlicedMatrix> sliced_;
  std::unique_ptr<TrilinosMatrix> multigrid_;
};

/// Gathers functions of several ranks on the root, which then has a second copy of the mesh,
/// undivided. Dofs are identified by the nodes whose mean is their position. All calls are
/// collective.
template <int dim>
class GatheredSpace {
 public:
  /// mesh: on the root.
  GatheredSpace(const std::optional<Mesh<dim>>& mesh, const FiniteElementSpace<dim>& part,
                const std::vector<std::string>& natural_groups)
      : part_(part) {
    // Numbers of nodes of each of this rank's dofs, each followed by these nodes.
    std::vector<NodeIndex> nodes;
    for_each_own_dof([&](std::size_t dof) {
      const auto of_dof = sorted_nodes(part, dof);
      nodes.push_back(static_cast<NodeIndex>(of_dof.size()));
      nodes.insert(nodes.end(), of_dof.begin(), of_dof.end());
    });
    const auto of_ranks = part.ranks.gather(nodes);
    if (!mesh) return;
    space_ = make_finite_element_space(&*mesh, part.degree, tensor_points, {}, natural_groups,
                                       nullptr, Geometry::straight);
    std::map<std::vector<NodeIndex>, std::uint32_t> dofs;
    for (std::uint32_t dof = 0; dof < space_->n_local; ++dof)
      dofs[sorted_nodes(*space_, dof)] = dof;
    for (auto next = of_ranks.begin(); next != of_ranks.end();) {
      const auto first = next + 1;
      next = first + *next;
      dofs_.push_back(dofs.at({first, next}));
    }
  }

  /// u: at the part's dofs. coordinates: of the mesh, on the root.
  GatheredFunction<dim> function(const std::vector<Point<dim>>& coordinates,
                                 const Eigen::VectorXd& u) {
    std::vector<double> values;
    for_each_own_dof([&](std::size_t dof) { values.push_back(u[static_cast<Eigen::Index>(dof)]); });
    const auto of_ranks = part_.ranks.gather(values);
    if (!space_) return {part_, x_, u_};
    x_ = space_->local_coordinates(coordinates);
    u_.resize(static_cast<Eigen::Index>(space_->n_local));
    for (std::size_t k = 0; k < of_ranks.size(); ++k) u_[dofs_[k]] = of_ranks[k];
    return {*space_, x_, u_};
  }

 private:
  template <class Visit>
  void for_each_own_dof(const Visit& visit) const {
    for (std::size_t dof = 0; dof < part_.n_own; ++dof) visit(dof);
    for (std::size_t dof = 0; dof < part_.n_own_boundary; ++dof) visit(part_.n_columns + dof);
  }

  /// Returns the nodes by their numbers in the mesh.
  static std::vector<NodeIndex> sorted_nodes(const FiniteElementSpace<dim>& space,
                                             std::size_t dof) {
    std::vector<NodeIndex> nodes;
    for (const NodeIndex node : space.dof_nodes[dof]) nodes.push_back(space.nodes[node]);
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }

  const FiniteElementSpace<dim>& part_;
  std::shared_ptr<const FiniteElementSpace<dim>> space_;  ///< on the root
  std::vector<std::uint32_t> dofs_;                       ///< the root's dof of each gathered one
  std::vector<Point<dim>> x_;
  Eigen::VectorXd u_;
};

/// The solver of this process, or this rank's part of one.
template <int dim>
class RankEnergySolver final : public EnergySolver<dim> {
 public:
  RankEnergySolver(const Mesh<dim>* mesh, int degree, const ManufacturedSolution<dim>& solution,
                   const std::vector<std::string>& natural_groups, const Ranks& ranks)
      : solution_(solution),
        natural_groups_(natural_groups),
        space_(make_finite_element_space(mesh, degree, tensor_points, ranks, natural_groups,
                                         nullptr, Geometry::straight)),
        energy_(space_, solution),
        system_(make_system(*space_)),
        linear_(*space_, system_.matrix) {
    if (mesh != nullptr && ranks.size() > 1) mesh_ = *mesh;
  }

  double solve(std::span<const Point<dim>> coordinates) override {
    coordinates_.assign(coordinates.begin(), coordinates.end());
    x_ = space_->local_coordinates(coordinates_);
    assemble(*space_, x_, solution_, Load::none, system_);
    constexpr double none = std::numeric_limits<double>::infinity();
    if (space_->ranks.sum(system_.n_folded_cells) > 0) return none;
    energy_.integrate_load(x_);
    energy_.add_load(system_.right_hand_side);
    Eigen::VectorXd free_values;
    if (!linear_.solve(system_.matrix, system_.right_hand_side, free_values)) return none;
    u_ = system_.exact;  // its boundary values stay
    u_.head(free_values.size()) = free_values;
    return energy();
  }

  std::vector<Point<dim>> gradient() override {
    const auto of_ranks = space_->ranks.gather(energy_.gradient(x_, u_));
    std::vector<Point<dim>> gradient(coordinates_.size(), Point<dim>::Zero());
    for (std::size_t k = 0; k < of_ranks.size(); ++k)
      gradient[space_->nodes_of_ranks[k]] += of_ranks[k];
    return gradient;
  }

  GatheredFunction<dim> function() override {
    if (space_->ranks.size() == 1) return {*space_, x_, u_};
    if (!gathered_)
      gathered_ = std::make_unique<GatheredSpace<dim>>(mesh_, *space_, natural_groups_);
    return gathered_->function(coordinates_, u_);
  }

 private:
  double energy() const {
    const auto& ranks = space_->ranks;
    const auto boundary = u_.segment(static_cast<Eigen::Index>(space_->n_columns),
                                     static_cast<Eigen::Index>(space_->n_own_boundary));
    const double mean =
        ranks.sum(boundary.sum()) / static_cast<double>(ranks.sum(space_->n_own_boundary));
    double part = energy_.value(x_, u_, mean);
    if (!space_->natural_facets.empty()) {
      const auto n_own = static_cast<Eigen::Index>(space_->n_own);
      Eigen::VectorXd natural = Eigen::VectorXd::Zero(n_own);
      add_natural_load(*space_, x_, solution_, {}, natural);
      part -= 2.0 * natural.dot(u_.head(n_own));
    }
    return ranks.sum(part);
  }

  const ManufacturedSolution<dim>& solution_;
  const std::vector<std::string> natural_groups_;
  std::optional<Mesh<dim>> mesh_;  ///< on the root of several ranks
  const std::shared_ptr<const FiniteElementSpace<dim>> space_;
  Energy<dim> energy_;
  PoissonSystem system_;
  LinearSolver linear_;
  std::vector<Point<dim>> coordinates_, x_;  ///< of the last solve: of the mesh and of the space
  Eigen::VectorXd u_;                        ///< at the dofs
  std::unique_ptr<GatheredSpace<dim>> gathered_;  ///< made at its first use
};

}  // namespace

template <int dim>
std::unique_ptr<EnergySolver<dim>> make_energy_solver(
    const Mesh<dim>* mesh, int degree, const ManufacturedSolution<dim>& solution,
    const std::vector<std::string>& natural_groups, const Ranks& ranks) {
  return std::make_unique<RankEnergySolver<dim>>(mesh, degree, solution, natural_groups, ranks);
}

#define SMOOTHFEM_INSTANTIATE(dim)                                                              \
  template std::unique_ptr<EnergySolver<dim>> make_energy_solver(                               \
      const Mesh<dim>*, int, const ManufacturedSolution<dim>&, const std::vector<std::string>&, \
      const Ranks&);
SMOOTHFEM_INSTANTIATE(2)
SMOOTHFEM_INSTANTIATE(3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
