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
  bool needs_mpi = false;          ///< MPI has to be there, be it for one process
  bool benefits_from_mpi = false;  ///< more than one process makes it faster
  bool has_shards = false;         ///< can be run in parts, as StudyOptions::shard says
  std::function<void(const StudyOptions&)> run;
};

/// What the key `kind` of a study file chooses from. Each kind has its own keys and files of
/// results.
struct StudyKind {
  std::string name;
  ReadyStudy (*read)(const std::filesystem::path& file, const std::string& scale);
  std::string (*keys)();  ///< a commented study file with every key and its default
};
inline constexpr const char* default_study_kind = "smoothing";

/// Registers a kind when its file is loaded: a namespace-scope object at the end of a file in a
/// folder of studies/kinds/. A name that is taken is an InputError at the first look-up.
struct RegisteredStudyKind {
  explicit RegisteredStudyKind(StudyKind kind);
};

/// All registered kinds, sorted by name.
const std::vector<StudyKind>& study_kinds();

/// A study of a kind whose results are tables only.
ReadyStudy table_study(const StudyHeader& header, std::vector<StudyTable> tables);

/// Reads a study file of any kind; throws InputError as read_study does.
ReadyStudy read_any_study(const std::filesystem::path& file, const std::string& scale = {});

}  // namespace smoothfem
