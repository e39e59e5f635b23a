// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/results/results.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <tuple>

#include "smoothing/base/text.h"
#include "studies/framework/results/csv_text.h"

namespace smoothfem {

namespace {

constexpr const char* solution_columns =
    "degree,n_dofs,n_free,assembly_seconds,condition_number,condition_method,lambda_min,lambda_max,"
    "condition_residual,jacobi_condition_number,cg_iterations,cg_seconds,cg_converged,jacobi_cg_"
    "iterations,"
    "jacobi_cg_seconds,amg_cg_iterations,amg_setup_seconds,amg_cg_seconds,e_max,e_mean,e_l2,e_h1,"
    "l2_error,h1_error,l2_best,h1_best,status";
constexpr int n_solution_numbers = 25;  ///< between degree and status

/// Returns the names of two columns for each threshold.
std::string count_columns(const std::vector<CellsBelow>& counts) {
  std::string columns;
  for (const CellsBelow& count : counts) {
    std::string threshold;
    append_number(threshold, count.threshold);
    columns += ",n_below_" + threshold + ",n_star_below_" + threshold;
  }
  return columns;
}

void add_quality(CsvText& csv, const MeshQuality& quality) {
  csv.number(quality.q_min).number(quality.q_star_min).number(quality.q_mean);
  csv.integer(quality.n_invalid);
}

/// Adds the warpage, or empty fields if there are no quadrilateral faces.
void add_warpage(CsvText& csv, const std::optional<MeshWarpage>& warpage) {
  const bool known = warpage && warpage->n_faces > 0;
  csv.number(known ? std::optional(warpage->max) : std::nullopt);
  csv.number(known ? std::optional(warpage->mean) : std::nullopt);
}

void add_solution(CsvText& csv, int degree, const std::optional<SolutionRecord>& solved,
                  const std::string& status) {
  csv.field(degree > 0 ? std::to_string(degree) : "");
  if (!solved) {
    for (int i = 0; i < n_solution_numbers; ++i) csv.field("");
    csv.field(status);
    return;
  }
  const SolutionRecord& s = *solved;
  const auto if_known = [](double value) {
    return value > 0.0 ? std::optional<double>(value) : std::nullopt;
  };
  csv.integer(s.n_dofs).integer(s.n_free).number(s.assembly_seconds);
  csv.number(if_known(s.condition_number));
  csv.field(s.condition_method).number(if_known(s.lambda_min)).number(if_known(s.lambda_max));
  csv.number(s.condition_number > 0.0 ? std::optional(s.condition_residual) : std::nullopt);
  csv.number(if_known(s.jacobi_condition_number));
  csv.integer(s.cg_iterations).number(s.cg_seconds).field(s.cg_converged ? "true" : "false");
  if (s.jacobi_cg_iterations > 0)
    csv.integer(s.jacobi_cg_iterations).number(s.jacobi_cg_seconds);
  else
    csv.field("").field("");
  if (s.amg_cg_iterations > 0)
    csv.integer(s.amg_cg_iterations).number(s.amg_setup_seconds).number(s.amg_cg_seconds);
  else
    csv.field("").field("").field("");
  csv.number(s.e_max).number(s.e_mean).number(s.e_l2).number(s.e_h1);
  csv.number(s.l2_error).number(s.h1_error);
  csv.number(if_known(s.l2_best)).number(if_known(s.h1_best)).field(status);
}

/// The columns of further solvers, of all rows.
class SolverColumns {
 public:
  template <class Row>
  explicit SolverColumns(const std::vector<Row>& rows) {
    for (const auto& row : rows)
      for (const auto& [column, value] : row.numbers)
        if (places_.emplace(column, names_.size()).second) names_.push_back(column);
  }

  /// Returns ",a,b".
  std::string header() const {
    std::string text;
    for (const auto& name : names_) text += "," + name;
    return text;
  }

  const std::vector<std::string>& names() const { return names_; }

