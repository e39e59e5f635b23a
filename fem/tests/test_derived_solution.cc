// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <thread>

#include "fem/solutions/check_pieces.h"
#include "fem/solutions/manufactured_solution.h"
#include "fem/tests/unit_mesh.h"

namespace smoothfem {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<Point<2>> plane_sample{{0.1, 0.2}, {-0.4, 0.9}, {1.3, -0.7}};
const std::vector<Point<3>> space_sample{{0.1, 0.2, 0.7}, {-0.4, 0.9, -0.2}, {1.3, -0.7, 0.4}};

ManufacturedSolution<2> in_plane(const std::string& u, const std::string& diffusivity = {}) {
  return derived_solution<2>(u, diffusivity, plane_sample);
}

TEST(DerivedSolution, DerivativesInSpaceMatchHandComputation) {
  const auto s = derived_solution<3>("35*sin(2*x+y)*cos(y-3*z)+60", "", space_sample);
  for (const auto& p : space_sample) {
    const double a = 2 * p.x() + p.y(), b = p.y() - 3 * p.z();
    const auto [value, gradient] = s.value_and_gradient(p);
    EXPECT_NEAR(value, 35 * std::sin(a) * std::cos(b) + 60, 1e-12);
    EXPECT_EQ(s.value(p), value);
    EXPECT_NEAR(gradient.x(), 70 * std::cos(a) * std::cos(b), 1e-12);
    EXPECT_NEAR(gradient.y(), 35 * std::cos(a + b), 1e-12);
    EXPECT_NEAR(gradient.z(), 105 * std::sin(a) * std::sin(b), 1e-12);
    // u_xx = -4 v, u_zz = -9 v with v = u - 60; u_yy = -35 sin(a + b) * 2
    const double v = value - 60.0;
    EXPECT_NEAR(s.load(p), 13 * v + 70 * std::sin(a + b), 1e-10);
  }
}

TEST(DerivedSolution, ManyPointsAtOnceHaveTheValuesOfEach) {
  const auto s = in_plane("if(x < 0.3, sqrt(x + 2)*y^-2, if(y <= 0.5, atan2(y, x), x^2.5)) + pi",
                          "1 + x^2, 0 ; 0, exp(y)");
  std::vector<Point<2>> points;
  for (int k = 1; k <= 37; ++k) points.emplace_back(k / 30.0, (7 * k % 37) / 40.0 + 0.01);
  for (const std::size_t n : {0U, 1U, 7U, 8U, 16U, 17U, 37U}) {
    std::vector<ValueAndGradient<2>> both(n);
    std::vector<double> loads(n);
    s.value_and_gradient.at(std::span(points).first(n), both);
    s.load.at(std::span(points).first(n), loads);
    for (std::size_t k = 0; k < n; ++k) {
      const auto [value, gradient] = s.value_and_gradient(points[k]);
      EXPECT_EQ(both[k].value, value);
      EXPECT_EQ(both[k].gradient, gradient);
      EXPECT_EQ(loads[k], s.load(points[k]));
    }
  }
}

TEST(DerivedSolution, EvaluatesEachFunctionAndItsDerivative) {
  // f'(t) at t = x + 2 y, which stays between 0.1 and 1 here.
  const std::vector<Point<2>> points{{0.1, 0.2}, {0.3, 0.05}, {0.2, 0.3}};
  struct Known {
    std::string name;
    double (*value)(double);
    double (*derivative)(double);
  };
  for (const Known& known : std::vector<Known>{
           {"exp(T)", [](double t) { return std::exp(t); }, [](double t) { return std::exp(t); }},
           {"log(T)", [](double t) { return std::log(t); }, [](double t) { return 1 / t; }},
           {"ln(T)", [](double t) { return std::log(t); }, [](double t) { return 1 / t; }},
           {"log10(T)", [](double t) { return std::log10(t); },
            [](double t) { return 1 / (t * std::numbers::ln10); }},
           {"log2(T)", [](double t) { return std::log2(t); },
            [](double t) { return 1 / (t * std::numbers::ln2); }},
           {"sqrt(T)", [](double t) { return std::sqrt(t); },
            [](double t) { return 0.5 / std::sqrt(t); }},
           {"pow(T, 3)", [](double t) { return t * t * t; }, [](double t) { return 3 * t * t; }},
           {"(T)^-1.5", [](double t) { return std::pow(t, -1.5); },
            [](double t) { return -1.5 * std::pow(t, -2.5); }},
           {"(T)^(T)", [](double t) { return std::pow(t, t); },
            [](double t) { return std::pow(t, t) * (std::log(t) + 1); }},
           {"tan(T)", [](double t) { return std::tan(t); },
            [](double t) { return 1 / (std::cos(t) * std::cos(t)); }},
           {"asin(T/2)", [](double t) { return std::asin(t / 2); },
            [](double t) { return 0.5 / std::sqrt(1 - t * t / 4); }},
           {"acos(T/2)", [](double t) { return std::acos(t / 2); },
            [](double t) { return -0.5 / std::sqrt(1 - t * t / 4); }},
           {"atan(T)", [](double t) { return std::atan(t); },
            [](double t) { return 1 / (1 + t * t); }},
           {"atan2(T, 2)", [](double t) { return std::atan2(t, 2); },
            [](double t) { return 2 / (4 + t * t); }},
           {"sinh(T)", [](double t) { return std::sinh(t); },
            [](double t) { return std::cosh(t); }},
           {"cosh(T)", [](double t) { return std::cosh(t); },
            [](double t) { return std::sinh(t); }},
           {"tanh(T)", [](double t) { return std::tanh(t); },
            [](double t) { return 1 / (std::cosh(t) * std::cosh(t)); }},
           {"asinh(T)", [](double t) { return std::asinh(t); },
            [](double t) { return 1 / std::sqrt(1 + t * t); }},
           {"acosh(T+1)", [](double t) { return std::acosh(t + 1); },
            [](double t) { return 1 / std::sqrt(t * t + 2 * t); }},
           {"atanh(T/2)", [](double t) { return std::atanh(t / 2); },
            [](double t) { return 0.5 / (1 - t * t / 4); }},
           {"abs(-(T))", [](double t) { return t; }, [](double) { return 1.0; }},
           {"min(T, 5, 7)", [](double t) { return t; }, [](double) { return 1.0; }},
           {"max(-3, T, 0)", [](double t) { return t; }, [](double) { return 1.0; }},
           {"pi*(T)", [](double t) { return std::numbers::pi * t; },
            [](double) { return std::numbers::pi; }}}) {
    std::string u = known.name;
    for (auto at = u.find('T'); at != std::string::npos; at = u.find('T'))
      u.replace(at, 1, "x+2*y");
    for (auto at = u.find("x+2*y/"); at != std::string::npos; at = u.find("x+2*y/"))
      u.replace(at, 5, "(x+2*y)");
    const auto s = derived_solution<2>(u, "", points);
    for (const auto& p : points) {
      const double t = p.x() + 2 * p.y(), slope = known.derivative(t);
      const auto [value, gradient] = s.value_and_gradient(p);
      EXPECT_NEAR(value, known.value(t), 1e-13 * (1 + std::abs(value))) << u;
      EXPECT_NEAR(gradient.x(), slope, 1e-12 * (1 + std::abs(slope))) << u;
      EXPECT_NEAR(gradient.y(), 2 * slope, 1e-12 * (1 + std::abs(slope))) << u;
    }
  }
}

TEST(DerivedSolution, ReadsOperatorsAsMuParserDoes) {
  const std::vector<Point<2>> point{{3.0, 2.0}};
  const auto value = [&](const std::string& u) {
    return derived_solution<2>(u, "", point).value(point[0]);
  };
  EXPECT_EQ(value("-x^2"), -9.0);
  EXPECT_EQ(value("2^y^x"), 256.0) << "powers from the right";
  EXPECT_EQ(value("x^-y"), 1.0 / 9.0);
  EXPECT_EQ(value("12/x/y"), 2.0);
  EXPECT_EQ(value("x - y - 1"), 0.0);
  EXPECT_EQ(value("1.5e1*x + .5*y + 2.*y"), 50.0);
  EXPECT_EQ(value("x > y ? x : y"), 3.0);
  EXPECT_EQ(value("if(x > 2.5 && y > 2.5, 1, 2) + 0*x"), 2.0);
  EXPECT_EQ(value("if(x > 2.5 || y > 2.5, 1, 2)"), 1.0);
  EXPECT_EQ(value("if(!(x > 2.5), 1, 2)"), 2.0);
  EXPECT_EQ(value("x >= 3 ? (y != 2 ? 1 : y == 2 ? 5 : 6) : x <= 3"), 5.0);
  EXPECT_EQ(value("0.1 + 0.2"), 0.3) << "decimals are exact";
}

TEST(DerivedSolution, AgreesWithTheSameFormulaInCode) {
  const auto derived = in_plane("sin(pi*x)*sin(pi*y)");
  const auto& coded = manufactured_solution<2>("sine");
  for (const auto& p : plane_sample) {
    EXPECT_NEAR(derived.value(p), coded.value(p), 1e-14);
    EXPECT_LT(
        (derived.value_and_gradient(p).gradient - coded.value_and_gradient(p).gradient).norm(),
        1e-13);
    EXPECT_NEAR(derived.load(p), coded.load(p), 1e-12);
  }
  EXPECT_EQ(derived.formula, "sin(pi*x)*sin(pi*y)");
}

TEST(DerivedSolution, DerivesEachPieceForItself) {
  // Both pieces and their slopes are 0 at x = 1/2.
  const auto s = in_plane("if(x < 0.5, (x-0.5)^2, 3*(x-0.5)^2*(y+2))");
  for (const double x : {-0.4, 0.1, 0.7, 1.3}) {
    const double y = 0.25, t = x - 0.5, factor = x < 0.5 ? 1.0 : 3.0 * (y + 2.0);
    const auto [value, gradient] = s.value_and_gradient({x, y});
    EXPECT_NEAR(value, factor * t * t, 1e-14);
    EXPECT_NEAR(gradient.x(), 2 * factor * t, 1e-13);
    EXPECT_NEAR(gradient.y(), x < 0.5 ? 0.0 : 3 * t * t, 1e-13);
    EXPECT_NEAR(s.load({x, y}), -2 * factor, 1e-12);
  }
  const auto root = in_plane("if(x + 3 > 0, sqrt(x + 3), 0)");
  EXPECT_EQ(root.value_and_gradient({-4.0, 0.0}).gradient.x(), 0.0) << "the other piece is a NaN";
}

TEST(DerivedSolution, LoadWithADiffusivityMatchesHandComputation) {
  // u = x^2 y: grad u = (2xy, x^2).
  const auto scalar = in_plane("x^2*y", "1 + x^2");
  // -d/dx((1 + x^2) 2xy) - d/dy((1 + x^2) x^2) = -2y - 6x^2 y
  const auto tensor = in_plane("x^2*y", "2 + y^2, x/10 ; x/10, 3");
  // flux = (4xy + 2xy^3 + x^3/10, x^2 y/5 + 3x^2): -div = -(4y + 2y^3 + 3x^2/10) - x^2/5
  for (const auto& p : plane_sample) {
    const double x = p.x(), y = p.y();
    EXPECT_NEAR(scalar.load(p), -2 * y - 6 * x * x * y, 1e-12);
    EXPECT_NEAR(tensor.load(p), -(4 * y + 2 * y * y * y + 0.3 * x * x) - 0.2 * x * x, 1e-12);
    Diffusivity<2> expected;
    expected << 2 + y * y, x / 10, x / 10, 3;
    EXPECT_LT((tensor.diffusivity(p) - expected).norm(), 1e-14);
    EXPECT_LT((scalar.diffusivity(p) - (1 + x * x) * Diffusivity<2>::Identity()).norm(), 1e-14);
  }
  EXPECT_FALSE(in_plane("x").diffusivity) << "the identity costs nothing";
  const auto space = derived_solution<3>(
      "x*y*z", "atan2(1, 2) + 3, 0, 0 ; 0, max(2, 1), 0 ; 0, 0, z^2 + 1", space_sample);
  for (const auto& p : space_sample) EXPECT_NEAR(space.load(p), -2 * p.x() * p.y() * p.z(), 1e-13);
}

TEST(ParsedSolution, LoadIsCheckedAgainstTheDiffusivity) {
  const auto make = [](const std::string& load) {
    return parsed_solution<2>("x^2*y", "2*x*y ; x^2", load, plane_sample, "1 + x^2");
  };
  EXPECT_NO_THROW(make("-2*y - 6*x^2*y"));
  EXPECT_THAT([&] { make("-2*y"); },
              ThrowsMessage<InputError>(HasSubstr("is not -div(diffusivity grad(value)) at (")));
}

TEST(DerivedSolution, IsSafeInSeveralThreads) {
  const auto s = in_plane("x*x*y", "1 + y^2");
  std::vector<std::jthread> threads;
  std::atomic<int> wrong{0};
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 2000; ++i)
        if (s.value({t + 1.0, 2.0}) != 2.0 * (t + 1.0) * (t + 1.0)) ++wrong;
    });
  threads.clear();
  EXPECT_EQ(wrong, 0);
}

