// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <regex>
#include <string>
#include <system_error>

#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw InputError("cannot write " + path.string() + ": " + reason);
}

void require_replaceable(const fs::path& path) {
  if (path.filename().empty()) fail(path, "it is not a file name; give a file name");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) fail(path, "it is a folder; give a file name");
  // Renaming over a device would replace the device itself by a file.
  if (fs::exists(status) && !fs::is_regular_file(status))
    fail(path, "it is not a regular file; give another file name");
}

void create_folder_of(const fs::path& path) {
  const fs::path folder = path.parent_path();
  if (folder.empty()) return;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error))
    fail(path, "the folder " + folder.string() + " cannot be created (" +
                   (error ? error.message() : std::strerror(ENOTDIR)) + ")");
}

/// Returns a hidden name, different for every call of every process, so that two writers never
/// share one.
fs::path temporary_path_for(const fs::path& path) {
  static std::atomic<unsigned> n_calls{0};
  fs::path name = ".";
  name += path.stem();
  for (const unsigned long number : {static_cast<unsigned long>(::getpid()), 0ul + n_calls++}) {
    name += '.';
    name += std::to_string(number);
  }
  name += path.extension();
  return path.parent_path() / name;
}

/// A file descriptor that is closed at the end of the scope.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : value_(::open(path.c_str(), flags, 0666)) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int value() const { return value_; }

 private:
  int value_;
};

/// Flushes the file. Errors of delayed writes (quota, network file systems) show up here at the
/// latest.
void flush_to_disk(const fs::path& path, const fs::path& temporary) {
  const Descriptor file(temporary, O_RDONLY);
  if (file.value() < 0) fail(path, std::strerror(errno));
  if (::fsync(file.value()) != 0) fail(path, std::strerror(errno));
}

void write_all(const fs::path& path, int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t n_written = ::write(file, content.data(), content.size());
    if (n_written < 0 && errno == EINTR) continue;
    if (n_written < 0) fail(path, std::strerror(errno));
    content.remove_prefix(static_cast<std::size_t>(n_written));
  }
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : path_(path) {
  require_replaceable(path);
  create_folder_of(path);
  temporary_ = temporary_path_for(path);
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;  // the file may never have been created
  if (!is_finished_) fs::remove(temporary_, ignored);
}

void AtomicFile::copy_from(const fs::path& other) const {
  std::error_code error;
  fs::copy_file(other, temporary_, error);
  if (!error)  // the other one may be read-only
    fs::permissions(temporary_, fs::perms::owner_write, fs::perm_options::add, error);
  if (error) fail(path_, error.message());
}

void AtomicFile::overwrite(std::uint64_t position, std::string_view bytes) const {
  const Descriptor file(temporary_, O_WRONLY | O_CLOEXEC);
  if (file.value() < 0 || ::lseek(file.value(), static_cast<off_t>(position), SEEK_SET) < 0)
    fail(path_, std::strerror(errno));
  write_all(path_, file.value(), bytes);
}

void AtomicFile::finish() {
  flush_to_disk(path_, temporary_);
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) fail(path_, error.message());
  is_finished_ = true;
}

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  AtomicFile file(path);
  try {
    write(file.temporary());
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    fail(path, error.what());
  }
  file.finish();
}

void write_atomically(const fs::path& path, std::string_view content) {
  write_atomically(path, [&](const fs::path& temporary) {
    const Descriptor file(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC);
    if (file.value() < 0) fail(path, std::strerror(errno));
    write_all(path, file.value(), content);
  });
}

std::string why_not_writable(const fs::path& folder) {
  fs::path existing = fs::absolute(folder);
  std::error_code ignored;  // a path that cannot be inspected is not a folder either
  while (!fs::exists(existing, ignored) && existing.has_relative_path())
    existing = existing.parent_path();
  if (!fs::is_directory(existing, ignored)) return existing.string() + " is not a folder";
  if (::access(existing.c_str(), W_OK | X_OK) != 0) return std::strerror(errno);
  return "";
}

void require_writable_file(const fs::path& path) {
  require_replaceable(path);
  const std::string reason = why_not_writable(fs::absolute(path).parent_path());
  if (!reason.empty()) fail(path, reason);
}

void remove_unfinished_files(const fs::path& folder) {
  static const std::regex temporary(R"(\..+\.[0-9]+\.[0-9]+(\.[^.]*)?)");  // temporary_path_for
  std::vector<fs::path> unfinished;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (std::regex_match(entry.path().filename().string(), temporary))
      unfinished.push_back(entry.path());
  std::error_code ignored;  // leftovers are harmless
  for (const auto& path : unfinished) fs::remove(path, ignored);
}

void flush_file_system(const fs::path& folder) {
  const Descriptor file(folder, O_RDONLY);
  if (file.value() < 0 || ::syncfs(file.value()) != 0) fail(folder, std::strerror(errno));
}

}  // namespace smoothfem
