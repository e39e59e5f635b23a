// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace smoothfem::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// A reader of files from unknown sources. It must read any bytes or throw InputError with one
/// sentence; everything else is a finding.
struct Target {
  std::string name;  ///< also of its folder in fuzz/corpus/
  /// Returns true if the bytes are read, false if they are refused. Throws std::logic_error, or an
  /// exception that the reader should not throw.
  bool (*run)(Bytes bytes);
};

/// Returns a target for each mesh format. A read mesh must allow computing its quality.
std::vector<Target> mesh_targets();
/// Returns the targets of the study file and of the files of kept results.
std::vector<Target> study_targets();

/// A file in memory, whose content changes from run to run.
class MemoryFile {
 public:
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  void set(Bytes bytes) const;
  std::filesystem::path path() const;

 private:
  int descriptor_;
};

/// Throws std::logic_error with the rule unless the condition holds.
void require(bool condition, const std::string& rule);

/// Returns true if a reader reads a file. An InputError must be one sentence.
bool is_read(void (*read)(const std::filesystem::path&), const std::filesystem::path& path);

}  // namespace smoothfem::fuzz