  void add(CsvText& csv, const SolverNumbers& numbers) const {
    std::vector<std::optional<double>> values(names_.size());
    for (const auto& [column, value] : numbers)
      if (!std::isnan(value)) values[places_.at(column)] = value;
    for (const auto& value : values) csv.number(value);
  }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::size_t> places_;
};

/// An error that has thresholds. value: of a row; NaN where it is not known.
struct NamedError {
  std::string name;
  std::function<double(const IterationRow&)> value;
};

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Returns Poisson's errors, then the numbers of other solvers whose names end with "error".
std::vector<NamedError> threshold_errors(const std::vector<IterationRow>& rows) {
  std::vector<NamedError> errors;
  const auto add = [&](const char* name, double SolutionRecord::*error) {
    errors.push_back({name, [error](const IterationRow& row) {
                        return row.solved ? (*row.solved).*error : unknown;
                      }});
  };
  add("e_max", &SolutionRecord::e_max);
  add("e_mean", &SolutionRecord::e_mean);
  add("e_l2", &SolutionRecord::e_l2);
  add("e_h1", &SolutionRecord::e_h1);
  add("l2_error", &SolutionRecord::l2_error);
  add("h1_error", &SolutionRecord::h1_error);
  const SolverColumns solver_columns(rows);
  for (const auto& column : solver_columns.names())
    if (column.ends_with("error"))
      errors.push_back({column, [column](const IterationRow& row) {
                          const auto found = std::ranges::find(row.numbers, column,
                                                               &SolverNumbers::value_type::first);
                          return found == row.numbers.end() ? unknown : found->second;
                        }});
  return errors;
}

using Curve = std::vector<const IterationRow*>;  ///< one method's solved rows, in time

/// Returns the least error of a curve; NaN if none is known.
double least_of(const Curve& curve, const NamedError& error) {
  double least = unknown;
  for (const auto* row : curve) least = std::fmin(least, error.value(*row));
  return least;
}

std::optional<double> first_time_below(const Curve& curve, const NamedError& error,
                                       double threshold) {
  for (const auto* row : curve)
    if (error.value(*row) <= threshold) return row->iteration.smoothing_seconds;
  return std::nullopt;
}

double preparation_of(const Curve& curve) {
  return curve.back()->iteration.preparation_seconds;
}

}  // namespace

std::vector<ThresholdRow> reach_thresholds(const std::vector<IterationRow>& rows,
                                           const std::string& reference, double margin) {
  // The groups have the order of the rows: meshes, then degrees, then methods.
  std::vector<std::pair<std::string, int>> groups;
  std::map<std::pair<std::string, int>, std::vector<std::pair<std::string, Curve>>> curves;
  for (const auto& row : rows) {
    if (!row.solved && row.numbers.empty()) continue;
    const std::pair key(row.mesh, row.degree);
    auto& methods = curves[key];
    if (methods.empty()) groups.push_back(key);
    auto found = methods.begin();
    while (found != methods.end() && found->first != row.method) ++found;
    if (found == methods.end()) found = methods.insert(methods.end(), {row.method, {}});
    found->second.push_back(&row);
  }
  std::vector<ThresholdRow> result;
  const auto errors = threshold_errors(rows);
  for (const auto& group : groups) {
    const auto& methods = curves[group];
    for (const auto& error : errors) {
      for (const auto& [reference_name, reference_curve] : methods) {
        if (reference_name != reference) continue;
        const double least = least_of(reference_curve, error);
        if (std::isnan(least)) continue;
        const double threshold = (1.0 + margin) * least;
        for (const auto& [method, curve] : methods)
          if (method != reference)
            result.push_back({group.first, group.second, error.name, threshold, reference,
                              first_time_below(reference_curve, error, threshold), method,
                              first_time_below(curve, error, threshold),
                              preparation_of(reference_curve), preparation_of(curve)});
      }
    }
  }
  return result;
}

std::string iterations_csv(const std::string& study, const std::vector<IterationRow>& rows) {
  const SolverColumns solver_columns(rows);
  CsvText csv(
      std::string("study,mesh,method,stage,iteration,smoothing_seconds,preparation_seconds,"
                  "wall_seconds,n_solves,method_solve_seconds,q_min,q_star_min,q_mean,n_invalid,"
                  "n_made_invalid,n_reset,w_max,w_mean,") +
      solution_columns + solver_columns.header());
  for (const auto& row : rows) {
    csv.field(study).field(row.mesh).field(row.method).field(row.iteration.stage);
    csv.integer(row.iteration.iteration).number(row.iteration.smoothing_seconds);
    csv.number(row.iteration.preparation_seconds).number(row.iteration.wall_seconds);
    if (const auto& solves = row.iteration.solves)
      csv.integer(solves->n_solves).number(solves->seconds);
    else
      csv.field("").field("");
    add_quality(csv, row.iteration.quality);
    if (row.iteration.n_made_invalid)
      csv.integer(*row.iteration.n_made_invalid);
    else
      csv.field("");
    csv.integer(row.iteration.n_reset);
    add_warpage(csv, row.warpage);
    add_solution(csv, row.degree, row.solved, row.status);
    solver_columns.add(csv, row.numbers);
    csv.end_line();
  }
  return csv.text();
}

std::string refined_csv(const std::string& study, const std::vector<RefinedRow>& rows) {
  CsvText csv(std::string("study,mesh,method,") + solution_columns);
  for (const auto& row : rows) {
    csv.field(study).field(row.mesh).field(row.method);
    add_solution(csv, row.degree, row.solved, row.status);
    csv.end_line();
  }
  return csv.text();
}

std::string solutions_csv(const std::string& study, const std::vector<SolutionRow>& rows) {
  CsvText csv(std::string("study,mesh,method,solution,") + solution_columns);
  for (const auto& row : rows) {
    csv.field(study).field(row.mesh).field(row.method).field(row.solution);
    add_solution(csv, row.degree, row.solved, row.status);
    csv.end_line();
  }
  return csv.text();
}

std::string metrics_csv(const std::string& study, const std::vector<MetricRow>& rows) {
  CsvText csv(
      "study,mesh,method,stage,iteration,metric,better,n_cells,min,p05,median,mean,p95,max");
  for (const auto& row : rows) {
    const MetricStatistics& s = row.statistics;
    csv.field(study).field(row.mesh).field(row.method).field(row.stage).integer(row.iteration);
    csv.field(s.metric).field(row.larger_is_better ? "larger" : "smaller").integer(s.n_cells);
    for (const double value : {s.min, s.p05, s.median, s.mean, s.p95, s.max}) csv.number(value);
    csv.end_line();
  }
  return csv.text();
}

std::string summary_csv(const std::string& study, const std::vector<SummaryRow>& rows) {
  const SolverColumns solver_columns(rows);
  CsvText csv(
      std::string("study,mesh,method,iterations,smoothing_seconds,preparation_seconds,"
                  "wall_seconds,q_min,q_star_min,q_mean,n_invalid,w_max,w_mean,peak_memory_gib,") +
      solution_columns + (rows.empty() ? "" : count_columns(rows.front().cells_below)) +
      solver_columns.header());
  for (const auto& row : rows) {
    csv.field(study).field(row.mesh).field(row.method).field(row.iterations);
    if (row.iterations.empty())
      csv.field("").field("");
    else
      csv.number(row.smoothing_seconds).number(row.preparation_seconds);
    csv.number(row.wall_seconds);
    add_quality(csv, row.quality);
    add_warpage(csv, row.warpage);
    csv.number(row.peak_memory_gib);
    add_solution(csv, row.degree, row.solved, row.status);
    for (const CellsBelow& count : row.cells_below) csv.integer(count.n).integer(count.n_star);
    solver_columns.add(csv, row.numbers);
    csv.end_line();
  }
  return csv.text();
}

std::string thresholds_csv(const std::string& study, const std::vector<ThresholdRow>& rows) {
  CsvText csv(
      "study,mesh,degree,error,threshold,reference_method,reference_seconds,method,"
      "method_seconds,speedup,reference_preparation_seconds,method_preparation_seconds");
  for (const auto& row : rows) {
    std::optional<double> speedup;
    if (row.reference_seconds && row.method_seconds && *row.method_seconds > 0.0)
      speedup = *row.reference_seconds / *row.method_seconds;
    csv.field(study).field(row.mesh).field(std::to_string(row.degree)).field(row.error);
    csv.number(row.threshold).field(row.reference_method).number(row.reference_seconds);
    csv.field(row.method).number(row.method_seconds).number(speedup);
    csv.number(row.reference_preparation_seconds).number(row.method_preparation_seconds);
    csv.end_line();
  }
  return csv.text();
}

}  // namespace smoothfem
