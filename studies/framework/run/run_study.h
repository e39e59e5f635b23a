// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/definition/study.h"
#include "studies/framework/run/study_options.h"

namespace smoothfem {

/// Runs a study: meshes, then smoothing (one method at a time, nothing else running), then a finite
/// element record for every iteration that is to have one (planar meshes: on all cores; volume
/// meshes: on all ranks), and writes iterations.csv, summary.csv, thresholds.csv, provenance.json
/// and the resulting meshes. Every file appears in one piece; iterations.csv is written anew every
/// few seconds with the rows finished so far.
///
/// A run that has been killed at any moment goes on where it was when the same study is run into
/// the same folder, and ends with the same rows, times excepted; a complete one is left as it is.
/// If anything that determines the rows has changed, InputError says what. Numbers do not depend on
/// n_threads and smoothing_threads, and on the ranks only as far as the solvers' tolerances.
/// On ranks other than the root: does their part of the work. Throws InputError.
void run_study(const Study& study, const StudyOptions& options);

}  // namespace smoothfem