TEST(DerivedSolution, ReportsUnreadableFormulasInOneSentence) {
  const auto expect = [](const std::string& u, const std::string& part) {
    EXPECT_THAT([&] { in_plane(u); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("the solution's "), HasSubstr(part))))
        << u;
  };
  expect("", "'u' is empty: it needs a formula in x and y, such as");
  expect(
      "exq(y)",
      "'u', 'exq(y)', cannot be read ('exq' at character 1 is not a function; did you mean 'exp'? "
      "choose one of abs,");
  expect("x + xx",
         "('xx' at character 5 is not a variable; did you mean 'x'? choose one of x, y, pi)");
  expect("x*z", "('z' at character 3 is not a variable; ");
  expect("x + y)", "(')' at character 6 is not understood)");
  expect("x +", "(it ends too early)");
  expect("sin(x", "(it ends too early)");
  expect("x $ y", "('$' at character 3 is not understood)");
  expect("1.2.3*x", "('.' at character 4 is not understood)");
  expect("2e*x", "('e' at character 2 is not understood)");
  expect("atan2(x)", "('atan2' at character 1 takes 2 arguments, not 1)");
  expect("sin(x, y)", "('sin' at character 1 takes 1 argument, not 2)");
  expect("max()", "('max' at character 1 takes 1 or more arguments, not 0)");
  expect("x/0", "(it divides by zero, or evaluates a function where it has no value)");
  expect("log(-1)*x", "(its values are complex numbers)");
  expect("x^99999", "(exponents are at most 300)");
  expect(std::string(500, '(') + "x", "(its brackets are nested too deeply)");
  expect("log(x - 5)", "'u' is not a finite number at (0.1");
  expect("sqrt(abs(x - 0.1))", "gradient, derived from 'u', is not a finite number at (0.1");
  expect("sin(1e12*x)", "changes too fast at (");
}

