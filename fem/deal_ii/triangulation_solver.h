// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/grid/tria.h>
#include <deal.II/lac/vector.h>

#include <optional>

#include "fem/ranks/ranks.h"
#include "fem/solvers/mesh_solver.h"

namespace smoothfem {

/// A mesh as a triangulation of deal.II: on several ranks, a fully distributed one.
template <int dim>
class TriangulatedMesh {
 public:
  /// Takes the root's mesh; the others' is not used. On one rank, vertices are the nodes, with the
  /// same numbers. On each rank, cells are in the mesh's order. The material id of a cell and the
  /// boundary id of a boundary facet are their tags in the mesh; 0 without a tag. Throws InputError
  /// on all ranks for tags that deal.II does not allow (below 0). Collective.
  TriangulatedMesh(const Mesh<dim>& mesh, const Ranks& ranks);

  /// Moves the vertices to the nodes of the root's mesh, which has the same topology. Collective.
  void move_vertices(const Mesh<dim>& mesh);

  const dealii::Triangulation<dim>& triangulation() const { return *triangulation_; }

 private:
  Ranks ranks_;
  std::unique_ptr<dealii::Triangulation<dim>> triangulation_;
  /// On the root: the nodes of all ranks' vertices, one rank's after the other's.
  std::vector<NodeIndex> nodes_of_ranks_;
};

/// Every plugin with such a solver contains it.
[[gnu::used]] inline constexpr PluginAbi deal_ii_abi =
    abi_with("smoothfem dealii types:",
             {DEAL_II_VERSION_MAJOR, DEAL_II_VERSION_MINOR, DEAL_II_VERSION_SUBMINOR,
              sizeof(dealii::Triangulation<3>), sizeof(dealii::types::global_dof_index)});

/// Calls work(). Exceptions of deal.II become a SolverFailure with their message in one line.
void with_failures_of_deal_ii(const std::function<void()>& work);

/// A solver in deal.II's words: it gets a triangulation, with material and boundary ids, and gives
/// numbers. Exceptions of deal.II are failures: the row of the mesh has their message. One with the
/// trait takes_ranks gets a part of the triangulation on each of several ranks. There an exception
/// of deal.II is on one rank only, and ends the program.
template <int dim>
class TriangulationSolver : public MeshSolver<dim> {
 public:
  void use_ties(const std::shared_ptr<const NodeTies>& ties) final { ties_ = ties; }
  void use_ranks(const Ranks& ranks) final { ranks_ = ranks; }

  void initialize(const Mesh<dim>& mesh, int degree) final {
    mesh_.emplace(mesh, ranks_);
    with_failures([&] { setup(mesh, mesh_->triangulation(), static_cast<unsigned int>(degree)); });
  }

  SolverResult solve(const Mesh<dim>& mesh) final {
    mesh_->move_vertices(mesh);
    SolverResult result;
    with_failures([&] { result = solve(mesh_->triangulation()); });
    return result;
  }

  double energy(const Mesh<dim>& mesh) final {
    mesh_->move_vertices(mesh);
    double energy = 0.0;
    with_failures_of_deal_ii([&] { energy = this->energy(mesh_->triangulation()); });
    return energy;
  }

  std::vector<Point<dim>> energy_gradient() final {
    std::vector<Point<dim>> gradient;
    with_failures_of_deal_ii([&] {
      for (const auto& g : energy_gradient(mesh_->triangulation())) {
        gradient.emplace_back();
        for (int d = 0; d < dim; ++d) gradient.back()[d] = g[d];
      }
    });
    return gradient;
  }

  std::vector<double> indicators(const Mesh<dim>& mesh) final {
    mesh_->move_vertices(mesh);
    std::vector<double> indicators;
    with_failures_of_deal_ii([&] {
      const auto of_cells = this->indicators(mesh_->triangulation());
      indicators.assign(of_cells.begin(), of_cells.end());
    });
    return indicators;
  }

 protected:
  /// Called once, for the initial mesh: make the DoFHandler and the sparsity pattern here. degree:
  /// 0 if the solver has no degrees. On several ranks, only the root may look at the mesh.
  virtual void setup(const Mesh<dim>& mesh, const dealii::Triangulation<dim>& triangulation,
                     unsigned int degree) = 0;

  /// Called for each mesh, after its vertices have moved.
  virtual SolverResult solve(const dealii::Triangulation<dim>& triangulation) = 0;

  /// The functions of MeshSolver with the same names, on one rank; vectors have an entry for each
  /// vertex or cell.
  virtual double energy(const dealii::Triangulation<dim>& /*triangulation*/) {
    throw InputError("it has no energy");
  }
  virtual std::vector<dealii::Tensor<1, dim>> energy_gradient(
      const dealii::Triangulation<dim>& /*triangulation*/) {
    throw InputError("it has no energy");
  }
  virtual dealii::Vector<float> indicators(const dealii::Triangulation<dim>& /*triangulation*/) {
    throw InputError("it has no error indicators");
  }

  /// Hanging and periodic nodes; null: none.
  const std::shared_ptr<const NodeTies>& ties() const { return ties_; }

  const Ranks& ranks() const { return ranks_; }

 private:
  void with_failures(const std::function<void()>& work) const {
    return ranks_.size() == 1 ? with_failures_of_deal_ii(work) : work();
  }

  std::shared_ptr<const NodeTies> ties_;
  Ranks ranks_;
  std::optional<TriangulatedMesh<dim>> mesh_;
};

}  // namespace smoothfem
