// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/polygons/limit_polygons.h"
#include "studies/framework/results/csv_text.h"
#include "studies/kinds/polygons/classification.h"
#include "studies/kinds/polygons/pictures.h"
#include "studies/kinds/polygons/theorem_check.h"
#include "studies/kinds/study_kinds.h"

namespace smoothfem {

namespace {

std::string theorems_csv(const PolygonStudy& study) {
  CsvText csv("theorem,statement,quantity,cases,measured,expected,max_deviation,tolerance,holds");
  for (const auto& theorems : {triangle_theorems, isosceles_theorems, combined_theorems})
    for (const TheoremRow& row : theorems(study)) {
      csv.field(row.theorem).field(row.statement).field(row.quantity).integer(row.cases);
      csv.number(row.measured).number(row.expected).number(row.max_deviation);
      csv.number(row.tolerance).field(row.holds ? "true" : "false").end_line();
    }
  return csv.text();
}

/// Returns the pairs of a grid, and for each of its angles the points on the lines S_k.
std::vector<std::pair<double, double>> classified_parameters(const PolygonStudy& study,
                                                             std::size_t n) {
  // Closer to lambda = 1 the transformation is nearly the identity, and would need too many
  // iterations.
  constexpr double border = 1e-5;
  std::vector<std::pair<double, double>> pairs;
  for (std::size_t i = 0; i < study.theta_points; ++i) {
    const double theta = grid_point(i, study.theta_points, 0.5 * pi);
    for (std::size_t j = 0; j < study.lambda_points; ++j)
      pairs.emplace_back(theta, grid_point(j, study.lambda_points, 1.0));
    for (std::size_t k = 0; k < n / 2; ++k) {
      const double lambda = intersection_line(n, 2 * k + 1, theta);
      if (lambda > border && lambda < 1.0 - border) pairs.emplace_back(theta, lambda);
    }
  }
  return pairs;
}

std::string classification_csv(const PolygonStudy& study) {
  CsvText csv("n,theta,lambda,predicted,iterated,agree,predicted_growth,iterated_growth");
  for (const std::size_t n : study.nodes) {
    std::uint64_t number = 0;
    for (const auto& [theta, lambda] : classified_parameters(study, n)) {
      const ClassificationRow row = classify_by_iteration(
          n, theta, lambda, study.doublings, counter_random(study.seed, n, number++).next());
      csv.integer(row.n).number(row.theta).number(row.lambda).field(row.predicted);
      csv.field(row.iterated).field(row.agree() ? "true" : "false");
      csv.number(row.predicted_growth).number(row.iterated_growth).end_line();
    }
  }
  return csv.text();
}

}  // namespace

std::vector<StudyTable> polygon_tables(const PolygonStudy& study) {
  const auto table = [&study](const std::string& file, std::string (*text)(const PolygonStudy&)) {
    return StudyTable{file, [study, text] { return text(study); }};
  };
  return {table("decomposition.csv", decomposition_csv),
          table("domains.csv", domains_csv),
          table("limits.csv", limits_csv),
          table("sequences.csv", sequences_csv),
          table("side_ratios.csv", side_ratios_csv),
          table("theorems.csv", theorems_csv),
          table("classification.csv", classification_csv)};
}

namespace {

ReadyStudy read(const std::filesystem::path& file, const std::string& scale) {
  const PolygonStudy study = read_polygon_study(file, scale);
  return table_study(study.header, polygon_tables(study));
}

const RegisteredStudyKind polygons_kind({"polygons", read, polygon_study_template});

}  // namespace

}  // namespace smoothfem
