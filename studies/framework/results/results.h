// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fem/solution_record.h"
#include "meshes/metrics/metric_statistics.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/quality/warpage.h"

namespace smoothfem {

/// Numbers of solvers other than Poisson's, by their columns "LABEL.NUMBER"; NaN: not known.
using SolverNumbers = std::vector<std::pair<std::string, double>>;

/// A row of iterations.csv: one iteration of one method on one mesh, at one degree.
struct IterationRow {
  std::string mesh, method;
  IterationRecord iteration;
  std::optional<MeshWarpage> warpage{};  ///< if recorded
  int degree = 0;                        ///< 0: none of its solvers has degrees
  std::optional<SolutionRecord>
      solved;          ///< of Poisson's equation; empty where there is no solution
  std::string status;  ///< "ok", or why a row has no finite element numbers
  SolverNumbers numbers{};
};

/// A row of refined.csv: the initial mesh or a method's result with every cell split, at one
/// degree.
struct RefinedRow {
  std::string mesh, method;
  int degree = 0;
  std::optional<SolutionRecord> solved;  ///< empty where there is no solution
  std::string status;                    ///< as in the other rows
};

/// A row of solutions.csv: the initial mesh or a method's result with one of the study's solutions,
/// at one degree.
struct SolutionRow {
  std::string mesh, method, solution;
  int degree = 0;
  std::optional<SolutionRecord> solved;  ///< empty where there is no solution
  std::string status;                    ///< as in the other rows
};

/// A row of metrics.csv: a metric of the mesh after one iteration of one method.
struct MetricRow {
  std::string mesh, method, stage;
  std::size_t iteration = 0;
  bool larger_is_better = true;
  MetricStatistics statistics;
};

/// A row of summary.csv: a method's result on one mesh, at one degree.
struct SummaryRow {
  std::string mesh, method;
  std::string iterations{};  ///< "40/2800"; empty for the initial mesh
  double smoothing_seconds = 0.0;
  double preparation_seconds = 0.0;
  std::optional<double> wall_seconds{};  ///< of the external program's run, if one made the mesh
  MeshQuality quality{};
  std::vector<CellsBelow> cells_below{};    ///< for the same thresholds in all rows
  std::optional<MeshWarpage> warpage{};     ///< of volume meshes
  std::optional<double> peak_memory_gib{};  ///< of the process while the method ran
  int degree = 0;
  std::optional<SolutionRecord> solved{};
  std::string status{};
  SolverNumbers numbers{};
};

/// A row of thresholds.csv: the time when a method's error fell below a threshold, if it did.
struct ThresholdRow {
  std::string mesh;
  int degree = 0;
  std::string error;
  double threshold = 0.0;
  std::string reference_method;
  std::optional<double> reference_seconds;  ///< of its main loops, as method_seconds
  std::string method;
  std::optional<double> method_seconds;
  double reference_preparation_seconds = 0.0, method_preparation_seconds = 0.0;
};

/// Returns when each method first comes below the thresholds (thesis, Table 6.4). On each mesh,
/// degree and error, the threshold is the reference's smallest error increased by the margin.
/// Errors are those of Poisson's equation, and numbers of other solvers whose names end with
/// "error".
std::vector<ThresholdRow> reach_thresholds(const std::vector<IterationRow>& rows,
                                           const std::string& reference, double margin);

/// Return the tables as text. Columns, units and order are a contract (studies/columns.json).
/// Columns of further solvers come last, in the order in which rows name them.
std::string iterations_csv(const std::string& study, const std::vector<IterationRow>& rows);
std::string refined_csv(const std::string& study, const std::vector<RefinedRow>& rows);
std::string solutions_csv(const std::string& study, const std::vector<SolutionRow>& rows);
std::string metrics_csv(const std::string& study, const std::vector<MetricRow>& rows);
std::string summary_csv(const std::string& study, const std::vector<SummaryRow>& rows);
std::string thresholds_csv(const std::string& study, const std::vector<ThresholdRow>& rows);

}  // namespace smoothfem
