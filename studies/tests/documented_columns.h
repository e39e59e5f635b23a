// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "studies/tests/study_tests.h"

namespace smoothfem {

/// Returns the columns of a CSV file in the order of studies/columns.json; empty for an
/// undocumented file.
inline std::vector<std::string> documented_columns(const std::string& csv_file) {
  std::ifstream text(std::filesystem::path(SMOOTHFEM_SOURCE_DIR) / "studies" / "columns.json");
  const auto files = nlohmann::json::parse(text).at("files");
  if (!files.contains(csv_file)) return {};
  return files.at(csv_file).at("columns").get<std::vector<std::string>>();
}

inline void expect_documented(const std::string& csv_file, const std::string& text) {
  EXPECT_EQ(CsvTable(text).columns, documented_columns(csv_file)) << csv_file;
}

}  // namespace smoothfem
