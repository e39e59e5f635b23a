// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace smoothfem {

struct Member;

/// The status of a member. A failed one has a reason.
inline constexpr const char *member_open = "open", *member_meshed = "meshed",
                            *member_smoothed = "smoothed", *member_complete = "complete",
                            *member_failed = "failed";

/// A row of members.csv, by its columns (studies/columns.json): the known facts about a member.
/// Each member's folder has its own row, so that folders can be merged.
using MemberRow = std::map<std::string, std::string>;

/// Return the columns of members.csv, and the part of them that precedes the members' columns in
/// the collection's tables.
const std::vector<std::string>& member_columns();
const std::vector<std::string>& leading_columns();

/// Returns the row of a member before any work on it.
MemberRow row_of(const Member& member);

/// Returns a member's folder in the collection's results folder.
std::filesystem::path member_folder(const std::filesystem::path& out, const std::string& name);

/// Write and read the row in a member's folder. A missing row is read as an empty one. They throw
/// InputError.
void write_row(const std::filesystem::path& folder, const MemberRow& row);
MemberRow read_row(const std::filesystem::path& folder);

/// Writes and reads the digest of what made a member's row; empty if it is not known.
void write_made_by(const std::filesystem::path& folder, const std::string& digest);
std::string made_by(const std::filesystem::path& folder);

/// Returns the rows of all members that have a folder, sorted by name.
std::vector<MemberRow> read_rows(const std::filesystem::path& out);

/// Returns "a, b, c, d, e and 3 others".
std::string some_of(const std::vector<std::string>& names);

/// Writes members.csv. From the tables of complete members it writes iterations.csv, summary.csv
/// and any others of the known names. It needs memory for one line at a time. Throws InputError if
/// tables have different columns.
void write_collected_tables(const std::filesystem::path& out, const std::vector<MemberRow>& rows);

}  // namespace smoothfem
