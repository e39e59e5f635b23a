// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fem/constraints/node_ties.h"
#include "smoothing/mesh/mesh.h"
#include "studies/framework/results/mesh_facts.h"
#include "studies/framework/run/trajectory.h"

/// Names of results that a study keeps. A name is a digest of everything that determines the
/// numbers of a result, and of the sources of this program. Equal names mean equal numbers. Labels
/// and titles do not count.

namespace smoothfem {

/// Returns the name of a mesh that is generated or distorted. source_sha256: of its file; empty if
/// it is generated. edge_scale: of the whole study.
std::string kept_mesh_name(const StudyMesh& description, const std::string& source_sha256,
                           double edge_scale);

/// Returns a digest of a mesh: its nodes, cells, labels and what nodes may do.
template <int dim, int spacedim>
std::string mesh_content(const Mesh<dim, spacedim>& mesh, const MeshFacts& facts);

/// Returns the name of a method's trajectory on a mesh. mesh_content: as above. only_results: see
/// record_trajectory. threads: of smoothing; the times depend on them.
std::string trajectory_name(const std::string& mesh_content, const StudyMethod& method,
                            const Study& study, bool only_results, unsigned int threads);

/// Returns digests of a snapshot, and of a trajectory's snapshots. contents: of the snapshots, by
/// record; snapshots that are not kept have none.
std::string content_of(const std::vector<double>& coordinates);
std::string content_of(const Trajectory& trajectory,
                       const std::map<std::size_t, std::string>& contents);

/// What a set of finite element records is made of.
struct SolvedFrom {
  std::string mesh_content;  ///< of the initial mesh
  std::string trajectory;    ///< Trajectory::content; empty: the initial mesh
  int degree = 1;
  bool is_refined = false;
  bool is_further = false;  ///< of a further solution: results only
  const NodeTies* ties = nullptr;
  const StudySolver* solver = nullptr;  ///< null: Poisson's equation
};
/// Returns the name of the records of a solver.
std::string solved_name(const SolvedFrom& from, const StudySolution& solution, const Study& study);

/// Returns a digest of everything else that determines the rows of a study: all but its meshes.
std::string rows_digest(const Study& study, unsigned int smoothing_threads);

}  // namespace smoothfem
