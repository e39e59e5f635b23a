// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/tests/printed_tables.h"

namespace smoothfem {
namespace {

TEST_F(PrintedTables, InitialMeshesAgreeWithTable61) {
  for (const std::string mesh : {"tri", "quad"})
    expect_printed_quality(mesh, "initial", mesh_quality(published(mesh)));
}

using Case = std::tuple<std::string, std::string>;

/// One method on one mesh: Table 6.1 by smoothing, Tables 6.2 and 6.3 by solving on the result.
class PrintedRows : public PrintedTables, public ::testing::WithParamInterface<Case> {};

TEST_P(PrintedRows, AreReproduced) {
  const auto [mesh_name, method_name] = GetParam();
  PlanarMesh mesh = published(mesh_name);
  Method<2> method = make_method<2>(method_name);
  const SmoothingResult result = smooth(mesh, method);
  expect_printed_quality(mesh_name, method_name, result.quality);
  // An optimizer's iterations depend on its implementation (deviations.csv). The other methods are
  // formulas.
  if (method_name != "global-optimization") {
    EXPECT_EQ(result.iterations_text(),
              printed_row("table_6_1.csv", {{"mesh", mesh_name}, {"method", method_name}})
                  .at("iterations"));
  }
  for (const int degree : {1, 2})
    expect_printed_solution(mesh_name, method_name, degree, solve(mesh, degree), {});
}

INSTANTIATE_TEST_SUITE_P(Published, PrintedRows,
                         ::testing::Combine(::testing::Values("tri", "quad"),
                                            ::testing::Values("weighted-laplace", "smart-laplace",
                                                              "global-optimization", "getme")),
                         [](const auto& test) {
                           std::string name = std::get<0>(test.param) + std::get<1>(test.param);
                           std::erase(name, '-');
                           return name;
                         });

class PrintedInitialRows : public PrintedTables,
                           public ::testing::WithParamInterface<std::pair<std::string, int>> {};

TEST_P(PrintedInitialRows, AreReproduced) {
  const auto [mesh, degree] = GetParam();
  // With condition numbers up to 1e8, rounding changes the counts by a few percent.
  expect_printed_solution(mesh, "initial", degree, solve(published(mesh), degree),
                          {.cg_iterations = 0.06});
}

INSTANTIATE_TEST_SUITE_P(Published, PrintedInitialRows,
                         ::testing::Values(std::pair{"tri", 1}, std::pair{"quad", 1},
                                           std::pair{"quad", 2}),
                         [](const auto& test) {
                           return test.param.first + std::to_string(test.param.second);
                         });

}  // namespace
}  // namespace smoothfem
