// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "meshes/doctor/finding.h"

namespace smoothfem {

/// Prints to standard error what reading has changed.
void print_notes(const std::string& path, const std::vector<std::string>& notes);

/// Prints a warning for each finding to standard error.
void warn_about(const std::string& path, const std::vector<Finding>& findings);

/// Returns a finding as `check --json` shows it.
nlohmann::ordered_json json_of(const Finding& finding);

/// Adds --keep-orientation to a command.
void add_keep_orientation(CLI::App& command, bool& keeps);

}  // namespace smoothfem
