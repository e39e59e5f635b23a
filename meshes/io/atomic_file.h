#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace smoothfem {

/// What a file has to survive.
enum class Survives {
  power_failure,  ///< it is flushed to the disk, which takes its time
  process_end     ///< whatever kills the process, but not the machine
};

/// Puts a file in place in one step, so that whoever reads `path` sees the old content or the whole
/// new one, never a part. Creates missing parent folders, calls `write` with a path in the same
/// folder that has the same extension and does not exist yet, flushes that file to the disk (if it
/// has to survive power failures) and renames it. If `write` throws, leaves no file, or anything
/// else fails (folder that cannot be created or written, full disk), the temporary is removed,
/// `path` stays as it was and InputError names `path` and the reason; an InputError of `write`
/// passes unchanged. A `path` that is a folder or a device is refused.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write,
                      Survives survives = Survives::power_failure);

/// The same with the content at hand; short writes are errors.
void write_atomically(const std::filesystem::path& path, std::string_view content,
                      Survives survives = Survives::power_failure);

/// Flushes to the disk whatever has been written to the file system of a folder, at once.
void flush_file_system(const std::filesystem::path& folder);

}  // namespace smoothfem
