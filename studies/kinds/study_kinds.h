// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "studies/framework/definition/study_header.h"
#include "studies/framework/run/study_options.h"
#include "studies/framework/run/table_study.h"

namespace smoothfem {

/// A study of any kind, read and checked, ready to be run.
struct ReadyStudy {
  StudyHeader header;
  bool needs_mpi = false;                ///< needs MPI, even for one process
  bool benefits_from_mpi = false;        ///< more than one process makes it faster
  bool has_shards = false;               ///< can be run in parts (StudyOptions::shard)
  std::vector<std::string> published{};  ///< sets of published meshes that it needs
  std::function<void(const StudyOptions&)> run;
};

/// A value of the key `kind` of a study file. Each kind has its own keys and results files.
struct StudyKind {
  std::string name;
  ReadyStudy (*read)(const std::filesystem::path& file, const std::string& scale);
  std::string (*keys)();  ///< a commented study file with every key and its default
};
inline constexpr const char* default_study_kind = "smoothing";

/// Registers a kind when its file is loaded. It is a namespace-scope object at the end of a file in
/// a folder of studies/kinds/. If a name is taken, the first look-up throws InputError.
struct RegisteredStudyKind {
  explicit RegisteredStudyKind(StudyKind kind);
};

/// Returns all registered kinds, sorted by name.
const std::vector<StudyKind>& study_kinds();

/// Makes a study of a kind whose results are tables only.
ReadyStudy table_study(const StudyHeader& header, std::vector<StudyTable> tables);

/// Reads a study file of any kind. Throws InputError as read_study does.
ReadyStudy read_any_study(const std::filesystem::path& file, const std::string& scale = {});

/// What lists of studies say of a study file.
struct StudySummary {
  std::string name, title, note;
};
/// Reads that alone, which takes a hundredth of the time. Throws InputError.
StudySummary read_summary(const std::filesystem::path& file);

}  // namespace smoothfem
