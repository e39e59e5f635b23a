// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace smoothfem {

/// Replaces a file in one step, so that readers of `path` see either the old or the complete new
/// content. Creates missing parent folders. Calls `write` with a new path in the same folder that
/// has the same extension. Flushes that file to the disk, so that it survives power failures, and
/// renames it.
///
/// An error leaves `path` unchanged and removes the temporary file. Errors: `write` throws or
/// leaves no file, the folder cannot be created or written, the disk is full. An InputError then
/// names `path` and the reason; an InputError of `write` passes unchanged. Throws InputError if
/// `path` is a folder or a device.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same in steps. The file is removed at the end of the scope unless finish() was called. All
/// functions throw InputError as above.
class AtomicFile {
 public:
  /// Checks `path` and makes its folder.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Returns the path to write to.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Makes it a copy of a file.
  void copy_from(const std::filesystem::path& other) const;
  /// Replaces bytes of it.
  void overwrite(std::uint64_t position, std::string_view bytes) const;
  /// Flushes it to the disk and gives it its name.
  void finish();

 private:
  std::filesystem::path path_, temporary_;
  bool is_finished_ = false;
};

/// Writes the given content atomically. Short writes are errors.
void write_atomically(const std::filesystem::path& path, std::string_view content);

/// Returns why no file can be made in a folder, which need not exist yet; empty if one can be made.
/// Leaves no trace.
std::string why_not_writable(const std::filesystem::path& folder);

/// Checks `path` before long work, without leaving a trace. Throws InputError if it is a folder or
/// a device, or lies where no file can be written.
void require_writable_file(const std::filesystem::path& path);

/// Removes hidden files .NAME.PROCESS.NUMBER.EXTENSION in a folder and its subfolders. A process
/// that is killed while it writes leaves them.
void remove_unfinished_files(const std::filesystem::path& folder);

/// Flushes to the disk all data written to the file system of a folder, at once.
void flush_file_system(const std::filesystem::path& folder);

}  // namespace smoothfem
