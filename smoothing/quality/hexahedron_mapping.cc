// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/quality/hexahedron_mapping.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace smoothfem {

namespace {

/// The corner at i, j, k, each 0 or 1, in reference coordinates.
constexpr int corner_at[2][2][2] = {{{0, 4}, {3, 7}}, {{1, 5}, {2, 6}}};

/// The derivative by one reference coordinate. It depends bilinearly on the two others only and is
/// given at their values 0, 1/2, 1; it follows from the four edges in its direction.
using Slopes = std::array<std::array<Point<3>, 3>, 3>;

template <class Edge>
Slopes slopes(const Edge& edge) {
  Slopes result;
  for (int j : {0, 1})
    for (int k : {0, 1}) result[2 * j][2 * k] = edge(j, k);
  for (int j : {0, 2}) result[j][1] = 0.5 * (result[j][0] + result[j][2]);
  for (int k : {0, 1, 2}) result[1][k] = 0.5 * (result[0][k] + result[2][k]);
  return result;
}

}  // namespace

bool has_positive_mapping(const std::array<Point<3>, 8>& corners) {
  const auto corner = [&](int i, int j, int k) -> const Point<3>& {
    return corners[corner_at[i][j][k]];
  };
  const Slopes by_r = slopes([&](int j, int k) { return corner(1, j, k) - corner(0, j, k); });
  const Slopes by_s = slopes([&](int i, int k) { return corner(i, 1, k) - corner(i, 0, k); });
  const Slopes by_t = slopes([&](int i, int j) { return corner(i, j, 1) - corner(i, j, 0); });
  double values[3][3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) values[i][j][k] = by_r[j][k].cross(by_s[i][k]).dot(by_t[i][j]);
  // From values at 0, 1/2, 1 to coefficients, one direction after the other.
  const auto middle_coefficient = [](double first, double middle, double last) {
    return 2.0 * middle - 0.5 * (first + last);
  };
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      auto& row = values[i][j];
      row[1] = middle_coefficient(row[0], row[1], row[2]);
    }
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      values[i][1][k] = middle_coefficient(values[i][0][k], values[i][1][k], values[i][2][k]);
  for (int j = 0; j < 3; ++j)
    for (int k = 0; k < 3; ++k)
      values[1][j][k] = middle_coefficient(values[0][j][k], values[1][j][k], values[2][j][k]);
  return std::all_of(&values[0][0][0], &values[0][0][0] + 27,
                     [](double coefficient) { return coefficient > 0.0; });
}

}  // namespace smoothfem
