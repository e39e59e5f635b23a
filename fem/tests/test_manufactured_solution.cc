// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/solutions/manufactured_solution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

namespace smoothfem {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Points in and around the unit square or cube.
template <int dim>
std::vector<Point<dim>> sample_points() {
  if constexpr (dim == 2)
    return {{0.1, 0.2}, {-0.4, 0.9}, {1.3, -0.7}};
  else
    return {{0.1, 0.2, 0.7}, {-0.4, 0.9, -0.2}, {1.3, -0.7, 0.4}};
}
const auto sample = sample_points<2>();

template <class Dimension>
class ManufacturedSolutionsTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ManufacturedSolutionsTest, Dimensions);

TYPED_TEST(ManufacturedSolutionsTest, GradientAndLoadAreThoseOfTheValue) {
  constexpr int dim = TypeParam::value;
  constexpr double h = 1e-4;
  for (const auto& s : manufactured_solutions<dim>())
    for (const auto& p : sample_points<dim>()) {
      const double u = s.value(p);
      Point<dim> slope;
      double laplacian = 0.0;
      for (int d = 0; d < dim; ++d) {
        const double ahead = s.value(p + h * Point<dim>::Unit(d));
        const double behind = s.value(p - h * Point<dim>::Unit(d));
        slope[d] = (ahead - behind) / (2 * h);
        laplacian += (ahead + behind - 2 * u) / (h * h);
      }
      const auto both = s.value_and_gradient(p);
      EXPECT_DOUBLE_EQ(both.value, u) << s.name;
      EXPECT_LT((both.gradient - slope).norm(), 1e-5) << s.name;
      const double k = s.diffusivity ? s.diffusivity(p)(0, 0) : 1.0;  // piecewise constant
      EXPECT_NEAR(s.load(p), -k * laplacian, 1e-4) << s.name;
      if (!s.material_at) continue;
      const auto& material = s.materials[s.material_at(p)];
      EXPECT_EQ(material.constant, k) << s.name;
      EXPECT_EQ(material.diffusivity(p), s.diffusivity(p)) << s.name;
      EXPECT_EQ(material.load(p), s.load(p)) << s.name;
    }
}

TEST(ManufacturedSolutions, FluxIsContinuousAcrossTheCircle) {
  const auto& s = manufactured_solution<2>("interface-circle");
  for (const double angle : {0.3, 2.0, 4.5}) {
    const Point<2> r(std::cos(angle), std::sin(angle)), centre(0.5, 0.5);
    const auto flux = [&](double radius) -> Point<2> {
      const Point<2> p = centre + radius * r;
      EXPECT_EQ(s.material_at(p), radius < 0.3 ? 0U : 1U);
      return s.diffusivity(p) * s.value_and_gradient(p).gradient;
    };
    EXPECT_LT((flux(0.3 - 1e-9) - flux(0.3 + 1e-9)).norm(), 1e-8);
  }
}

TEST(ManufacturedSolutions, GearHasThePrintedFormula) {
  const auto& gear = manufactured_solution<2>("gear");
  EXPECT_DOUBLE_EQ(gear.value({-1.0, 5.0}), 60.0);
  EXPECT_DOUBLE_EQ(gear.value({0.0, 1.0 + 3.14159265358979323846}), 100.0);
}

TEST(ManufacturedSolutions, VolumeHasThePrintedFormula) {
  const auto& volume = manufactured_solution<3>("volume");
  EXPECT_DOUBLE_EQ(volume.value({0.0, 0.0, 7.0}), 60.0);
  EXPECT_DOUBLE_EQ(volume.value({3.14159265358979323846 / 4.0, 0.0, 0.0}), 95.0);
}

TEST(ManufacturedSolutions, UnknownNameListsTheAvailableOnes) {
  EXPECT_THAT([] { manufactured_solution<2>("gaer"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("gaer"), HasSubstr("gear"))));
}

