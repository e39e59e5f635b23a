// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace smoothfem {

/// Returns the names of the sets of published meshes, sorted. Each has a catalogue
/// studies/published/NAME.json in the data folder.
std::vector<std::string> published_sets();

/// Returns the files of a set, as NAME/PATH below the folder of published meshes, with their
/// families. Throws InputError that lists the names, and for a damaged catalogue.
std::map<std::filesystem::path, std::string> published_meshes(const std::string& name);

/// Returns the study that runs on a set: the built-in one of the name STUDY-SET. Throws InputError
/// that lists the sets of the study.
std::string study_on_published_set(const std::string& study, const std::string& set);

}  // namespace smoothfem
