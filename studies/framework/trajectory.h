#pragma once

#include <string>
#include <vector>

#include "smoothing/loop/smooth.h"
#include "studies/framework/study.h"

namespace smoothfem {

/// Everything that smoothing one mesh by one method went through: the numbers of every iteration,
/// and the coordinates of those at which finite elements will be solved.
struct Trajectory {
  struct Snapshot {
    std::size_t record;  ///< index into records
    std::vector<Point<2>> coordinates;
  };

  std::vector<IterationRecord> records;  ///< the initial mesh first
  std::vector<Snapshot> snapshots;       ///< ascending records
  std::size_t result_record = 0;         ///< whose mesh is the method's result
  std::string iterations_text;           ///< "40/2800"
  double smoothing_seconds = 0.0;        ///< of the whole run
  MeshQuality quality;                   ///< of the result
};

/// Runs a method timing_runs times on copies of the mesh, on this thread alone, and keeps the
/// median of the accumulated times of each record; the meshes are the same every time. Snapshots:
/// every record_every-th record but the initial one, the result and the last.
Trajectory record_trajectory(const PlanarMesh& mesh, const StudyMethod& method, int timing_runs,
                             int record_every);

}  // namespace smoothfem