TEST(ParsedSolution, AgreesWithTheSameFormulaInCode) {
  const auto parsed =
      parsed_solution<2>("sin(pi*x)*sin(pi*y)", "pi*cos(pi*x)*sin(pi*y) ; pi*sin(pi*x)*cos(pi*y)",
                         "2*pi^2*sin(pi*x)*sin(pi*y)", sample);
  const auto& coded = manufactured_solution<2>("sine");
  for (const auto& p : sample) {
    EXPECT_NEAR(parsed.value(p), coded.value(p), 1e-14);
    EXPECT_LT((parsed.value_and_gradient(p).gradient - coded.value_and_gradient(p).gradient).norm(),
              1e-13);
    EXPECT_NEAR(parsed.load(p), coded.load(p), 1e-12);
  }
}

TEST(ParsedSolution, HasThreeVariablesInSpace) {
  const auto volume_sample = sample_points<3>();
  const auto parsed =
      parsed_solution<3>("x^2 + x*y - 2*y^2 + y + 3*z^2 - x*z",
                         "2*x + y - z ; x - 4*y + 1 ; 6*z - x", "-4", volume_sample);
  const auto& coded = manufactured_solution<3>("quadratic");
  for (const auto& p : volume_sample) {
    const auto a = parsed.value_and_gradient(p), b = coded.value_and_gradient(p);
    EXPECT_NEAR(a.value, b.value, 1e-14);
    EXPECT_LT((a.gradient - b.gradient).norm(), 1e-14);
    EXPECT_EQ(parsed.load(p), coded.load(p));
  }
  EXPECT_THAT([&] { parsed_solution<3>("x*z", "z ; 0", "0", volume_sample); },
              ThrowsMessage<InputError>(HasSubstr("z ; 0")));
}

TEST(ParsedSolution, IsSafeInSeveralThreads) {
  const auto parsed = parsed_solution<2>("x*x", "2*x ; 0", "-2", sample);
  std::vector<std::jthread> threads;
  std::atomic<int> wrong{0};
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 2000; ++i)
        if (parsed.value({t + 1.0, 0.0}) != (t + 1.0) * (t + 1.0)) ++wrong;
    });
  threads.clear();
  EXPECT_EQ(wrong, 0);
}

TEST(ParsedSolution, ReportsErrors) {
  EXPECT_THAT([] { parsed_solution<2>("sin(", "0 ; 0", "0", sample); },
              ThrowsMessage<InputError>(HasSubstr("sin(")));
  EXPECT_THAT([] { parsed_solution<2>("x*x", "x ; 0", "-2", sample); },
              ThrowsMessage<InputError>(HasSubstr("gradient")));
  EXPECT_THAT([] { parsed_solution<2>("x*x", "2*x ; 0", "2", sample); },
              ThrowsMessage<InputError>(HasSubstr("-laplace")));
  EXPECT_THAT([] { parsed_solution<2>("x*x", "2*x", "-2", sample); },
              ThrowsMessage<InputError>(HasSubstr("2*x")));
  EXPECT_THAT([] { parsed_solution<2>("x*x", "", "-2", sample); },
              ThrowsMessage<InputError>(HasSubstr("'gradient' is empty")));
  EXPECT_THAT([] { parsed_solution<2>("log(x-5)", "1/(x-5) ; 0", "1/(x-5)^2", sample); },
              ThrowsMessage<InputError>(HasSubstr("'value' is not a finite number at (")));
}

TEST(ParsedSolution, ReportsUnreadableExpressionsInOneSentence) {
  testing::internal::CaptureStderr();
  EXPECT_THAT([] { parsed_solution<2>("exq(y)", "0 ; 0", "0", sample); },
              ThrowsMessage<InputError>(
                  AllOf(HasSubstr("'value', 'exq(y)'"),
                        HasSubstr("('exq' at character 1 is not understood): it needs"))));
  EXPECT_THAT([] { parsed_solution<2>("x + y)", "1 ; 1", "0", sample); },
              ThrowsMessage<InputError>(HasSubstr("')' at character 6 is not understood")));
  EXPECT_THAT([] { parsed_solution<2>("x +", "1 ; 0", "0", sample); },
              ThrowsMessage<InputError>(HasSubstr("(it ends too early)")));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace smoothfem
