// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "smoothing/tests/curved_cells.h"

namespace smoothfem {
namespace {

class ShapeFunctionsOfType : public testing::TestWithParam<SecondOrderType> {
 protected:
  const ShapeFunctions& functions = shape_functions(GetParam().dim, GetParam().n_nodes);
};

TEST_P(ShapeFunctionsOfType, AreOneAtTheirNodeAndZeroAtOthers) {
  ASSERT_EQ(functions.nodes().size(), GetParam().n_nodes);
  for (std::size_t i = 0; i < functions.nodes().size(); ++i) {
    const auto values = functions.values(functions.nodes()[i]);
    for (std::size_t k = 0; k < values.size(); ++k)
      EXPECT_NEAR(values[k], i == k ? 1.0 : 0.0, 1e-15) << i << ' ' << k;
  }
}

TEST_P(ShapeFunctionsOfType, ReproduceLinearFunctions) {
  test::Random random(1);
  for (const auto& x : test::reference_samples(GetParam(), 20, random)) {
    const auto values = functions.values(x);
    const auto gradients = functions.gradients(x);
    double sum = 0.0;
    Point<3> point = Point<3>::Zero(), sum_of_gradients = Point<3>::Zero();
    Eigen::Matrix3d identity = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < values.size(); ++k) {
      sum += values[k];
      point += values[k] * functions.nodes()[k];
      sum_of_gradients += gradients[k];
      identity += functions.nodes()[k] * gradients[k].transpose();
    }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    EXPECT_LT((point - x).norm(), 1e-14);
    EXPECT_LT(sum_of_gradients.norm(), 1e-13);
    for (int d = 0; d < 3; ++d)
      for (int e = 0; e < GetParam().dim; ++e)
        EXPECT_NEAR(identity(d, e), d == e ? 1.0 : 0.0, 1e-13);
  }
}

TEST_P(ShapeFunctionsOfType, HaveTheGradientsOfTheirDifferences) {
  constexpr double h = 1e-5;
  test::Random random(2);
  auto samples = test::reference_samples(GetParam(), 20, random);
  if (GetParam().n_corners == 5) samples.erase(samples.begin() + 4);  // the apex is singular
  for (const auto& x : samples) {
    const auto gradients = functions.gradients(x);
    for (int d = 0; d < GetParam().dim; ++d) {
      const Point<3> step = h * Point<3>::Unit(d);
      const auto before = functions.values(x - step), after = functions.values(x + step);
      for (std::size_t k = 0; k < before.size(); ++k)
        EXPECT_NEAR(gradients[k][d], (after[k] - before[k]) / (2.0 * h), 1e-6) << k << ' ' << d;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Types, ShapeFunctionsOfType, testing::ValuesIn(second_order_types),
                         [](const auto& info) { return name_of(info.param); });

TEST(ShapeFunctions, OfThePyramidHaveTheirLimitAtTheApex) {
  for (const std::size_t n : {13, 14}) {
    const ShapeFunctions& functions = shape_functions(3, n);
    constexpr double h = 1e-7;
    const auto near = functions.gradients({0.5 * h, 0.5 * h, 1.0 - h});
    const auto limit = functions.gradients({0.0, 0.0, 1.0});
    for (std::size_t k = 0; k < n; ++k) EXPECT_LT((near[k] - limit[k]).norm(), 1e-5) << k;
  }
}

TEST(ShapeFunctions, KnowTheTypeFromTheNumberOfNodes) {
  EXPECT_EQ(shape_functions(3, 15).type().n_corners, 6u);
  EXPECT_THROW(shape_functions(3, 9), InputError);
  EXPECT_THROW(shape_functions(2, 10), InputError);
}

}  // namespace
}  // namespace smoothfem
