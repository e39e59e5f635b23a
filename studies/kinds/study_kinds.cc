// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/study_kinds.h"

#include "smoothing/base/find_named.h"
#include "studies/framework/definition/study_file.h"
#include "studies/framework/run/run_study.h"
#include "studies/framework/run/table_study.h"
#include "studies/kinds/polygons/polygon_study.h"
#include "studies/kinds/regularization/regularization_study.h"

namespace smoothfem {

namespace {

ReadyStudy read_smoothing_study(const std::filesystem::path& file, const std::string& scale) {
  const Study study = read_study(file, scale);
  const bool solves_in_space = study.dimensions.cells == 3 && !study.degrees.empty();
  return {.header = study.header,
          .on_ranks = solves_in_space,
          .benefits_from_mpi = solves_in_space,
          .run = [study](const StudyOptions& options) { run_study(study, options); }};
}

/// Of a kind that computes tables.
ReadyStudy table_study(const StudyHeader& header, const std::vector<StudyTable>& tables) {
  return {.header = header, .run = [header, tables](const StudyOptions& options) {
            run_table_study(header, options, tables);
          }};
}

ReadyStudy read_polygons(const std::filesystem::path& file, const std::string& scale) {
  const PolygonStudy study = read_polygon_study(file, scale);
  return table_study(study.header, polygon_tables(study));
}

ReadyStudy read_regularization(const std::filesystem::path& file, const std::string& scale) {
  const RegularizationStudy study = read_regularization_study(file, scale);
  return table_study(study.header, regularization_tables(study));
}

}  // namespace

const std::vector<StudyKind>& study_kinds() {
  static const std::vector<StudyKind> kinds{
      {"smoothing", read_smoothing_study, study_template},
      {"polygons", read_polygons, polygon_study_template},
      {"regularization", read_regularization, regularization_study_template}};
  return kinds;
}

ReadyStudy read_any_study(const std::filesystem::path& file, const std::string& scale) {
  dealii::ParameterHandler p;
  p.declare_entry("kind", study_kinds().front().name);
  parse_study(p, read_study_text(file), file, true);
  const auto& kind = in_file(file, [&]() -> const StudyKind& {
    return find_named("kind of study", p.get("kind"), study_kinds(),
                      [](const StudyKind& one) { return one.name; });
  });
  return kind.read(file, scale);
}

}  // namespace smoothfem
