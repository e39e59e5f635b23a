// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace smoothfem {

/// A method in a user's file, without registration. Its name is "SCHEME:FILE:OBJECT", for example
/// "python:mine.py:Mine". The catalogue makes it wherever a method is named.
struct MethodInFile {
  std::string scheme;          ///< a registered scheme
  std::filesystem::path file;  ///< absolute, or relative to the current folder
  std::string object;          ///< name of the method in the file

  std::string name() const { return scheme + ":" + file.string() + ":" + object; }
};

/// Parses a method's name that begins with a registered scheme and a colon; otherwise returns
/// nothing. Throws InputError if the file or the object is missing.
std::optional<MethodInFile> method_in_file(const std::string& name);

/// Returns the method's name with a relative file taken in this folder. Other names stay unchanged.
std::string method_name_in(const std::filesystem::path& folder, const std::string& name);

}  // namespace smoothfem
