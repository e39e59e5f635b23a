// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace smoothfem {

/// Replaces a file in one step, so that readers of `path` see the old content or the whole
/// new one, never a part. Creates missing parent folders, calls `write` with a path in the same
/// folder that has the same extension and does not exist yet, flushes that file to the disk, so
/// that it survives power failures, and renames it. If `write` throws, leaves no file, or anything
/// else fails (folder that cannot be created or written, full disk), the temporary is removed,
/// `path` stays as it was and InputError names `path` and the reason; an InputError of `write`
/// passes unchanged. A `path` that is a folder or a device is refused.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same with the content at hand; short writes are errors.
void write_atomically(const std::filesystem::path& path, std::string_view content);

/// Why no file can be made in a folder, which need not be there yet; empty if one can. Leaves no
/// trace.
std::string why_not_writable(const std::filesystem::path& folder);

/// Before long work, and without leaving a trace: throws InputError if `path` is a folder or a
/// device, or lies where no file can be written.
void require_writable_file(const std::filesystem::path& path);

/// Removes the hidden files .NAME.PROCESS.NUMBER.EXTENSION that are left in a folder and those
/// below it where a process was killed while it wrote.
void remove_unfinished_files(const std::filesystem::path& folder);

/// Flushes to the disk whatever has been written to the file system of a folder, at once.
void flush_file_system(const std::filesystem::path& folder);

}  // namespace smoothfem
