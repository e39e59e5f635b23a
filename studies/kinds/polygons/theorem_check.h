// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "studies/kinds/polygons/polygon_study.h"
#include "studies/kinds/polygons/random_polygons.h"

namespace smoothfem {

/// A row of theorems.csv: a theorem's value of a quantity, and the measured value of many random
/// polygons. All numbers are those of the worst case.
struct TheoremRow {
  std::string theorem, statement, quantity;
  std::size_t cases = 0;
  double measured = 0.0, expected = 0.0;
  double max_deviation = 0.0;  ///< of measured from expected; for bounds: the excess
  double tolerance = 0.0;      ///< for rounding and a finite number of steps
  bool holds = true;
};

/// Collects the cases of one row.
class TheoremCheck {
 public:
  TheoremCheck(std::string theorem, std::string statement, std::string quantity, double tolerance) {
    row_.theorem = std::move(theorem);
    row_.statement = std::move(statement);
    row_.quantity = std::move(quantity);
    row_.tolerance = tolerance;
  }

  void equal(double measured, double expected) {
    add(measured, expected, std::abs(measured - expected), true);
  }
  void at_most(double measured, double bound) { add(measured, bound, measured - bound, true); }
  void above(double measured, double bound) {
    add(measured, bound, bound - measured, measured > bound);
  }
  TheoremRow row() const { return row_; }

 private:
  void add(double measured, double expected, double deviation, bool allowed) {
    if (!(deviation <= row_.tolerance && allowed)) row_.holds = false;  // also if not a number
    if (row_.cases++ > 0 && !(deviation > worst_)) return;
    worst_ = deviation;
    row_.measured = measured;
    row_.expected = expected;
    row_.max_deviation = std::max(0.0, deviation);
  }

  TheoremRow row_;
  double worst_ = 0.0;
};

inline double as_double(std::size_t k) {
  return static_cast<double>(k);
}

/// Calls visit(random numbers) for every case of a check. Each check has its own random stream.
template <class Visit>
void for_cases(const PolygonStudy& study, std::uint64_t stream, const Visit& visit) {
  for (std::size_t i = 0; i < study.cases; ++i) {
    SplitMix64 random = counter_random(study.seed, stream, i);
    visit(random);
  }
}

/// Calls visit(n, random numbers) for every case and number of nodes.
template <class Visit>
void for_polygons(const PolygonStudy& study, std::uint64_t stream, const Visit& visit) {
  for (const std::size_t n : study.nodes)
    for_cases(study, stream + 1000 * n, [&](SplitMix64& random) { visit(n, random); });
}

/// Check the theorems of Sections 2.1, 2.2 and 2.3 of the thesis.
std::vector<TheoremRow> triangle_theorems(const PolygonStudy& study);
std::vector<TheoremRow> isosceles_theorems(const PolygonStudy& study);
std::vector<TheoremRow> combined_theorems(const PolygonStudy& study);

}  // namespace smoothfem
