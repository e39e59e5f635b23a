// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace smoothfem {

/// Returns "a, b, c", for sentences that list names.
inline std::string joined(const std::vector<std::string>& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}
/// Returns "choose one of a, b, c", the end of an error message about an unknown name.
inline std::string choose_one_of(const std::vector<std::string>& names) {
  return "choose one of " + joined(names);
}

/// Error about user input (a file, a parameter, a mesh) that cannot be used. The message is one
/// sentence: the problem, its place, and a remedy. The command line prints it and exits with code
/// 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// InputError about one cell. A reader of files can add the cell's position in the file.
class CellError : public InputError {
 public:
  CellError(std::size_t cell, const std::string& what_is_wrong)
      : InputError("cell " + std::to_string(cell) + " " + what_is_wrong), cell_(cell) {}

  std::size_t cell() const { return cell_; }

 private:
  std::size_t cell_;
};

}  // namespace smoothfem
