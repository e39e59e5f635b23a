// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/study_kinds.h"

#include <algorithm>

#include "studies/framework/study_file.h"
#include "studies/framework/table_study.h"
#include "studies/polygons/polygon_study.h"
#include "studies/regularization/regularization_study.h"

namespace smoothfem {

namespace {

ReadyStudy read_smoothing_study(const std::filesystem::path& file, const std::string& scale) {
  const Study study = read_study(file, scale);
  const bool solves_in_space = study.dimensions.cells == 3 && !study.degrees.empty();
  return {.name = study.name,
          .title = study.title,
          .note = study.note,
          .on_ranks = solves_in_space,
          .ranks_pay = solves_in_space,
          .run = [study](const StudyOptions& options) { run_study(study, options); }};
}

/// Of a kind that computes tables.
ReadyStudy table_study(const Study& facts, const std::vector<StudyTable>& tables) {
  return {.name = facts.name,
          .title = facts.title,
          .run = [facts, tables](const StudyOptions& options) {
            run_table_study(facts, options, tables);
          }};
}

ReadyStudy read_polygons(const std::filesystem::path& file, const std::string& scale) {
  const PolygonStudy study = read_polygon_study(file, scale);
  return table_study(study.facts, polygon_tables(study));
}

ReadyStudy read_regularization(const std::filesystem::path& file, const std::string& scale) {
  const RegularizationStudy study = read_regularization_study(file, scale);
  return table_study(study.facts, regularization_tables(study));
}

}  // namespace

const std::vector<StudyKind>& study_kinds() {
  static const std::vector<StudyKind> kinds{
      {"smoothing", read_smoothing_study, study_template},
      {"polygons", read_polygons, polygon_study_template},
      {"regularization", read_regularization, regularization_study_template}};
  return kinds;
}

std::vector<std::filesystem::path> study_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::is_directory(folder)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".prm") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

ReadyStudy read_any_study(const std::filesystem::path& file, const std::string& scale) {
  dealii::ParameterHandler p;
  p.declare_entry("kind", study_kinds().front().name);
  parse_study(p, read_study_text(file), file, true);
  const std::string wanted = p.get("kind");
  std::vector<std::string> names;
  for (const auto& kind : study_kinds()) {
    if (kind.name == wanted) return kind.read(file, scale);
    names.push_back(kind.name);
  }
  throw InputError(file.string() + ": there is no kind of study '" + wanted + "'; " +
                   choose_one_of(names));
}

}  // namespace smoothfem
