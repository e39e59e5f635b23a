// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fem/constraints/node_ties.h"
#include "fem/solution_record.h"
#include "fem/solutions/manufactured_solution.h"
#include "smoothing/loop/parameter.h"
#include "smoothing/loop/plugin_abi.h"
#include "smoothing/loop/smoother.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

class Ranks;

/// A number that a solver gives for each mesh.
struct NumberDescription {
  std::string name;         ///< a letter, then letters, digits and '_'; its column is LABEL.name
  std::string unit;         ///< empty: none
  std::string description;  ///< one sentence
};

/// What a solver finds on one mesh.
struct SolverResult {
  std::vector<SolverNumber> numbers;  ///< each name once; NaN: not known on this mesh
  std::string status = "ok";          ///< or the problem with the numbers, which are recorded
};

/// A solver has no numbers for a mesh. The row of the mesh has the reason, and the study goes on.
using SolverFailure = SmootherFailure;

struct SolverTraits {
  std::vector<int> degrees = {};  ///< of finite elements that it offers; empty: it has no degrees
  bool needs_mpi = false;       ///< it calls libraries that need MPI, and is not called by threads
  bool needs_solution = false;  ///< of the study, by use_solution
  bool takes_ties = false;      ///< it solves on meshes with tied nodes (use_ties)
  bool takes_curved_cells = false;  ///< it maps cells of second order by their midside nodes, too
  bool takes_ranks = false;  ///< it solves on several processes, if there are no ties (use_ranks)
  bool has_energy = false;   ///< `energy` and `energy_gradient`
  bool has_indicators = false;  ///< `indicators`
};

/// Computes numbers on meshes of one topology, for the records of a study. A new solver is one
/// file: a class template over the dimension that derives from this class and registers itself
/// (RegisteredSolver). Each thread has its own.
template <int dim>
class MeshSolver {
 public:
  virtual ~MeshSolver() = default;

  virtual SolverTraits traits() const { return {}; }

  /// Returns the parameters that studies set.
  virtual Parameters parameters() { return {}; }
  /// Returns parameters with one value for each of some names, for example "E group": a study
  /// writes 'set E group=steel = 210e9'.
  virtual std::vector<std::string> keyed_parameters() const { return {}; }
  /// Sets such a value. Throws InputError if it cannot be read.
  virtual void set_keyed(const std::string& /*parameter*/, const std::string& /*name*/,
                         const std::string& /*value*/) {}
  /// Checks parameters that depend on each other; called when all are set. Throws InputError.
  virtual void check_parameters() const {}

  /// Sets the folders of files; called before the functions below.
  virtual void use_folders(const SmootherFolders& /*folders*/) {}
  /// Returns the origin of a solver that is not part of this program, for the provenance.
  virtual SmootherOrigin origin() { return {}; }

  /// Takes the study's solution on the mesh; called before initialize.
  virtual void use_solution(const ManufacturedSolution<dim>& /*solution*/) {}

  /// Takes the ties of the mesh's hanging and periodic nodes; called before initialize.
  virtual void use_ties(const std::shared_ptr<const NodeTies>& /*ties*/) {}

  /// Takes the processes that solve together; called before initialize. Then all of them call
  /// initialize and solve. The root's mesh counts; the others' is not used. InputErrors, and so
  /// SolverFailures, are thrown on all.
  virtual void use_ranks(const Ranks& /*ranks*/) {}

  /// Returns the descriptions of its numbers. It may give other numbers, too.
  virtual std::vector<NumberDescription> numbers() const { return {}; }

  /// Takes a mesh with the topology of all meshes to come, and the degree (0: none). Compute here
  /// what depends on the topology only. Throws InputError if the solver cannot be used on it.
  virtual void initialize(const Mesh<dim>& mesh, int degree) = 0;

  /// Solves on a mesh with valid cells. Throws SolverFailure.
  virtual SolverResult solve(const Mesh<dim>& mesh) = 0;

  // The functions below are for methods that move nodes by the solution ('smooth for' in a study).
  // They are called for a solver whose traits have them.

  /// Solves on a mesh with valid cells. Returns a number that falls with the error while the
  /// boundary stays: the minimum of a functional over the finite element space, such as a(u_h, u_h)
  /// - 2 (f, u_h). Throws SolverFailure.
  virtual double energy(const Mesh<dim>& /*mesh*/) { throw InputError("it has no energy"); }

  /// Returns the derivative of the last `energy` in the position of each node.
  virtual std::vector<Point<dim>> energy_gradient() { throw InputError("it has no energy"); }

  /// Returns an error indicator of each cell, not negative: a mean over the cell. Follows `energy`
  /// on the same mesh if the solver has it; otherwise it solves. Throws SolverFailure.
  virtual std::vector<double> indicators(const Mesh<dim>& /*mesh*/) {
    throw InputError("it has no error indicators");
  }
};

/// Every plugin with a solver contains it.
[[gnu::used]] inline constexpr PluginAbi solver_abi =
    abi_with("smoothfem solver types:",
             {sizeof(SolverResult), sizeof(SolverTraits), sizeof(NumberDescription),
              sizeof(Parameter), sizeof(ManufacturedSolution<3>)});

struct SolverInfo {
  std::string name;                    ///< as the type in study files
  std::string title;                   ///< in tables and figures
  std::string description;             ///< one sentence
  std::string source;                  ///< paper, program or tutorial
  std::filesystem::path library = {};  ///< the plugin that registered it; empty: this program
};

/// Functions that make a solver for planar and volume meshes; empty where it has none.
struct SolverMakers {
  std::function<std::unique_ptr<MeshSolver<2>>()> planar = {};
  std::function<std::unique_ptr<MeshSolver<3>>()> volume = {};
};

/// Makers of a class template over the dimension.
template <template <int> class Solver>
SolverMakers solver_in_plane_and_space() {
  return {[] { return std::make_unique<Solver<2>>(); },
          [] { return std::make_unique<Solver<3>>(); }};
}

/// Registers a solver when its file is loaded: one namespace-scope object for each solver.
struct RegisteredSolver {
  RegisteredSolver(SolverInfo info, SolverMakers makers);
};

/// Returns the registered solvers, sorted by name.
std::vector<SolverInfo> solver_catalogue();

/// Returns the plugin that registered a solver; empty for others.
std::filesystem::path library_of_solver(const std::string& type);

/// Makes a solver with its default parameters: a registered one, or "python:FILE:CLASS". Throws
/// InputError for an unknown type; the message lists the available types. Throws it also if the
/// solver does not support this dimension.
template <int dim>
std::unique_ptr<MeshSolver<dim>> make_solver(const std::string& type);

}  // namespace smoothfem
