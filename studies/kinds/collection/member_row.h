// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace smoothfem {

struct Member;

/// How far a member is. What has failed has a reason.
inline constexpr const char *member_open = "open", *member_meshed = "meshed",
                            *member_smoothed = "smoothed", *member_complete = "complete",
                            *member_failed = "failed";

/// A row of members.csv, by its columns (studies/columns.json): what is known of a member. Each
/// member has its own in its folder, so that folders can be put together.
using MemberRow = std::map<std::string, std::string>;

/// Columns of members.csv, and those of them that stand before the columns of the members' tables
/// in the collection's.
const std::vector<std::string>& member_columns();
const std::vector<std::string>& leading_columns();

/// Of a member that nothing has been done for.
MemberRow row_of(const Member& member);

/// The folder of a member below that of the collection's results.
std::filesystem::path member_folder(const std::filesystem::path& out, const std::string& name);

/// Writes and reads the row in a member's folder; an empty one if there is none. Throw InputError.
void write_row(const std::filesystem::path& folder, const MemberRow& row);
MemberRow read_row(const std::filesystem::path& folder);

/// The rows of all members that have a folder, sorted by name.
std::vector<MemberRow> read_rows(const std::filesystem::path& out);

/// Writes members.csv, and of the tables of all members that are complete iterations.csv,
/// summary.csv and, if there are any, others of these names. Needs memory for one line at a time.
/// Throws InputError for tables of different columns.
void write_collected_tables(const std::filesystem::path& out, const std::vector<MemberRow>& rows);

}  // namespace smoothfem
