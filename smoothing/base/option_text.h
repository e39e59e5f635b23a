// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <atomic>
#include <string>

namespace smoothfem {

/// True if users of this process write options as arguments of Python's functions. Visible, so that
/// a library that hides its symbols has the same one.
[[gnu::visibility("default")]] inline std::atomic<bool>& options_are_arguments() {
  static std::atomic<bool> are{false};
  return are;
}

/// Returns an option as its user writes it: "--boundary slide" in commands, boundary="slide" in
/// Python.
inline std::string option_text(std::string name, const std::string& value = {}) {
  if (!options_are_arguments()) return "--" + name + (value.empty() ? "" : " " + value);
  std::replace(name.begin(), name.end(), '-', '_');
  return name + (value.empty() ? "" : "=\"" + value + "\"");
}

}  // namespace smoothfem
