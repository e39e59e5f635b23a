// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

namespace smoothfem::chosen_points {

/// Gauss points per direction that hexahedra may have, when each gets as many as it needs. The
/// integrands are rational: 1 / det of the mapping converges like rho^(-2 n) with n points, rho
/// depending on how much the determinant changes in the cell (on how near its zero is). A cell goes
/// up from rule to rule until the one after changes its integrals by no more than `tolerance`, and
/// takes that one. Since the numbers of points grow by a half, the error left is much less than the
/// change: change^(3/2) or so.
inline constexpr std::array<int, 6> ladder{4, 6, 9, 13, 19, 28};

/// On the change of a cell's stiffness matrix (Frobenius norm), and on that of its share of the
/// squared norms of errors, relatively.
inline constexpr double tolerance = 1e-4;

/// The same on what the last rule may change: by the 3/2 above, what is left is no more than
/// `tolerance` then.
inline constexpr double last_tolerance = 2e-3;

/// A look back, which costs less than one ahead: the first rule is enough for a cell's share of the
/// errors if a rule of `check_points` changes it by no more than `check_tolerance`. As errors fall
/// like rho^(-2 n), that of the first rule is then no more than its power 4/3, which is
/// `tolerance`.
inline constexpr int check_points = 3;
inline constexpr double check_tolerance = 1e-3;

/// Cells whose determinants at the points of the first rule differ by less than this factor need no
/// look at the second one: with a determinant that is linear in one direction, rho is 9.9 then and
/// rho^(-8) 1e-8. A factor of 2 leaves more than 1e-4 in cells that are uneven in all directions.
inline constexpr double even_determinants = 1.5;

constexpr double tolerance_at(std::size_t level, std::size_t n_rules) {
  return level + 1 == n_rules ? last_tolerance : tolerance;
}

/// How the hexahedra of this rank were integrated.
struct Use {
  int most_points = 0;          ///< per direction, of any cell; 0: nothing was chosen
  std::size_t n_unsettled = 0;  ///< cells that the last rule still changes by more

  void note(std::size_t level, bool is_settled) {
    if (ladder[level] > most_points) most_points = ladder[level];
    n_unsettled += !is_settled;
  }
};

}  // namespace smoothfem::chosen_points
