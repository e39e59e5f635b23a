// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/collection/member_row.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "meshes/io/atomic_file.h"
#include "smoothing/base/input_error.h"
#include "studies/framework/results/csv_text.h"
#include "studies/kinds/collection/definition/collection.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

constexpr const char* row_file = "member.csv";
constexpr const char* made_by_file = "made-by.txt";

std::string header(const std::vector<std::string>& columns) {
  std::string text;
  for (const auto& column : columns) text += (text.empty() ? "" : ",") + column;
  return text;
}

void add_fields(CsvText& csv, const std::vector<std::string>& columns, const MemberRow& row) {
  for (const auto& column : columns) {
    const auto found = row.find(column);
    std::string value = found == row.end() ? "" : found->second;
    std::replace(value.begin(), value.end(), '\n', ' ');  // of a file's name; rows are lines
    csv.field(value);
  }
}

std::string leading_fields(const MemberRow& row) {
  CsvText csv("");
  add_fields(csv, leading_columns(), row);
  return csv.text().substr(1);  // without the empty header
}

/// True for the column of a solver that is not Poisson's. A member has none of a solver that failed
/// on all its meshes.
bool is_of_solver(const std::string& column) {
  return column.find('.') != std::string::npos && !column.starts_with("n_below_") &&
         !column.starts_with("n_star_below_");
}

/// One table of all members, written one line at a time.
class CollectedTable {
 public:
  CollectedTable(const fs::path& out, const std::string& name) : out_(out), name_(name) {}

  void write(const std::vector<MemberRow>& rows, const fs::path& file) {
    for (const auto& row : rows)
      if (row.at("status") == member_complete) add_columns(row);
    std::ofstream stream(file, std::ios::binary);
    bool has_header = false;
    for (const auto& row : rows) {
      if (row.at("status") != member_complete) continue;
      if (!has_header) stream << header(leading_columns()) << ',' << header(columns_) << '\n';
      has_header = true;
      append(row, stream);
    }
    stream.flush();
    if (!stream)
      throw InputError("cannot write " + (out_ / name_).string() + "; is the disk full?");
  }

 private:
  fs::path path_of(const MemberRow& row) const {
    return member_folder(out_, row.at("member")) / name_;
  }

  /// Opens a member's table, and reads its columns.
  std::vector<std::string> open(const MemberRow& row, std::ifstream& table) const {
    table.open(path_of(row), std::ios::binary);
    std::string line;
    if (!std::getline(table, line))
      throw InputError(
          path_of(row).string() +
          " is missing, although the member is complete; remove its folder to make it again");
    return csv_fields(line);
  }

  /// Adds columns of solvers that no member before this one has. All others have to be the same.
  void add_columns(const MemberRow& row) {
    std::ifstream table;
    std::string others;
    for (const auto& column : open(row, table))
      if (!is_of_solver(column))
        others += "," + column;
      else if (std::find(columns_.begin(), columns_.end(), column) == columns_.end())
        for (auto* columns : {&of_solvers_, &columns_}) columns->push_back(column);
    if (others_.empty()) {
      others_ = others;
      columns_ = csv_fields(others.substr(1));
      columns_.insert(columns_.end(), of_solvers_.begin(), of_solvers_.end());
    }
    if (others_ != others)
      throw InputError(path_of(row).string() +
                       " has other columns than the tables of the members before it: they come "
                       "from different versions of the program, so run one of them again");
  }

  void append(const MemberRow& row, std::ostream& stream) const {
    std::ifstream table;
    const auto given = open(row, table);
    const std::string lead = leading_fields(row);
    for (std::string line; std::getline(table, line);)
      stream << lead << ',' << (given == columns_ ? line : in_all_columns(given, line)) << '\n';
  }

  /// Returns a row with an empty field for each column that its member does not have.
  std::string in_all_columns(const std::vector<std::string>& given, const std::string& line) const {
    const auto fields = csv_fields(line);
    CsvText csv("");
    for (const auto& column : columns_) {
      const auto at = std::find(given.begin(), given.end(), column);
      const auto k = static_cast<std::size_t>(at - given.begin());
      csv.field(k < fields.size() ? fields[k] : "");
    }
    return csv.text().substr(1);  // without the empty header
  }

