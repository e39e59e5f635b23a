// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>

#include "studies/framework/results/results.h"
#include "studies/tests/documented_columns.h"

namespace smoothfem {
namespace {

TEST(ResultColumns, OfIterationsAreTheDocumentedOnes) {
  expect_documented("iterations.csv", iterations_csv("s", {}));
}
TEST(ResultColumns, OfSummaryAreTheDocumentedOnes) {
  expect_documented("summary.csv", summary_csv("s", {}));
}
TEST(ResultColumns, OfThresholdsAreTheDocumentedOnes) {
  expect_documented("thresholds.csv", thresholds_csv("s", {}));
}

IterationRow iteration_row(const std::string& method, std::size_t iteration, double seconds) {
  IterationRow row{
      .mesh = "tri", .method = method, .iteration = {}, .degree = 2, .solved = {}, .status = "ok"};
  row.iteration.stage = iteration == 0 ? "initial" : "stage";
  row.iteration.iteration = iteration;
  row.iteration.smoothing_seconds = seconds;
  return row;
}

SolutionRecord full_record() {
  SolutionRecord record;
  record.degree = 2;
  record.n_dofs = 9;
  record.n_free = 1;
  record.assembly_seconds = 5e-5;
  record.condition_number = 12.5;
  record.lambda_min = 0.1;
  record.lambda_max = 1.25;
  record.condition_method = "method";
  record.condition_residual = 2e-7;
  record.jacobi_condition_number = 7.25;
  record.cg_iterations = 7;
  record.jacobi_cg_iterations = 5;
  record.cg_seconds = 1e-5;
  record.jacobi_cg_seconds = 2e-5;
  record.amg_cg_iterations = 3;
  record.amg_setup_seconds = 3e-5;
  record.amg_cg_seconds = 4e-5;
  record.cg_converged = true;
  record.e_max = 1.0 / 3.0;
  record.e_mean = 5e-324;
  record.e_l2 = 1e300;
  record.e_h1 = 4.0;
  record.l2_error = 0.30000000000000004;
  record.h1_error = 6.0;
  record.l2_best = 0.25;
  record.h1_best = 5.5;
  record.status = "ok";
  return record;
}

TEST(IterationsCsv, EveryNumberStandsUnderItsNameAndReadsBackTheSame) {
  IterationRow row = iteration_row("getme", 3, 0.1);
  row.iteration.quality = {.q_min = 0.1, .q_star_min = 0.2, .q_mean = 2.0 / 3.0, .n_invalid = 0};
  row.iteration.n_reset = 4;
  row.iteration.n_made_invalid = 5;
  row.iteration.preparation_seconds = 0.25;
  row.iteration.wall_seconds = 0.5;
  row.iteration.solves = SolveEffort{.n_solves = 6, .seconds = 0.0625};
  row.warpage = MeshWarpage{.max = 0.75, .mean = 0.125, .n_faces = 3};
  row.solved = full_record();
  const auto fields = CsvTable(iterations_csv("study", {row})).rows.at(0);
  const CsvTable::Row expected_texts = {{"study", "study"},
                                        {"mesh", "tri"},
                                        {"method", "getme"},
                                        {"stage", "stage"},
                                        {"iteration", "3"},
                                        {"smoothing_seconds", "0.1"},
                                        {"preparation_seconds", "0.25"},
                                        {"wall_seconds", "0.5"},
                                        {"n_solves", "6"},
                                        {"method_solve_seconds", "0.0625"},
                                        {"q_min", "0.1"},
                                        {"q_star_min", "0.2"},
                                        {"n_invalid", "0"},
                                        {"n_made_invalid", "5"},
                                        {"n_reset", "4"},
                                        {"w_max", "0.75"},
                                        {"w_mean", "0.125"},
                                        {"degree", "2"},
                                        {"n_dofs", "9"},
                                        {"n_free", "1"},
                                        {"lambda_min", "0.1"},
                                        {"lambda_max", "1.25"},
                                        {"cg_iterations", "7"},
                                        {"cg_converged", "true"},
                                        {"jacobi_cg_iterations", "5"},
                                        {"condition_number", "12.5"},
                                        {"condition_method", "method"},
                                        {"amg_cg_iterations", "3"},
                                        {"status", "ok"}};
  for (const auto& [column, text] : expected_texts) EXPECT_EQ(fields.at(column), text) << column;
  const std::map<std::string, double> expected_numbers = {{"q_mean", 2.0 / 3.0},
                                                          {"e_max", 1.0 / 3.0},
                                                          {"e_mean", 5e-324},
                                                          {"e_l2", 1e300},
                                                          {"e_h1", 4.0},
                                                          {"l2_error", 0.30000000000000004},
                                                          {"h1_error", 6.0},
                                                          {"cg_seconds", 1e-5},
                                                          {"assembly_seconds", 5e-5},
                                                          {"jacobi_cg_seconds", 2e-5},
                                                          {"condition_residual", 2e-7},
                                                          {"jacobi_condition_number", 7.25},
                                                          {"l2_best", 0.25},
                                                          {"h1_best", 5.5},
                                                          {"amg_setup_seconds", 3e-5},
                                                          {"amg_cg_seconds", 4e-5}};
  for (const auto& [column, number] : expected_numbers)
    EXPECT_EQ(std::strtod(fields.at(column).c_str(), nullptr), number) << column;
  EXPECT_EQ(fields.size(), expected_texts.size() + expected_numbers.size());
  // The shortest form has no digits that come only from printing 17 digits.
  EXPECT_EQ(fields.at("l2_error"), "0.30000000000000004");
  EXPECT_EQ(fields.at("cg_seconds"), "1e-05");
}

TEST(IterationsCsv, MissingValuesAreEmpty) {
  IterationRow row = iteration_row("getme", 1, 0.5);
  row.status = "invalid mesh";
  auto fields = CsvTable(iterations_csv("study", {row})).rows.at(0);
  for (const std::string column : {"n_dofs",
                                   "n_free",
                                   "assembly_seconds",
                                   "condition_number",
                                   "condition_method",
                                   "lambda_min",
                                   "lambda_max",
                                   "condition_residual",
                                   "jacobi_condition_number",
                                   "cg_iterations",
                                   "cg_seconds",
                                   "cg_converged",
                                   "jacobi_cg_iterations",
                                   "jacobi_cg_seconds",
                                   "amg_cg_iterations",
                                   "amg_setup_seconds",
                                   "amg_cg_seconds",
                                   "e_max",
                                   "e_mean",
                                   "e_l2",
                                   "e_h1",
                                   "l2_error",
                                   "h1_error",
                                   "l2_best",
                                   "h1_best"})
    EXPECT_EQ(fields.at(column), "") << column;
  EXPECT_EQ(fields.at("degree"), "2");
  EXPECT_EQ(fields.at("status"), "invalid mesh");

  row.degree = 0;  // the study solves nothing
  EXPECT_EQ(CsvTable(iterations_csv("study", {row})).rows.at(0).at("degree"), "");

  row.degree = 1;
  row.solved = full_record();
  row.solved->condition_number = row.solved->lambda_min = row.solved->lambda_max = 0.0;
  row.solved->condition_method = "none";
  row.solved->jacobi_cg_iterations = row.solved->amg_cg_iterations = 0;
  fields = CsvTable(iterations_csv("study", {row})).rows.at(0);
  for (const std::string column :
       {"condition_number", "lambda_min", "lambda_max", "condition_residual",
        "jacobi_cg_iterations", "jacobi_cg_seconds", "amg_cg_iterations", "amg_setup_seconds",
        "amg_cg_seconds"})
    EXPECT_EQ(fields.at(column), "") << column;
  EXPECT_EQ(fields.at("cg_iterations"), "7");
}

TEST(IterationsCsv, CommasAndQuotesAreQuoted) {
  IterationRow row = iteration_row("getme", 1, 0.5);
  row.status = R"(says "no", twice)";
  const std::string text = iterations_csv("study", {row});
  EXPECT_NE(text.find(R"(,"says ""no"", twice")"), std::string::npos) << text;
  EXPECT_EQ(CsvTable(text).rows.at(0).at("status"), row.status);
}

TEST(SummaryCsv, TheInitialMeshHasNoIterationsAndNoTime) {
  SummaryRow initial{.mesh = "tri", .method = "initial"};
  initial.degree = 1;
  SummaryRow smoothed{.mesh = "tri",
                      .method = "getme",
                      .iterations = "40/2800",
                      .smoothing_seconds = 0.25,
                      .preparation_seconds = 0.125};
  smoothed.degree = 1;
  smoothed.peak_memory_gib = 1.5;
  smoothed.warpage = MeshWarpage{};  // no quadrilateral faces
  const CsvTable table(summary_csv("study", {initial, smoothed}));
  EXPECT_EQ(table.rows.at(0).at("iterations"), "");
  EXPECT_EQ(table.rows.at(0).at("smoothing_seconds"), "");
  EXPECT_EQ(table.rows.at(0).at("preparation_seconds"), "");
  EXPECT_EQ(table.rows.at(1).at("preparation_seconds"), "0.125");
  EXPECT_EQ(table.rows.at(1).at("iterations"), "40/2800");
  EXPECT_EQ(table.rows.at(1).at("smoothing_seconds"), "0.25");
  EXPECT_EQ(table.rows.at(0).at("peak_memory_gib"), "");
  EXPECT_EQ(table.rows.at(1).at("peak_memory_gib"), "1.5");
  EXPECT_EQ(table.rows.at(1).at("w_mean"), "");
}

TEST(SummaryCsv, CountsHaveAColumnForEachThreshold) {
  SummaryRow row{.mesh = "tri", .method = "getme"};
  row.cells_below = {{0.3, 7, 5}, {0.6619, 20, 18}};
  const CsvTable table(summary_csv("study", {row}));
  EXPECT_EQ(table.rows.at(0).at("n_below_0.3"), "7");
  EXPECT_EQ(table.rows.at(0).at("n_star_below_0.3"), "5");
  EXPECT_EQ(table.rows.at(0).at("n_below_0.6619"), "20");
  EXPECT_EQ(table.rows.at(0).at("n_star_below_0.6619"), "18");
}

/// Returns rows of a method at 0, 1, 2, ... seconds with these values of every error; NaN: invalid
/// mesh.
std::vector<IterationRow> curve(const std::string& method, const std::vector<double>& errors) {
  std::vector<IterationRow> rows;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    auto& row = rows.emplace_back(iteration_row(method, i, static_cast<double>(i)));
    if (std::isnan(errors[i])) {
      row.status = "invalid mesh";
      continue;
    }
    SolutionRecord record;
    record.e_max = record.e_mean = record.e_l2 = record.e_h1 = errors[i];
    record.l2_error = record.h1_error = errors[i];
    row.solved = record;
  }
  return rows;
}

std::vector<IterationRow> joined(std::vector<IterationRow> a, const std::vector<IterationRow>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

constexpr double invalid = std::numeric_limits<double>::quiet_NaN();

TEST(Thresholds, AreReachedByTheFirstRowBelowThem) {
  const auto rows = reach_thresholds(
      joined(curve("reference", {10, 4, 2, 2.1}), curve("other", {10, 2.15, 5, 1})), "reference",
      0.1);
  ASSERT_EQ(rows.size(), 6u) << "one for each error";
  for (const auto& row : rows) {
    EXPECT_EQ(row.mesh, "tri");
    EXPECT_EQ(row.degree, 2);
    EXPECT_EQ(row.reference_method, "reference");
    EXPECT_EQ(row.method, "other");
    EXPECT_DOUBLE_EQ(row.threshold, 2.2);
    EXPECT_EQ(row.reference_seconds, 2.0);
    EXPECT_EQ(row.method_seconds, 1.0) << "the first time below counts, even if it is left again";
  }
  EXPECT_EQ(rows[0].error, "e_max");
  EXPECT_EQ(rows[3].error, "e_h1");
  EXPECT_EQ(rows[5].error, "h1_error");
  const auto csv = CsvTable(thresholds_csv("study", rows)).rows.at(0);
  EXPECT_EQ(csv.at("speedup"), "2");
}

TEST(Thresholds, TheMarginMovesTheTimes) {
  const auto all = joined(curve("reference", {10, 4, 2}), curve("other", {10, 3.9, 1.9}));
  EXPECT_EQ(reach_thresholds(all, "reference", 0.0).at(0).method_seconds, 2.0);
  EXPECT_EQ(reach_thresholds(all, "reference", 1.0).at(0).method_seconds, 1.0);
  EXPECT_EQ(reach_thresholds(all, "reference", 1.0).at(0).reference_seconds, 1.0);
  EXPECT_EQ(reach_thresholds(all, "reference", 4.0).at(0).method_seconds, 0.0);
}

TEST(Thresholds, NeverReachedHaveNoTimeAndNoSpeedup) {
  const auto rows = reach_thresholds(
      joined(curve("reference", {10, 2}), curve("other", {10, 9, 8})), "reference", 0.05);
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_FALSE(rows[0].method_seconds);
  const auto csv = CsvTable(thresholds_csv("study", rows)).rows.at(0);
  EXPECT_EQ(csv.at("method_seconds"), "");
  EXPECT_EQ(csv.at("speedup"), "");
  EXPECT_EQ(csv.at("reference_seconds"), "1");
}

TEST(Thresholds, ReachedByTheInitialMeshHaveNoSpeedup) {
  const auto rows = reach_thresholds(joined(curve("reference", {10, 9.9}), curve("other", {10, 5})),
                                     "reference", 0.05);
  EXPECT_EQ(rows.at(0).method_seconds, 0.0);
  EXPECT_EQ(CsvTable(thresholds_csv("study", rows)).rows.at(0).at("speedup"), "");
}

TEST(Thresholds, SkipInvalidMeshes) {
  const auto rows = reach_thresholds(joined(curve("reference", {10, invalid, 2, invalid}),
                                            curve("other", {10, invalid, invalid, 1.5})),
                                     "reference", 0.0);
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0].reference_seconds, 2.0);
  EXPECT_EQ(rows[0].method_seconds, 3.0);
}

