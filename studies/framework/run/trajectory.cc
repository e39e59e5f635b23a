// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/trajectory.h"

#include <algorithm>
#include <cmath>

#include "smoothing/parts/mesh_part.h"
#include "studies/framework/run/peak_memory.h"

namespace smoothfem {

namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// The times of several runs, for a whole run or up to one of its records.
class RecordTimes {
 public:
  template <class Timed>
  void add(const Timed& timed) {
    smoothing_.push_back(timed.smoothing_seconds);
    preparation_.push_back(timed.preparation_seconds);
  }
  void add(const IterationRecord& record) {
    add<IterationRecord>(record);
    if (record.solves) solves_.push_back(record.solves->seconds);
  }
  template <class Timed>
  void set_medians(Timed& timed) const {
    timed.smoothing_seconds = median(smoothing_);
    timed.preparation_seconds = median(preparation_);
  }
  void set_medians(IterationRecord& record) const {
    set_medians<IterationRecord>(record);
    if (record.solves) record.solves->seconds = median(solves_);
  }

 private:
  std::vector<double> smoothing_, preparation_, solves_;
};

/// Replaces times and memory by the largest of all ranks that have a part of the mesh.
void keep_largest(const MeshPart& part, Trajectory& trajectory) {
  std::vector<double*> numbers{&trajectory.smoothing_seconds, &trajectory.preparation_seconds,
                               &trajectory.peak_memory_gib};
  for (IterationRecord& record : trajectory.records)
    numbers.insert(numbers.end(), {&record.smoothing_seconds, &record.preparation_seconds});
  std::vector<double> values;
  for (const double* number : numbers) values.push_back(*number);
  part.max(values);
  for (std::size_t i = 0; i < numbers.size(); ++i) *numbers[i] = values[i];
}

/// The intervals after which records are due: 1, 2, ..., n_before_growth, then rarer and rarer.
class DueIntervals {
 public:
  /// True if a record is due after n intervals. Call it for ascending n.
  bool contain(std::size_t n, double growth) {
    while (next_ < n)
      next_ =
          next_ < RecordEvery::n_before_growth
              ? next_ + 1
              : std::max(next_ + 1,
                         static_cast<std::size_t>(std::ceil(growth * static_cast<double>(next_))));
    return next_ == n;
  }

 private:
  std::size_t next_ = 1;
};

/// Decides for each record whether it is kept. Records are due after intervals of k iterations,
/// counted in their stage if the stage has its own interval.
class Schedule {
 public:
  explicit Schedule(const RecordEvery& every) : every_(every) {}

  bool is_due(const IterationRecord& record) {
    if (record.stage != stage_) {
      n_in_stage_ = 0;
      due_in_stage_ = {};
    }
    stage_ = record.stage;
    ++n_in_stage_;
    const auto own = every_.stages.find(stage_);
    return own == every_.stages.end() ? is_due_after(record.record, every_.default_interval, due_)
                                      : is_due_after(n_in_stage_, own->second, due_in_stage_);
  }

 private:
  bool is_due_after(std::size_t n_iterations, int interval, DueIntervals& due) const {
    const auto k = static_cast<std::size_t>(interval);
    return n_iterations % k == 0 && due.contain(n_iterations / k, every_.growth);
  }

  const RecordEvery& every_;
  DueIntervals due_, due_in_stage_;
  std::string stage_;
  std::size_t n_in_stage_ = 0;
};

}  // namespace

template <int dim, int spacedim>
MeshWarpage warpage_of(const Mesh<dim, spacedim>& mesh) {
  if constexpr (dim == 3)
    if (mesh.topology().part() == nullptr) return mesh_warpage(mesh);
  return {};
}
template MeshWarpage warpage_of(const Mesh<2>&);
template MeshWarpage warpage_of(const Mesh<3>&);
template MeshWarpage warpage_of(const Mesh<2, 3>&);

namespace {

/// Returns the mesh as the method is to see it: with its rule for interfaces and its targets.
template <int dim, int spacedim>
Mesh<dim, spacedim> mesh_for(const StudyMethod& method, const Mesh<dim, spacedim>& mesh) {
  if constexpr (dim == spacedim) {
    const auto ruled = with_interface_rule(mesh, method.interfaces, false);
    return method.target ? with_initial_targets(ruled, *method.target) : ruled;
  } else {
    return with_interface_rule(mesh, method.interfaces);
  }
}

/// Returns the quality by the cells' own shapes, so that methods with and without targets compare.
template <int dim, int spacedim>
MeshQuality own_quality(const Mesh<dim, spacedim>& mesh, const MeshQuality& known) {
  if (mesh.targets() == nullptr) return known;
  return mesh_quality(without_targets(mesh));
}

}  // namespace

