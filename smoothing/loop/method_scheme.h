// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "smoothing/loop/catalogue.h"

namespace smoothfem {

/// A method that no library registers, but a file of the user's holds: its name is
/// "SCHEME:FILE:OBJECT", as "python:mine.py:Mine". The catalogue makes it wherever a method is
/// named.
struct MethodInFile {
  std::string scheme;          ///< a registered one
  std::filesystem::path file;  ///< absolute, or relative to the current folder
  std::string object;          ///< what in the file is meant

  std::string name() const { return scheme + ":" + file.string() + ":" + object; }
};

/// Its parts, if a method's name begins with a registered scheme and a colon. Throws InputError if
/// the file or the object is missing.
std::optional<MethodInFile> method_in_file(const std::string& name);

/// The name of the same method with its file, if it has one that is relative, in this folder. Other
/// names stay as they are.
std::string method_name_in(const std::filesystem::path& folder, const std::string& name);

/// Who makes the methods of a scheme.
struct MethodScheme {
  std::string name;  ///< what stands before the colon
  /// Throws InputError if the file has no such method.
  MethodEntry (*make)(const MethodInFile& method);
};

/// Registers a scheme when its file is loaded: one namespace-scope object a scheme.
struct RegisteredScheme {
  explicit RegisteredScheme(MethodScheme scheme);
};

/// What the method consists of. Throws InputError as the scheme's make does.
MethodEntry make_entry(const MethodInFile& method);

}  // namespace smoothfem
