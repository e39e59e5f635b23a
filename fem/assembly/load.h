// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace smoothfem {

/// Computation of the right-hand side b from f.
enum class Load {
  quadrature,  ///< b_i = integral of f phi_i, the Galerkin load of textbooks
  nodal,       ///< b = M f_h, with the nodal interpolant f_h of f; the protocol of Chapter 6
  none         ///< f is left out; the caller adds it
};

}  // namespace smoothfem
