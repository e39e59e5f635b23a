// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "studies/tests/study_tests.h"

namespace smoothfem {

/// The columns that results/README.md documents for a file: the first cells, in backticks, of the
/// table under the file's heading.
inline std::vector<std::string> documented_columns(const std::string& csv_file) {
  std::ifstream readme(std::filesystem::path(SMOOTHFEM_SOURCE_DIR) / "results" / "README.md");
  std::vector<std::string> columns;
  bool here = false;
  for (std::string line; std::getline(readme, line);) {
    if (line.starts_with("#")) here = line == "## " + csv_file;
    if (here && line.starts_with("| `")) columns.push_back(line.substr(3, line.find('`', 3) - 3));
  }
  return columns;
}

inline void expect_documented(const std::string& csv_file, const std::string& text) {
  EXPECT_EQ(CsvTable(text).columns, documented_columns(csv_file)) << csv_file;
}

}  // namespace smoothfem
