// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/cli/iteration_log.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "meshes/io/atomic_file.h"
#include "meshes/io/line_reader.h"
#include "studies/framework/results/csv_text.h"

namespace smoothfem {

namespace {

/// Returns the lines of a text.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

const std::string& columns() {
  static const std::string line = lines_of(iterations_csv("smooth", {})).front();
  return line;
}

std::size_t place_of(const std::string& column) {
  const auto names = csv_fields(columns());
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), column) - names.begin());
}

std::string line_of(const IterationRow& row) {
  return lines_of(iterations_csv("smooth", {row}))[1];
}

/// Returns the fields that do not change if a command runs again: all but times, up to the degree.
std::vector<std::string> lasting_fields(const std::string& line) {
  auto fields = csv_fields(line);
  fields.resize(place_of("degree") + 1);
  for (const char* time :
       {"smoothing_seconds", "preparation_seconds", "wall_seconds", "method_solve_seconds"})
    fields[place_of(time)].clear();
  return fields;
}

}  // namespace

IterationLog::IterationLog(std::filesystem::path path, bool resumes) : path_(std::move(path)) {
  if (!resumes || !std::filesystem::exists(path_)) return;
  earlier_ = lines_of(read_whole_file(path_));
  if (earlier_.empty() || earlier_.front() != columns())
    throw InputError(path_.string() +
                     " is not a log of this version, so that --resume cannot go on with it; "
                     "leave --resume out, or give another file name");
  earlier_.erase(earlier_.begin());
  const std::size_t n_fields = csv_fields(columns()).size();
  std::erase_if(earlier_,
                [&](const std::string& line) { return csv_fields(line).size() != n_fields; });
}

bool IterationLog::has(const IterationRow& row) const {
  return has_rows_left() && lasting_fields(line_of(row)) == lasting_fields(earlier_[rows_.size()]);
}

void IterationLog::keep() {
  rows_.push_back(earlier_[rows_.size()]);
  ++n_kept_;
}

void IterationLog::add(const IterationRow& row) {
  rows_.push_back(line_of(row));
  write();
}

void IterationLog::finish() {
  if (has_rows_left() && n_kept_ == rows_.size()) write();
}

void IterationLog::write() const {
  std::string text = columns() + "\n";
  for (const auto& line : rows_) text += line + "\n";
  write_atomically(path_, text);
}

bool IterationLog::has_rows_left() const {
  return rows_.size() < earlier_.size();
}

bool IterationLog::fills_columns_of_next(const IterationRow& row) const {
  if (!has_rows_left()) return false;
  const auto given = csv_fields(line_of(row)), earlier = csv_fields(earlier_[rows_.size()]);
  return std::equal(given.begin(), given.end(), earlier.begin(), earlier.end(),
                    [](const auto& a, const auto& b) { return a.empty() == b.empty(); });
}

std::optional<double> IterationLog::number_of_next(const std::string& column) const {
  if (!has_rows_left()) return {};
  const std::string field = csv_fields(earlier_[rows_.size()])[place_of(column)];
  if (field.empty()) return {};
  return std::strtod(field.c_str(), nullptr);
}

}  // namespace smoothfem
