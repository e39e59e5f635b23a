// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace smoothfem {

/// Puts what stands for them in the place of {name} everywhere in a command.
std::string with_placeholder(std::string command, const std::string& name,
                             const std::string& value);

bool has_placeholder(const std::string& command, const std::string& name);

/// The first word of a command, without quotes.
std::string first_word(const std::string& command);

/// The rest of a command, with the blank before it.
std::string after_first_word(const std::string& command);

/// The last line with something in it.
std::string last_line(const std::string& text);

/// The numbers of the first group of a regular expression (ECMAScript) in all lines of a text that
/// it matches, e.g. "time: ([0-9.]+) s".
std::vector<double> matched_numbers(const std::string& text, const std::string& pattern);

}  // namespace smoothfem
