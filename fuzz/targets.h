// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace smoothfem::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// A reader of files that anybody may have written. It reads any bytes or throws InputError with
/// one sentence; everything else is a finding.
struct Target {
  std::string name;  ///< also of its folder in fuzz/corpus/
  /// Whether the bytes are read, or refused. Throws std::logic_error, or what the reader throws and
  /// should not.
  bool (*run)(Bytes bytes);
};

/// One for each mesh format. What is read must also be a mesh whose quality can be computed.
std::vector<Target> mesh_targets();
/// The study file, and the files of a checkpoint.
std::vector<Target> study_targets();

/// A file without a place on the disk, whose content changes from run to run.
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

/// Throws std::logic_error unless it holds.
void require(bool condition, const std::string& rule);

/// Whether a reader reads a file; an InputError must be one sentence.
bool is_read(void (*read)(const std::filesystem::path&), const std::filesystem::path& path);

}  // namespace smoothfem::fuzz
