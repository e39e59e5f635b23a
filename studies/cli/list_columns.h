// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace smoothfem {

/// Prints the columns of a CSV file of results with their meaning, unit and source
/// (studies/columns.json). An empty name prints those of all files. Throws InputError if results
/// have no such file.
void list_columns(const std::string& csv_file);

}  // namespace smoothfem
