// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "meshes/external/child_process.h"
#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// A file in a temporary folder of its own; the destructor removes both. Throws InputError if there
/// is no room for it.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name) : path_(folder_.path() / name) {}

  const std::filesystem::path& path() const { return path_; }

 private:
  ScratchFolder folder_;
  std::filesystem::path path_;
};

/// The mesh name "-" means standard input or output. A format is then required: an extension with
/// or without the dot.
/// Each function returns the file to read or write instead, or null for other names. Throws
/// InputError.
std::unique_ptr<TemporaryFile> copy_of_standard_input(const std::string& name,
                                                      const std::string& format);
std::unique_ptr<TemporaryFile> file_for_standard_output(const std::string& name,
                                                        const std::string& format);

/// Throws InputError if a file's name does not have the extension that --to asks for.
void require_extension(const std::string& out, const std::string& to, const WriteTarget& target);

/// Writes a file's content to standard output.
void print_content(const std::filesystem::path& path);

}  // namespace smoothfem
