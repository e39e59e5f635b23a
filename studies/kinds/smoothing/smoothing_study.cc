// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/run_study.h"
#include "studies/framework/run/solve_workers.h"
#include "studies/kinds/study_kinds.h"

namespace smoothfem {

namespace {

ReadyStudy read_smoothing_study(const std::filesystem::path& file, const std::string& scale) {
  const Study study = read_study(file, scale);
  const bool solves_in_space = study.dimensions.cells == 3 && !study.degrees.empty();
  return {.header = study.header,
          .needs_mpi = needs_mpi(study),
          .benefits_from_mpi = solves_in_space || study.in_parts,
          .run = [study](const StudyOptions& options) { run_study(study, options); }};
}

const RegisteredStudyKind smoothing_kind({default_study_kind, read_smoothing_study,
                                          study_template});

}  // namespace

}  // namespace smoothfem
