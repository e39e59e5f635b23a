// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
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

/// A regular expression (of Perl) whose first group is a part of a line that a program prints.
class LinePattern {
 public:
  /// what: its name in messages, for example "time_pattern". Throws InputError if it is not a
  /// regular expression, or has no group.
  LinePattern(const std::string& what, const std::string& pattern);

  /// Returns "the time_pattern 'time: ([0-9.]+)'".
  std::string name() const;

  /// Returns the groups in all matching lines of a text; lines of 10,000 characters are left out.
  /// Throws SmootherFailure if the pattern takes too many steps.
  std::vector<std::string> groups_in(const std::string& text) const;

 private:
  std::optional<std::string> group_in(const std::string& line) const;

  std::string what_, pattern_;
  std::shared_ptr<const void> code_;  ///< the compiled pattern
};

/// Returns the times in all matching lines of a text, times `unit`. Throws SmootherFailure for a
/// time that is not a finite number of at least 0, and as LinePattern does.
std::vector<double> times_in(const std::string& text, const LinePattern& pattern, double unit);

}  // namespace smoothfem
