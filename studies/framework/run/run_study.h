// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/definition/study.h"
#include "studies/framework/run/study_options.h"

namespace smoothfem {

/// Runs a study in three phases: meshes; then smoothing, one method at a time with nothing else
/// running; then finite element records. Planar meshes are solved on all cores, volume meshes on
/// all ranks.
/// It writes iterations.csv, summary.csv, thresholds.csv, provenance.json and the resulting meshes.
/// Every file is written as a whole. iterations.csv is rewritten every few seconds with the rows
/// finished so far.
///
/// A killed run resumes when the same study is run into the same folder, and ends with the same
/// rows except for times. A complete run is left unchanged. If anything that determines the rows
/// has changed, an InputError says what.
/// Numbers do not depend on n_threads and smoothing_threads. They depend on the ranks only within
/// the solvers' tolerances.
/// Ranks other than the root do their part of the work. Throws InputError.
void run_study(const Study& study, const StudyOptions& options);

}  // namespace smoothfem
