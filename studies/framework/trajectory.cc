#include "studies/framework/trajectory.h"

#include <algorithm>

namespace smoothfem {

namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace

Trajectory record_trajectory(const PlanarMesh& mesh, const StudyMethod& method, int timing_runs,
                             int record_every) {
  Trajectory trajectory;
  std::vector<std::vector<Point<2>>> all;  // coordinates of every record
  std::vector<std::vector<double>> times;
  std::vector<double> totals;
  const auto keep_all = [&](const IterationRecord& record, const PlanarMesh& now) {
    trajectory.records.push_back(record);
    all.push_back(now.coordinates());
    times.push_back({record.smoothing_seconds});
  };
  PlanarMesh smoothed = mesh;
  Method<2> first = method.make();
  const auto result = smooth(smoothed, first, keep_all);
  totals.push_back(result.smoothing_seconds);
  trajectory.iterations_text = result.iterations_text();
  trajectory.quality = result.quality;

  for (int run = 1; run < timing_runs; ++run) {
    PlanarMesh again = mesh;
    Method<2> made = method.make();
    totals.push_back(smooth(again, made, [&](const IterationRecord& record, const PlanarMesh&) {
                       times[record.record].push_back(record.smoothing_seconds);
                     }).smoothing_seconds);
  }
  trajectory.smoothing_seconds = median(totals);
  for (std::size_t r = 0; r < trajectory.records.size(); ++r)
    trajectory.records[r].smoothing_seconds = median(times[r]);

  for (std::size_t r = 0; r < all.size(); ++r)
    if (all[r] == smoothed.coordinates()) trajectory.result_record = r;
  for (std::size_t r = 1; r < all.size(); ++r)
    if (r % static_cast<std::size_t>(record_every) == 0 || r == trajectory.result_record ||
        r + 1 == all.size())
      trajectory.snapshots.push_back({r, std::move(all[r])});
  return trajectory;
}

}  // namespace smoothfem
