// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "meshes/external/child_process.h"

namespace smoothfem {

/// A file that is there as long as this lives, in a folder of its own among the system's temporary
/// ones. Throws InputError if there is no room for it.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name) : path_(folder_.path() / name) {}

  const std::filesystem::path& path() const { return path_; }

 private:
  ScratchFolder folder_;
  std::filesystem::path path_;
};

/// "-" as the name of a mesh means standard input, or output: then a format has to be named, as an
/// extension with or without the dot. The file to read or write in its place, or null for other
/// names. Throws InputError.
std::unique_ptr<TemporaryFile> copy_of_standard_input(const std::string& name,
                                                      const std::string& format);
std::unique_ptr<TemporaryFile> file_for_standard_output(const std::string& name,
                                                        const std::string& format);

/// Writes a file's content to standard output.
void print_content(const std::filesystem::path& path);

}  // namespace smoothfem
