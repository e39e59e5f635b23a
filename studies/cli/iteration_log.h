// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "studies/framework/results/results.h"

namespace smoothfem {

/// A table like iterations.csv that grows by a row after each iteration. The file is complete after
/// each row, whatever ends the process later. Rows of an earlier run can be kept, so that their
/// finite element numbers need not be computed again.
class IterationLog {
 public:
  /// resumes: reads the rows that the file has. Throws InputError if it has other columns.
  IterationLog(std::filesystem::path path, bool resumes);

  /// True if the file has the next row already: of the same iteration, with the same quality, and
  /// with the same solver (Poisson's or none).
  bool has(const IterationRow& row) const;
  /// True if the file has a next row.
  bool has_rows_left() const;
  /// True if the file's next row has numbers where this one has, and only there.
  bool fills_columns_of_next(const IterationRow& row) const;
  /// Takes that row as it is.
  void keep();
  /// Adds a row in the place of the next one and all after it, and writes the file. Throws
  /// InputError.
  void add(const IterationRow& row);

  /// Removes rows of the earlier run that this one does not have.
  void finish();

  /// Returns a number of the next row of the file; nothing if there is none.
  std::optional<double> number_of_next(const std::string& column) const;
  std::size_t n_kept() const { return n_kept_; }

 private:
  void write() const;

  std::filesystem::path path_;
  std::vector<std::string> rows_;     ///< so far
  std::vector<std::string> earlier_;  ///< rows of the file
  std::size_t n_kept_ = 0;
};

}  // namespace smoothfem
