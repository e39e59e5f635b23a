#pragma once

#include <Eigen/Core>

#include "fem/finite_element_space.h"
#include "fem/manufactured_solution.h"

namespace smoothfem {

/// How the right-hand side is made from f.
enum class Load {
  nodal,       ///< b = M f_h, f interpolated at the dofs (the thesis' protocol)
  quadrature,  ///< b_i = integral of f phi_i by quadrature (the textbook's Galerkin load)
};

/// The linear system of the free dofs after the boundary values are eliminated.
struct PoissonSystem {
  SparseMatrix matrix;              ///< symmetric positive definite, n_free x n_free
  Eigen::VectorXd right_hand_side;  ///< n_free
  Eigen::VectorXd exact;            ///< u at all dofs; its boundary entries are the boundary values
};

/// A system with the space's pattern, to be filled again and again.
PoissonSystem make_system(const FiniteElementSpace& space);

/// Fills the system for a mesh with these node coordinates, all of whose cells are valid.
void assemble(const FiniteElementSpace& space, const std::vector<Point<2>>& coordinates,
              const ManufacturedSolution& solution, Load load, PoissonSystem& system);

}  // namespace smoothfem
