// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace smoothfem {

/// Replaces {name} everywhere in a command.
std::string with_placeholder(std::string command, const std::string& name,
                             const std::string& value);

bool has_placeholder(const std::string& command, const std::string& name);

/// Returns the first word of a command, without quotes.
std::string first_word(const std::string& command);

/// Returns the rest of a command, with the blank before it.
std::string after_first_word(const std::string& command);

/// Returns the last line that is not blank.
std::string last_line(const std::string& text);

/// Returns the numbers in the first group of a regular expression (ECMAScript), from all matching
/// lines of a text. Example: "time: ([0-9.]+) s".
std::vector<double> matched_numbers(const std::string& text, const std::string& pattern);

}  // namespace smoothfem
