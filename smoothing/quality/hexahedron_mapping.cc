#include "smoothing/quality/hexahedron_mapping.h"

#include <Eigen/LU>
#include <algorithm>

namespace smoothfem {

namespace {

/// Reference coordinates of the corners, in their order.
constexpr int corner_place[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                    {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

double jacobian_determinant(const std::array<Point<3>, 8>& corners,
                            const std::array<double, 3>& at) {
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
  for (int v = 0; v < 8; ++v) {
    std::array<double, 3> factor, slope;
    for (int d = 0; d < 3; ++d) {
      factor[d] = corner_place[v][d] == 1 ? at[d] : 1.0 - at[d];
      slope[d] = corner_place[v][d] == 1 ? 1.0 : -1.0;
    }
    jacobian.col(0) += slope[0] * factor[1] * factor[2] * corners[v];
    jacobian.col(1) += factor[0] * slope[1] * factor[2] * corners[v];
    jacobian.col(2) += factor[0] * factor[1] * slope[2] * corners[v];
  }
  return jacobian.determinant();
}

}  // namespace

bool has_positive_mapping(const std::array<Point<3>, 8>& corners) {
  double values[3][3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        values[i][j][k] = jacobian_determinant(corners, {0.5 * i, 0.5 * j, 0.5 * k});
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
