#include "studies/framework/study_kinds.h"

#include "studies/framework/study_file.h"
#include "studies/framework/table_study.h"
#include "studies/polygons/polygon_study.h"

namespace smoothfem {

namespace {

ReadyStudy read_smoothing_study(const std::filesystem::path& file, const std::string& scale) {
  const Study study = read_study(file, scale);
  return {.name = study.name,
          .title = study.title,
          .on_ranks = study.dimension == 3,
          .ranks_pay = study.dimension == 3 && !study.degrees.empty(),
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

}  // namespace

const std::vector<StudyKind>& study_kinds() {
  static const std::vector<StudyKind> kinds{{"smoothing", read_smoothing_study, study_template},
                                            {"polygons", read_polygons, polygon_study_template}};
  return kinds;
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
