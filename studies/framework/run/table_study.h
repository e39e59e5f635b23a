// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "studies/framework/definition/study_header.h"
#include "studies/framework/run/study_options.h"

namespace smoothfem {

/// A CSV file of a study, and what computes its text.
struct StudyTable {
  std::string file;  ///< name in the folder of the results
  std::function<std::string()> compute;
};

/// Runs a study whose results are tables and nothing else: computes one after the other and writes
/// each in one piece, and provenance.json. A complete run with the same parameters is left as it
/// is; one that was interrupted starts anew. Throws InputError for a folder that cannot be written,
/// for results of other parameters in it, for --mesh-dir, and for more than one process.
void run_table_study(const StudyHeader& study, const StudyOptions& options,
                     const std::vector<StudyTable>& tables);

}  // namespace smoothfem
