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
  /// options: those of the collection. mpi: the process's MPI, started when a solve needs it; it
  /// must outlive this object.
  MemberWorker(const Collection& collection, const StudyOptions& options, RunUntil until,
               std::optional<MpiSession>& mpi);

  /// Resumes the member's study up to the end of the phase. Returns facts about its mesh for
  /// add_facts, or nothing. Throws InputError for members that cannot be used.
  std::string run(const Member& member);

 private:
  const Collection& collection_;
  std::filesystem::path out_;
  StudyOptions options_;  ///< of members
  std::optional<MpiSession>& mpi_;
};

/// Adds a worker's facts about the mesh to a row.
void add_facts(const std::string& facts, MemberRow& row);

}  // namespace smoothfem
