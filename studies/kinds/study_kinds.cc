// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/study_kinds.h"

#include <utility>

#include "smoothing/base/registry.h"
#include "studies/framework/definition/study_file.h"

namespace smoothfem {

namespace {

Registry<StudyKind>& registry() {
  static Registry<StudyKind> kinds("study kind");
  return kinds;
}

}  // namespace

RegisteredStudyKind::RegisteredStudyKind(StudyKind kind) {
  registry().add(std::move(kind));
}

const std::vector<StudyKind>& study_kinds() {
  return registry().all();
}

ReadyStudy read_any_study(const std::filesystem::path& file, const std::string& scale) {
  dealii::ParameterHandler p;
  p.declare_entry("kind", default_study_kind);
  parse_study(p, StudyText(file), true);
  const auto& kind =
      in_file(file, [&]() -> const StudyKind& { return registry().find(p.get("kind")); });
  return kind.read(file, scale);
}

StudySummary read_summary(const std::filesystem::path& file) {
  dealii::ParameterHandler p;
  p.declare_entry("title", "");
  p.declare_entry("note", "");
  parse_study(p, StudyText(file), true);
  const std::string name = file.stem().string();
  return {name, p.get("title").empty() ? name : p.get("title"), p.get("note")};
}

ReadyStudy table_study(const StudyHeader& header, std::vector<StudyTable> tables) {
  return {.header = header,
          .run = [header, tables = std::move(tables)](const StudyOptions& options) {
            run_table_study(header, options, tables);
          }};
}

}  // namespace smoothfem