template <int dim, int spacedim>
Trajectory record_trajectory(const Mesh<dim, spacedim>& mesh, const StudyMethod& method,
                             const Study& study, bool only_results,
                             const std::shared_ptr<const Problem<spacedim>>& problem,
                             const SmootherFolders& folders,
                             const std::type_identity_t<KeepSnapshot<spacedim>>& keep,
                             const WatchIteration& watch) {
  Trajectory trajectory;
  std::vector<RecordTimes> times;
  RecordTimes totals;
  Schedule schedule(study.record_every);
  const bool keeps_all = keeps_all_records(study);
  std::vector<Point<spacedim>> last;
  const auto record_all = [&](const IterationRecord& record, const Mesh<dim, spacedim>& now) {
    watch(record);
    trajectory.records.push_back(record);
    trajectory.records.back().quality = own_quality(now, record.quality);
    times.emplace_back().add(record);
    if (study.record_warpage) trajectory.warpage_of_records.push_back(warpage_of(now));
    if (record.record == 0) return;
    if (!only_results && schedule.is_due(record)) {
      trajectory.snapshots.push_back(record.record);
      if (keeps_all) keep(record.record, now.coordinates());
    }
    if (keeps_all) last = now.copied_coordinates();
  };
  const PeakMemory memory;
  const Mesh<dim, spacedim> initial = mesh_for(method, mesh);
  Mesh<dim, spacedim> smoothed = initial;
  const auto make_method = [&] {
    auto made = method.make<dim, spacedim>();
    made.problem = problem;
    use_folders(made, folders);
    return made;
  };
  auto first = make_method();
  SmoothingResult result;
  try {
    result = smooth(smoothed, first, record_all);
  } catch (const SmootherFailure& failure) {
    trajectory.failure = failure.what();
    smoothed = initial;
    result.quality = trajectory.records.front().quality;
  }
  totals.add(result);
  trajectory.iterations_text = trajectory.failure.empty() ? result.iterations_text() : "0";
  trajectory.quality = own_quality(smoothed, result.quality);
  smoothed = Mesh<dim, spacedim>(mesh.shared_topology(), smoothed.copied_coordinates(),
                                 mesh.shared_constraints());
  trajectory.wall_seconds = trajectory.records[result.result_record].wall_seconds;
  trajectory.cells_below = count_cells_below(smoothed, study.count_below);
  trajectory.warpage = warpage_of(smoothed);
  trajectory.peak_memory_gib = memory.gib();
  trajectory.result_record = result.result_record;
  const auto also = [&](std::size_t record, std::span<const Point<spacedim>> coordinates) {
    auto& snapshots = trajectory.snapshots;
    const auto position = std::lower_bound(snapshots.begin(), snapshots.end(), record);
    if (record == 0 || (position != snapshots.end() && *position == record)) return;
    snapshots.insert(position, record);
    if (keeps_all) keep(record, coordinates);
  };
  also(trajectory.result_record, smoothed.coordinates());
  also(trajectory.records.size() - 1, last);
  if (!keeps_all && trajectory.result_record > 0)
    keep(trajectory.result_record, smoothed.coordinates());

  const int timing_runs = trajectory.failure.empty() ? study.timing_runs : 1;
  for (int run = 1; run < timing_runs; ++run) {
    Mesh<dim, spacedim> again = initial;
    auto made = make_method();
    totals.add(smooth(again, made, [&](const IterationRecord& record, const auto&) {
      watch(record);
      times[record.record].add(record);
    }));
  }
  totals.set_medians(trajectory);
  for (std::size_t r = 0; r < trajectory.records.size(); ++r)
    times[r].set_medians(trajectory.records[r]);
  if (const MeshPart* part = mesh.topology().part()) keep_largest(*part, trajectory);
  return trajectory;
}

template Trajectory record_trajectory(const Mesh<2>&, const StudyMethod&, const Study&, bool,
                                      const std::shared_ptr<const Problem<2>>&,
                                      const SmootherFolders&, const KeepSnapshot<2>&,
                                      const WatchIteration&);
template Trajectory record_trajectory(const Mesh<3>&, const StudyMethod&, const Study&, bool,
                                      const std::shared_ptr<const Problem<3>>&,
                                      const SmootherFolders&, const KeepSnapshot<3>&,
                                      const WatchIteration&);
template Trajectory record_trajectory(const Mesh<2, 3>&, const StudyMethod&, const Study&, bool,
                                      const std::shared_ptr<const Problem<3>>&,
                                      const SmootherFolders&, const KeepSnapshot<3>&,
                                      const WatchIteration&);

}  // namespace smoothfem
