#include "fem/manufactured_solution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

namespace smoothfem {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<Point<2>> sample{{0.1, 0.2}, {-0.4, 0.9}, {1.3, -0.7}};

TEST(ManufacturedSolutions, GradientAndLoadAreThoseOfTheValue) {
  constexpr double h = 1e-4;
  for (const auto& s : manufactured_solutions())
    for (const auto& p : sample) {
      const Point<2> dx(h, 0), dy(0, h);
      const double u = s.value(p);
      const Point<2> slope((s.value(p + dx) - s.value(p - dx)) / (2 * h),
                           (s.value(p + dy) - s.value(p - dy)) / (2 * h));
      const double laplacian =
          (s.value(p + dx) + s.value(p - dx) + s.value(p + dy) + s.value(p - dy) - 4 * u) / (h * h);
      EXPECT_LT((s.gradient(p) - slope).norm(), 1e-5) << s.name;
      EXPECT_NEAR(s.load(p), -laplacian, 1e-4) << s.name;
    }
}

TEST(ManufacturedSolutions, GearHasThePrintedFormula) {
  const auto& gear = manufactured_solution("gear");
  EXPECT_DOUBLE_EQ(gear.value({-1.0, 5.0}), 60.0);
  EXPECT_DOUBLE_EQ(gear.value({0.0, 1.0 + 3.14159265358979323846}), 100.0);
}

TEST(ManufacturedSolutions, UnknownNameListsTheKnownOnes) {
  EXPECT_THAT([] { manufactured_solution("gaer"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("gaer"), HasSubstr("gear"))));
}

TEST(ParsedSolution, AgreesWithTheSameFormulaInCode) {
  const auto parsed =
      parsed_solution("sin(pi*x)*sin(pi*y)", "pi*cos(pi*x)*sin(pi*y) ; pi*sin(pi*x)*cos(pi*y)",
                      "2*pi^2*sin(pi*x)*sin(pi*y)", sample);
  const auto& coded = manufactured_solution("sine");
  for (const auto& p : sample) {
    EXPECT_NEAR(parsed.value(p), coded.value(p), 1e-14);
    EXPECT_LT((parsed.gradient(p) - coded.gradient(p)).norm(), 1e-13);
    EXPECT_NEAR(parsed.load(p), coded.load(p), 1e-12);
  }
}

TEST(ParsedSolution, IsSafeInSeveralThreads) {
  const auto parsed = parsed_solution("x*x", "2*x ; 0", "-2", sample);
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

TEST(ParsedSolution, SaysWhatIsWrong) {
  EXPECT_THAT([] { parsed_solution("sin(", "0 ; 0", "0", sample); },
              ThrowsMessage<InputError>(HasSubstr("sin(")));
  EXPECT_THAT([] { parsed_solution("x*x", "x ; 0", "-2", sample); },
              ThrowsMessage<InputError>(HasSubstr("gradient")));
  EXPECT_THAT([] { parsed_solution("x*x", "2*x ; 0", "2", sample); },
              ThrowsMessage<InputError>(HasSubstr("-laplace")));
  EXPECT_THAT([] { parsed_solution("x*x", "2*x", "-2", sample); },
              ThrowsMessage<InputError>(HasSubstr("2*x")));
}

}  // namespace
}  // namespace smoothfem
