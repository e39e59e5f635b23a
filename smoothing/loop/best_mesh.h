// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "smoothing/loop/smoother.h"

namespace smoothfem {

/// Remembers the best mesh of a stage, by the number that its traits name. may_be_invalid: a mesh
/// with invalid cells can be the best one.
template <int spacedim>
class BestMesh {
 public:
  BestMesh(ResultMesh rule, std::span<const Point<spacedim>> coordinates,
           const MeshQuality& quality, double score, bool may_be_invalid = false)
      : rule_(rule), may_be_invalid_(may_be_invalid) {
    if (rule_ == ResultMesh::last) return;
    best_ = number(quality, score);
    coordinates_.assign(coordinates.begin(), coordinates.end());
  }

  /// Offers the mesh that the step has just reached. Returns true if it is the new best.
  bool offer(std::span<const Point<spacedim>> coordinates, const MeshQuality& quality,
             const StepReport& report) {
    if (rule_ == ResultMesh::last) return false;
    if (report.moved)
      moved_since_best_.insert(moved_since_best_.end(), report.moved->begin(), report.moved->end());
    else
      all_moved_ = true;
    if (quality.n_invalid > 0 && !may_be_invalid_) return false;
    if (!(number(quality, report.score) > best_)) return false;
    best_ = number(quality, report.score);
    if (all_moved_)
      std::copy(coordinates.begin(), coordinates.end(), coordinates_.begin());
    else
      for (const NodeIndex i : moved_since_best_) coordinates_[i] = coordinates[i];
    moved_since_best_.clear();
    all_moved_ = false;
    return true;
  }

  /// Replaces the last mesh by the best one.
  template <class AnyMesh>
  void restore(AnyMesh& mesh) {
    if (rule_ != ResultMesh::last) mesh.swap_coordinates(coordinates_);
  }

 private:
  double number(const MeshQuality& quality, double score) const {
    if (rule_ == ResultMesh::best_score) return score;
    return rule_ == ResultMesh::best_q_mean ? quality.q_mean : quality.q_star_min;
  }

  ResultMesh rule_;
  bool may_be_invalid_;
  double best_ = 0.0;
  std::vector<Point<spacedim>> coordinates_;
  std::vector<NodeIndex> moved_since_best_;
  bool all_moved_ = false;
};

}  // namespace smoothfem
