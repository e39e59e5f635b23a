// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

namespace smoothfem::adaptive_quadrature {

/// Numbers of Gauss points in each direction of hexahedra, of which each cell uses as many as it
/// needs. The integrands are rational: with n points the error of 1 / det of the mapping falls like
/// rho^(-2 n). rho depends on the change of the determinant in the cell (on the distance of its
/// nearest zero).
///
/// A cell tries rule after rule until the next one changes its integrals by at most `tolerance`,
/// and uses that next rule. As the numbers of points grow by a half, the remaining error is much
/// smaller than the change: about change^(3/2).
inline constexpr std::array<int, 6> rule_sequence{4, 6, 9, 13, 19, 28};

/// Relative tolerance for the change of a cell's stiffness matrix (Frobenius norm), and of its
/// share of the squared norms of errors.
inline constexpr double tolerance = 1e-4;

/// Tolerance for the change by the last rule. By the exponent 3/2 above, the remaining error is
/// then at most `tolerance`.
inline constexpr double last_tolerance = 2e-3;

/// Checks the first rule with a coarser one, which is cheaper than a finer one. The first rule is
/// enough for a cell's share of the errors if a rule of `check_points` changes it by at most
/// `check_tolerance`. As errors fall like rho^(-2 n), the error of the first rule is then at most
/// check_tolerance^(4/3), which is `tolerance`.
inline constexpr int check_points = 3;
inline constexpr double check_tolerance = 1e-3;

/// Cells with a nearly constant Jacobian determinant are not checked: determinants at the points of
/// the first rule differ by less than this factor. For a determinant that is linear in one
/// direction, rho is then 9.9 and rho^(-8) is 1e-8. A factor of 2 leaves more than 1e-4 in cells
/// whose determinant varies in all directions.
inline constexpr double even_determinants = 1.5;

constexpr double tolerance_at(std::size_t level, std::size_t n_rules) {
  return level + 1 == n_rules ? last_tolerance : tolerance;
}

/// Statistics of the quadrature on the hexahedra of this rank.
struct Use {
  int max_points = 0;           ///< in each direction, of any cell; 0: no rule was chosen
  std::size_t n_unsettled = 0;  ///< cells that the last rule still changes by more

  void note(std::size_t level, bool is_settled) {
    if (rule_sequence[level] > max_points) max_points = rule_sequence[level];
    n_unsettled += !is_settled;
  }
};

}  // namespace smoothfem::adaptive_quadrature
