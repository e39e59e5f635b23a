// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace smoothfem {

/// Prints the columns of a CSV file of results with their meaning, unit and source
/// (studies/columns.json); of all files if the name is empty. Throws InputError for a file that
/// results do not have.
void list_columns(const std::string& csv_file);

}  // namespace smoothfem
