// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "smoothing/loop/catalogue.h"

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

/// Maker of the methods of a scheme.
struct MethodScheme {
  std::string name;  ///< the word before the colon
  /// Makes the method. Throws InputError if the file has no such method.
  MethodEntry (*make)(const MethodInFile& method);
};

/// Registers a scheme when its file is loaded: one namespace-scope object for each scheme.
struct RegisteredScheme {
  explicit RegisteredScheme(MethodScheme scheme);
};

/// Makes the entry of the method. Throws InputError as the scheme's `make` does.
MethodEntry make_entry(const MethodInFile& method);

}  // namespace smoothfem