  const fs::path& out_;
  std::string name_, others_;
  std::vector<std::string> columns_, of_solvers_;
};

}  // namespace

const std::vector<std::string>& member_columns() {
  static const std::vector<std::string> columns{
      "member",  "family",   "domain",    "elements", "size",      "distortion",
      "seed",    "solution", "algorithm", "file",     "dimension", "n_nodes",
      "n_cells", "q_min",    "q_mean",    "status",   "reason"};
  return columns;
}

const std::vector<std::string>& leading_columns() {
  static const std::vector<std::string> columns(member_columns().begin(),
                                                member_columns().begin() + 8);
  return columns;
}

MemberRow row_of(const Member& member) {
  return {{"member", member.name},
          {"family", member.family},
          {"domain", member.mesh.domain},
          {"elements", member.mesh.elements},
          {"algorithm", member.mesh.algorithm},
          {"size", member.size},
          {"distortion", member.distortion},
          {"seed", member.has_seed() ? std::to_string(member.mesh.seed) : ""},
          {"solution", member.solution},
          {"file", member.mesh.file.filename().string()},
          {"status", member_open}};
}

fs::path member_folder(const fs::path& out, const std::string& name) {
  return out / "members" / name;
}

void write_row(const fs::path& folder, const MemberRow& row) {
  CsvText csv(header(member_columns()));
  add_fields(csv, member_columns(), row);
  csv.end_line();
  write_atomically(folder / row_file, csv.text());
}

MemberRow read_row(const fs::path& folder) {
  std::ifstream stream(folder / row_file, std::ios::binary);
  std::string columns, line;
  if (!std::getline(stream, columns)) return {};
  std::getline(stream, line);
  const auto names = csv_fields(columns), fields = csv_fields(line);
  if (names != member_columns() || fields.size() != names.size())
    throw InputError(
        (folder / row_file).string() +
        " is not a row of this program; remove the folder to have the member made again");
  MemberRow row;
  for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = fields[i];
  return row;
}

void write_made_by(const fs::path& folder, const std::string& digest) {
  write_atomically(folder / made_by_file, digest + "\n");
}

std::string made_by(const fs::path& folder) {
  std::ifstream stream(folder / made_by_file);
  std::string digest;
  std::getline(stream, digest);
  return digest;
}

std::vector<MemberRow> read_rows(const fs::path& out) {
  std::vector<MemberRow> rows;
  if (fs::is_directory(out / "members"))
    for (const auto& entry : fs::directory_iterator(out / "members"))
      if (auto row = read_row(entry.path()); !row.empty()) rows.push_back(std::move(row));
  std::sort(rows.begin(), rows.end(),
            [](const auto& a, const auto& b) { return a.at("member") < b.at("member"); });
  return rows;
}

std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t most = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i)
    text += (i == 0 ? "" : ", ") + names[i];
  const std::size_t n_others = names.size() > most ? names.size() - most : 0;
  return n_others > 0 ? text + " and " + std::to_string(n_others) + " others" : text;
}

void write_collected_tables(const fs::path& out, const std::vector<MemberRow>& rows) {
  CsvText members(header(member_columns()));
  const MemberRow* complete = nullptr;
  for (const auto& row : rows) {
    add_fields(members, member_columns(), row);
    members.end_line();
    if (row.at("status") == member_complete) complete = &row;
  }
  write_atomically(out / "members.csv", members.text());
  for (const std::string name : {"iterations.csv", "summary.csv", "metrics.csv", "refined.csv"})
    if (complete != nullptr && fs::exists(member_folder(out, complete->at("member")) / name))
      write_atomically(out / name, [&](const fs::path& temporary) {
        CollectedTable(out, name).write(rows, temporary);
      });
}

}  // namespace smoothfem
