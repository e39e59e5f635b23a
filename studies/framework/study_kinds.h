// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "studies/framework/run_study.h"

namespace smoothfem {

/// A study of any kind, read and checked, ready to be run.
struct ReadyStudy {
  std::string name, title;
  std::string note{};      ///< what can be compared with the literature
  bool on_ranks = false;   ///< shares its work among processes: MPI has to be there
  bool ranks_pay = false;  ///< more than one process makes it faster
  std::function<void(const StudyOptions&)> run;
};

/// What the key `kind` of a study file chooses from. Each kind has its own keys and files of
/// results.
struct StudyKind {
  std::string name;
  ReadyStudy (*read)(const std::filesystem::path& file, const std::string& scale);
  std::string (*keys)();  ///< a commented study file with every key and its default
};
const std::vector<StudyKind>& study_kinds();

/// The study files in a folder, sorted by name; none if it is not there.
std::vector<std::filesystem::path> study_files(const std::filesystem::path& folder);

/// Reads a study file of any kind; throws InputError as read_study does.
ReadyStudy read_any_study(const std::filesystem::path& file, const std::string& scale = {});

}  // namespace smoothfem
