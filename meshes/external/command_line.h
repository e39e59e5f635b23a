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

/// A regular expression (of Perl) whose first group is the time that a program prints, for example
/// "time: ([0-9.]+) s".
class TimePattern {
 public:
  /// Throws InputError if it is not a regular expression, or has no group.
  explicit TimePattern(const std::string& pattern);

  /// Returns the times in all matching lines of a text, times `unit`. Throws SmootherFailure for a
  /// time that is not a finite number of at least 0, and if the pattern takes too many steps.
  std::vector<double> times(const std::string& text, double unit) const;

 private:
  std::optional<std::string> group_in(const std::string& line) const;

  std::string pattern_;
  std::shared_ptr<const void> code_;  ///< the compiled pattern
};

}  // namespace smoothfem
