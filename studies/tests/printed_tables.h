// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "fem/poisson_solver.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/tests/shared_mesh.h"
#include "studies/framework/definition/study.h"
#include "studies/tests/study_tests.h"

namespace smoothfem {

/// The tables of the thesis (studies/thesis/) on the published meshes, if these are available.
class PrintedTables : public ::testing::Test {
 protected:
  /// Relative tolerances.
  struct Tolerances {
    double condition_number = 0.01;
    double cg_iterations = 0.03;
    double errors = 0.002;
  };

  void SetUp() override {
    for (const std::string mesh : {"tri", "quad"})
      if (test::shared_mesh(file_name(mesh)).empty())
        GTEST_SKIP() << test::how_to_get(file_name(mesh));
  }

  static std::string file_name(const std::string& mesh) { return "gear_" + mesh + "_initial.mesh"; }

  static PlanarMesh published(const std::string& mesh) {
    return read_planar(test::shared_mesh(file_name(mesh))).mesh;
  }

  /// Solves as the study `gear` does.
  static SolutionRecord solve(const PlanarMesh& mesh, int degree) {
    static const Study gear = read_study(std::filesystem::path(SMOOTHFEM_SOURCE_DIR) / "studies" /
                                         "catalogue" / "thesis" / "gear.prm");
    PoissonOptions options = gear.finite_elements;
    options.degree = degree;
    return PoissonSolver<2>(&mesh, options)
        .solve(mesh.coordinates(), manufactured_solution<2>(gear.solution.name));
  }

  static CsvTable::Row printed_row(const std::string& file, const CsvTable::Row& wanted) {
    std::ifstream stream(std::filesystem::path(SMOOTHFEM_SOURCE_DIR) / "studies" / "thesis" / file);
    const CsvTable table({std::istreambuf_iterator<char>(stream), {}});
    const auto rows = table.select(wanted);
    EXPECT_EQ(rows.size(), 1u) << file;
    return rows.empty() ? CsvTable::Row{} : rows.front();
  }

  static std::string four_digits(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4f", value);
    return text;
  }

  static void expect_printed_quality(const std::string& mesh, const std::string& method,
                                     const MeshQuality& quality) {
    const auto row = printed_row("table_6_1.csv", {{"mesh", mesh}, {"method", method}});
    EXPECT_EQ(four_digits(quality.q_min), row.at("q_min"));
    EXPECT_EQ(four_digits(quality.q_mean), row.at("q_mean"));
  }

  static void expect_near(double solved, double printed, double relative, double absolute,
                          const std::string& what) {
    EXPECT_NEAR(solved, printed, relative * printed + absolute) << what;
  }

  static void expect_printed_solution(const std::string& mesh, const std::string& method,
                                      int degree, const SolutionRecord& solved,
                                      const Tolerances& tolerances) {
    SCOPED_TRACE(mesh + " " + method + " of degree " + std::to_string(degree));
    EXPECT_EQ(solved.status, "ok");
    const CsvTable::Row key = {
        {"mesh", mesh}, {"method", method}, {"degree", std::to_string(degree)}};
    const auto solver = printed_row("table_6_2.csv", key);
    const double condition = std::stod(solver.at("condition_number"));
    if (method == "weighted-laplace") {
      // The printed value is about twice the matrices' condition number (deviations.csv). If the
      // two ever agree, that line is wrong.
      EXPECT_NEAR(solved.condition_number / condition, 0.5, 0.05);
    } else {
      expect_near(solved.condition_number, condition, tolerances.condition_number, 0.0,
                  "condition");
    }
    expect_near(static_cast<double>(solved.cg_iterations), std::stod(solver.at("cg_iterations")),
                tolerances.cg_iterations, 0.0, "cg_iterations");
    const auto errors = printed_row("table_6_3.csv", key);
    const std::map<std::string, double> values = {{"e_max", solved.e_max},
                                                  {"e_mean", solved.e_mean},
                                                  {"e_l2", solved.e_l2},
                                                  {"e_h1", solved.e_h1}};
    constexpr double half_a_unit = 0.5e-4;  // errors are printed with four digits
    for (const auto& [error, value] : values)
      expect_near(value, std::stod(errors.at(error)), tolerances.errors, half_a_unit, error);
  }
};

}  // namespace smoothfem
