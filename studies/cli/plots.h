// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace smoothfem {

/// Returns a command for /bin/sh that starts the Python package `plots` with these words. Throws
/// InputError if the program's data are missing.
std::string plots_command(const std::vector<std::string>& words);

}  // namespace smoothfem
