// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "meshes/metrics/metric.h"

namespace smoothfem {

/// Statistics of a metric's values over the cells of a mesh.
struct MetricStatistics {
  std::string metric;
  std::size_t n_cells = 0;  ///< cells that have a value; the numbers below are 0 if there are none
  double min = 0.0, p05 = 0.0, median = 0.0, mean = 0.0, p95 = 0.0, max = 0.0;
};

/// Returns the value below which a fraction in [0, 1] of ascending values lies. It is interpolated
/// between the two at position fraction * (n - 1), counted from 0. Requires at least one value.
double quantile(std::span<const double> ascending, double fraction);

MetricStatistics metric_statistics(const Metric& metric, const MeshReference& mesh);

/// Returns the statistics of each metric.
std::vector<MetricStatistics> metric_statistics(const std::vector<const Metric*>& metrics,
                                                const MeshReference& mesh);

}  // namespace smoothfem
