// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "fem/ranks/mpi_session.h"
#include "studies/framework/run/study_options.h"
#include "studies/kinds/collection/member_row.h"
#include "studies/kinds/collection/member_study.h"

namespace smoothfem {

/// Works on members in a process that does nothing else.
class MemberWorker {
 public:
  /// options: of the collection. mpi: the process's, begun when a solve needs it; it must outlive
  /// this.
  MemberWorker(const Collection& collection, const StudyOptions& options, RunUntil until,
               std::optional<MpiSession>& mpi);

  /// Goes on with the member's study up to the end of the phase. Returns what there is to know of
  /// its mesh, for add_facts, or nothing. Throws InputError for members that cannot be used.
  std::string run(const Member& member);

 private:
  std::filesystem::path folder_of(const Member& member) const;
  /// What another member with the same mesh has in its folder, if one has come to this status.
  std::optional<std::filesystem::path> at_another(const Member& member, const std::string& status,
                                                  const std::filesystem::path& name) const;
  bool share_mesh(const Member& member) const;
  void share_smoothing(const Member& member, const Study& study) const;

  const Collection& collection_;
  std::filesystem::path out_;
  StudyOptions options_;  ///< of members
  std::optional<MpiSession>& mpi_;
};

/// Adds to a row what a worker has found out of the mesh.
void add_facts(const std::string& facts, MemberRow& row);

}  // namespace smoothfem
