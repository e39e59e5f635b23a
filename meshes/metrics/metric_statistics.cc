// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/metrics/metric_statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace smoothfem {

double quantile(std::span<const double> ascending, double fraction) {
  assert(!ascending.empty() && fraction >= 0.0 && fraction <= 1.0);
  const double position = fraction * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  const double part = position - static_cast<double>(below);
  return ascending[below] + part * (ascending[above] - ascending[below]);
}

MetricStatistics metric_statistics(const Metric& metric, const MeshReference& mesh) {
  std::vector<double> values = metric.values(mesh);
  std::erase_if(values, [](double value) { return std::isnan(value); });
  MetricStatistics statistics{.metric = metric.name, .n_cells = values.size()};
  if (values.empty()) return statistics;
  std::sort(values.begin(), values.end());
  statistics.min = values.front();
  statistics.p05 = quantile(values, 0.05);
  statistics.median = quantile(values, 0.5);
  statistics.mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  statistics.p95 = quantile(values, 0.95);
  statistics.max = values.back();
  return statistics;
}

std::vector<MetricStatistics> metric_statistics(const std::vector<const Metric*>& metrics,
                                                const MeshReference& mesh) {
  std::vector<MetricStatistics> statistics;
  for (const Metric* metric : metrics) statistics.push_back(metric_statistics(*metric, mesh));
  return statistics;
}

}  // namespace smoothfem
