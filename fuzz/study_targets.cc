// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string_view>

#include "fuzz/targets.h"
#include "studies/framework/run/kept/kept_results.h"
#include "studies/framework/run/kept/sealed_file.h"
#include "studies/kinds/study_kinds.h"

namespace smoothfem::fuzz {

namespace {

bool run_study(Bytes bytes) {
  static const MemoryFile file;
  file.set(bytes);
  return is_read([](const std::filesystem::path& path) { read_any_study(path); }, file.path());
}

/// Folder of kept results; removed when the process ends.
class KeptFolder {
 public:
  KeptFolder() : path_("/dev/shm/smoothfem-fuzz-" + std::to_string(::getpid())) {
    std::filesystem::create_directories(path_ / name);
  }
  ~KeptFolder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

  static constexpr const char* name = "fuzz";

 private:
  std::filesystem::path path_;
};

constexpr std::size_t number_of_numbers = 4;

/// The first byte selects one of the files of kept results for the remaining bytes, and whether
/// they are written unchanged or sealed. Without a seal no reader accepts them.
bool run_kept(Bytes bytes) {
  static const KeptFolder folder;
  using Read = void (*)(const std::filesystem::path&);
  struct File {
    const char* name;
    Read read;
  };
  static const File files[] = {
      {"fuzz/0.numbers",
       [](auto& path) { KeptResults(path).load_numbers(KeptFolder::name, 0, number_of_numbers); }},
      {"fuzz.trajectory", [](auto& path) { KeptResults(path).load_trajectory(KeptFolder::name); }},
      {"fuzz.solved", [](auto& path) { KeptResults(path).load_solved(KeptFolder::name); }}};
  if (bytes.empty()) return false;
  const File& file = files[bytes[0] % std::size(files)];
  const bool sealed = bytes[0] < 128;
  const std::string_view content(reinterpret_cast<const char*>(bytes.data()) + 1, bytes.size() - 1);
  if (sealed)
    write_sealed(folder.path(), file.name, content);
  else
    std::ofstream(folder.path() / file.name, std::ios::binary) << content;
  return is_read(file.read, folder.path());
}

}  // namespace

std::vector<Target> study_targets() {
  return {{"kept", run_kept}, {"study", run_study}};
}

}  // namespace smoothfem::fuzz
