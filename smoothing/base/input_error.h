// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace smoothfem {

/// "a, b, c", for sentences that list what there is.
inline std::string joined(const std::vector<std::string>& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}
/// "choose one of a, b, c", the end of a sentence that refuses a name.
inline std::string choose_one_of(const std::vector<std::string>& names) {
  return "choose one of " + joined(names);
}

/// Something the user gave (a file, a parameter, a mesh) cannot be used. The message is one
/// sentence that says what is wrong, where, and what to do; the command line prints it and exits
/// with code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An InputError about one cell, so that a reader can add where in its file the cell stands.
class CellError : public InputError {
 public:
  CellError(std::size_t cell, const std::string& what_is_wrong)
      : InputError("cell " + std::to_string(cell) + " " + what_is_wrong), cell_(cell) {}

  std::size_t cell() const { return cell_; }

 private:
  std::size_t cell_;
};

}  // namespace smoothfem