TEST(DerivedSolution, ReportsErrorsOfADiffusivity) {
  const auto expect = [](const std::string& diffusivity, const std::string& part) {
    EXPECT_THAT([&] { in_plane("x^2*y", diffusivity); },
                ThrowsMessage<InputError>(
                    AllOf(HasSubstr("the solution's 'diffusivity'"), HasSubstr(part))))
        << diffusivity;
  };
  expect("1, 2 ; 3", "is neither one formula nor 2 rows of 2 formulas: write it as 'a11, a12 ;");
  expect("1, 0", "is neither one formula nor 2 rows");
  expect("1, 0 ; , 1", "'diffusivity' is empty");
  expect("1, q ; 0, 1", "('q' at character 2 is not a variable");
  expect("2, x ; 0, 2", "is not symmetric at (0.1");
  expect("x", "is not positive definite at (-0.4");
  expect("1, 2 ; 2, 1", "is not positive definite at (0.1");
  expect("log(x + 1) + 3 + log(x + 0.4)", "is not a finite number at (-0.4");
}

TEST(DerivedSolution, RefusesDiscontinuousPieces) {
  const auto mesh = unit_square(7, Cells::quadrilaterals, 0.1);
  const auto aligned = unit_square(8, Cells::triangles, 0.0);  // with nodes where x = 1/2
  const auto refused = [&](const auto& on, const std::string& u, const std::string& a,
                           const std::string& part) {
    EXPECT_THAT([&] { check_pieces(in_plane(u, a), on); },
                ThrowsMessage<InputError>(HasSubstr(part)))
        << u;
  };
  for (const auto* on : {&mesh, &aligned}) {
    refused(*on, "if(x < 0.5, 0, 1)", "", "'u' jumps by 1.000000 at (0.5");
    refused(*on, "abs(x - 0.5)", "", "normal flux, diffusivity times derivative, jumps by 2.000");
    refused(*on, "x", "if(x < 0.5, 1, 2)", "normal flux");
    EXPECT_NO_THROW(check_pieces(in_plane("if(x < 0.5, 0, (x-0.5)^2)"), *on));
    EXPECT_NO_THROW(check_pieces(in_plane("abs(x + 1) + abs(y)"), *on)) << "outside";
    // A kink in u goes with a jump of A across, not along it.
    EXPECT_NO_THROW(
        check_pieces(in_plane("if(x < 0.5, 2*(x-0.5), x-0.5) + y", "if(x < 0.5, 1, 2)"), *on));
  }
}

}  // namespace
}  // namespace smoothfem
