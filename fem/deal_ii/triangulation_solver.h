// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/grid/tria.h>
#include <deal.II/lac/vector.h>

#include <optional>

#include "fem/solvers/mesh_solver.h"

namespace smoothfem {

/// Returns the mesh as a triangulation of deal.II. Its vertices are the nodes, with the same
/// numbers; its cells are in the mesh's order. The material id of a cell and the boundary id of a
/// boundary facet are their tags in the mesh; 0 without a tag. Throws InputError for tags that
/// deal.II does not allow (below 0).
template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> triangulation_of(const Mesh<dim>& mesh);

/// Moves the vertices of such a triangulation to the nodes of a mesh with the same topology.
template <int dim>
void move_vertices(const Mesh<dim>& mesh, dealii::Triangulation<dim>& triangulation);

/// Every plugin with such a solver contains it.
[[gnu::used]] inline constexpr PluginAbi deal_ii_abi =
    abi_with("smoothfem dealii types:",
             {DEAL_II_VERSION_MAJOR, DEAL_II_VERSION_MINOR, DEAL_II_VERSION_SUBMINOR,
              sizeof(dealii::Triangulation<3>), sizeof(dealii::types::global_dof_index)});

/// Calls work(). Exceptions of deal.II become a SolverFailure with their message in one line.
void with_failures_of_deal_ii(const std::function<void()>& work);

/// A solver in deal.II's words: it gets a triangulation, with material and boundary ids, and gives
/// numbers. Exceptions of deal.II are failures: the row of the mesh has their message.
template <int dim>
class TriangulationSolver : public MeshSolver<dim> {
 public:
  void use_ties(const std::shared_ptr<const NodeTies>& ties) final { ties_ = ties; }

  void initialize(const Mesh<dim>& mesh, int degree) final {
    triangulation_ = triangulation_of(mesh);
    with_failures_of_deal_ii(
        [&] { setup(mesh, *triangulation_, static_cast<unsigned int>(degree)); });
  }

  SolverResult solve(const Mesh<dim>& mesh) final {
    move_vertices(mesh, *triangulation_);
    SolverResult result;
    with_failures_of_deal_ii([&] { result = solve(*triangulation_); });
    return result;
  }

  double energy(const Mesh<dim>& mesh) final {
    move_vertices(mesh, *triangulation_);
    double energy = 0.0;
    with_failures_of_deal_ii([&] { energy = this->energy(*triangulation_); });
    return energy;
  }

  std::vector<Point<dim>> energy_gradient() final {
    std::vector<Point<dim>> gradient;
    with_failures_of_deal_ii([&] {
      for (const auto& g : energy_gradient(*triangulation_)) {
        gradient.emplace_back();
        for (int d = 0; d < dim; ++d) gradient.back()[d] = g[d];
      }
    });
    return gradient;
  }

  std::vector<double> indicators(const Mesh<dim>& mesh) final {
    move_vertices(mesh, *triangulation_);
    std::vector<double> indicators;
    with_failures_of_deal_ii([&] {
      const auto of_cells = this->indicators(*triangulation_);
      indicators.assign(of_cells.begin(), of_cells.end());
    });
    return indicators;
  }

 protected:
  /// Called once, for the initial mesh: make the DoFHandler and the sparsity pattern here. degree:
  /// 0 if the solver has no degrees.
  virtual void setup(const Mesh<dim>& mesh, const dealii::Triangulation<dim>& triangulation,
                     unsigned int degree) = 0;

  /// Called for each mesh, after its vertices have moved.
  virtual SolverResult solve(const dealii::Triangulation<dim>& triangulation) = 0;

  /// The functions of MeshSolver with the same names; vectors have an entry for each vertex or
  /// cell.
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

 private:
  std::shared_ptr<const NodeTies> ties_;
  std::unique_ptr<dealii::Triangulation<dim>> triangulation_;
};

}  // namespace smoothfem
