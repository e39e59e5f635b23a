// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/framework/run/table_study.h"
#include "studies/kinds/regularization/regularization.h"

namespace smoothfem {

/// A study of how fast transformations make random volume elements regular (thesis, Sections 3.2
/// and 3.3, Figures 3.4 and 3.8).
struct RegularizationStudy {
  StudyHeader header;
  std::vector<RegularizationSeries> series;
};

/// Reads a study file of kind `regularization`. Throws InputError as read_study does.
RegularizationStudy read_regularization_study(const std::filesystem::path& file,
                                              const std::string& scale = {});

/// Returns a commented study file with every key and its default.
std::string regularization_study_template();

/// Returns regularization.csv and validity.csv (studies/columns.json).
std::vector<StudyTable> regularization_tables(const RegularizationStudy& study);

}  // namespace smoothfem
