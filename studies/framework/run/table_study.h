// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "studies/framework/definition/study_header.h"
#include "studies/framework/run/study_options.h"

namespace smoothfem {

/// A CSV file of a study, and the function that computes its text.
struct StudyTable {
  std::string file;  ///< name in the folder of the results
  std::function<std::string()> compute;
};

/// Runs a study whose results are only tables. It computes one table after the other, writes each
/// as a whole, and writes provenance.json.
/// A complete run with the same parameters is left unchanged; an interrupted one starts anew.
/// Throws InputError for a folder that cannot be written, for results with other parameters in it,
/// for --mesh-dir, and for more than one process.
void run_table_study(const StudyHeader& study, const StudyOptions& options,
                     const std::vector<StudyTable>& tables);

}  // namespace smoothfem
