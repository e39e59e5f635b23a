// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "meshes/io/mesh_file.h"
#include "meshes/tests/mesh_tests.h"
#include "studies/framework/results/csv_text.h"

namespace smoothfem {

/// A CSV text without line breaks in its fields, as one map from column to field for each line.
struct CsvTable {
  using Row = std::map<std::string, std::string>;

  std::vector<std::string> columns;
  std::vector<Row> rows;

  explicit CsvTable(const std::string& text) {
    EXPECT_TRUE(text.ends_with('\n')) << "the last line is not whole";
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    columns = csv_fields(line);
    while (std::getline(lines, line)) {
      const auto fields = csv_fields(line);
      EXPECT_EQ(fields.size(), columns.size()) << line;
      Row row;
      for (std::size_t i = 0; i < std::min(fields.size(), columns.size()); ++i)
        row[columns[i]] = fields[i];
      rows.push_back(row);
    }
  }

  /// Returns the rows whose columns have these values, in the order of the file.
  std::vector<Row> select(const Row& wanted) const {
    std::vector<Row> found;
    for (const auto& row : rows) {
      bool fits = true;
      for (const auto& [column, value] : wanted) fits = fits && row.at(column) == value;
      if (fits) found.push_back(row);
    }
    return found;
  }
};

/// Returns the rows of a study's table without the columns for times and memory.
inline std::vector<CsvTable::Row> rows_without_times(const std::filesystem::path& csv) {
  auto rows = CsvTable(content_of(csv)).rows;
  for (auto& row : rows)
    for (const std::string column :
         {"smoothing_seconds", "preparation_seconds", "wall_seconds", "method_solve_seconds",
          "reference_preparation_seconds", "method_preparation_seconds", "assembly_seconds",
          "cg_seconds", "jacobi_cg_seconds", "amg_setup_seconds", "amg_cg_seconds",
          "reference_seconds", "method_seconds", "speedup", "peak_memory_gib"})
      row.erase(column);
  return rows;
}

/// Returns every file below a folder, relative to it.
inline std::set<std::string> files_in(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::set<std::string> files;
  if (fs::exists(folder))
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file()) files.insert(fs::relative(entry.path(), folder).string());
  return files;
}

/// Expects that two runs of a study have the same rows and the same meshes.
inline void expect_same_but_for_times(const std::filesystem::path& a,
                                      const std::filesystem::path& b) {
  for (const std::string name : {"iterations.csv", "summary.csv", "thresholds.csv"})
    EXPECT_EQ(rows_without_times(a / name), rows_without_times(b / name)) << name;
  EXPECT_EQ(files_in(a), files_in(b));
  for (const auto& name : files_in(a))
    if (name.ends_with(".vtu") || name.ends_with(".mesh")) {
      EXPECT_EQ(content_of(a / name), content_of(b / name)) << name;
    }
}

/// Returns n x n unit squares whose inner nodes are moved randomly by up to `shift` in each
/// direction. Up to 0.2 all cells stay valid.
inline PlanarMesh shaken_grid(std::size_t n, double shift) {
  std::mt19937 random(7);
  const auto move = [&] { return shift * (2.0 * (random() / 4294967296.0) - 1.0); };
  std::vector<Point<2>> x;
  for (std::size_t j = 0; j <= n; ++j)
    for (std::size_t i = 0; i <= n; ++i) {
      const bool inner = i > 0 && j > 0 && i < n && j < n;
      const double dx = inner ? move() : 0.0, dy = inner ? move() : 0.0;
      x.emplace_back(static_cast<double>(i) + dx, static_cast<double>(j) + dy);
    }
  CompressedRows<NodeIndex> cells;
  const auto node = [n](std::size_t i, std::size_t j) {
    return static_cast<NodeIndex>(j * (n + 1) + i);
  };
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i)
      cells.append(
          std::vector<NodeIndex>{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
  return PlanarMesh(
      std::make_shared<const Topology>(2, x.size(), std::move(cells), std::nullopt, MeshLabels{}),
      x);
}

/// Returns an arrow head with one free node between its tip and its notch. The mean of the node's
/// neighbours is outside, beyond the notch, so Laplace smoothing makes the mesh invalid.
inline PlanarMesh arrow_head() {
  const std::vector<Point<2>> x = {{-3, 3}, {0, -1}, {3, 3}, {0, 0}, {0, -0.5}};
  CompressedRows<NodeIndex> cells;
  for (NodeIndex k = 0; k < 4; ++k)
    cells.append(std::vector<NodeIndex>{k, static_cast<NodeIndex>((k + 1) % 4), 4});
  return PlanarMesh(
      std::make_shared<const Topology>(2, x.size(), std::move(cells), std::nullopt, MeshLabels{}),
      x);
}

}  // namespace smoothfem