TEST(Thresholds, ErrorsOfOtherSolversHaveThem) {
  auto all = joined(curve("reference", {invalid, invalid, invalid}),
                    curve("other", {invalid, invalid, invalid}));
  const std::vector<double> errors{10, invalid, 4, 10, 3, 2};
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i].numbers = {{"plate.u_max", 1.0}, {"plate.energy_error", errors[i]}};
  const auto rows = reach_thresholds(all, "reference", 0.1);
  ASSERT_EQ(rows.size(), 1u) << "none of Poisson's equation, which has no numbers";
  EXPECT_EQ(rows[0].error, "plate.energy_error");
  EXPECT_DOUBLE_EQ(rows[0].threshold, 4.4);
  EXPECT_EQ(rows[0].reference_seconds, 2.0);
  EXPECT_EQ(rows[0].method_seconds, 1.0);
}

TEST(Thresholds, AreSetForEachMeshAndDegreeAlone) {
  auto all = joined(curve("reference", {10, 2}), curve("other", {10, 2}));
  auto coarse = joined(curve("reference", {10, 8}), curve("other", {10, 9}));
  for (auto& row : coarse) row.degree = 1;
  auto elsewhere = curve("other", {10, 2});  // no threshold without a reference row
  for (auto& row : elsewhere) row.mesh = "quad";
  const auto rows = reach_thresholds(joined(joined(all, coarse), elsewhere), "reference", 0.0);
  ASSERT_EQ(rows.size(), 12u);
  EXPECT_EQ(rows[0].degree, 2);
  EXPECT_EQ(rows[0].threshold, 2.0);
  EXPECT_EQ(rows[6].degree, 1);
  EXPECT_EQ(rows[6].threshold, 8.0);
  EXPECT_FALSE(rows[6].method_seconds);
}

}  // namespace
}  // namespace smoothfem
