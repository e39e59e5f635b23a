// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string_view>

#include "fuzz/targets.h"
#include "studies/framework/run/checkpoint.h"
#include "studies/framework/run/sealed_file.h"
#include "studies/kinds/study_kinds.h"

namespace smoothfem::fuzz {

namespace {

bool run_study(Bytes bytes) {
  static const MemoryFile file;
  file.set(bytes);
  return is_read([](const std::filesystem::path& path) { read_any_study(path); }, file.path());
}

/// Folder of a checkpoint; removed when the process ends.
class CheckpointFolder {
 public:
  CheckpointFolder() : path_("/dev/shm/smoothfem-fuzz-" + std::to_string(::getpid())) {
    std::filesystem::create_directories(path_ / name);
  }
  ~CheckpointFolder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

  static constexpr const char* name = "fuzz";

 private:
  std::filesystem::path path_;
};

constexpr std::size_t number_of_numbers = 4;

/// The first byte selects one of a checkpoint's files for the remaining bytes, and whether they are
/// written unchanged or sealed. Without a seal no reader accepts them.
bool run_checkpoint(Bytes bytes) {
  static const CheckpointFolder folder;
  using Read = void (*)(const std::filesystem::path&);
  struct File {
    const char* name;
    Read read;
  };
  static const File files[] = {
      {"fuzz/0.numbers",
       [](auto& path) {
         Checkpoint(path).load_numbers(CheckpointFolder::name, 0, number_of_numbers);
       }},
      {"fuzz.trajectory",
       [](auto& path) { Checkpoint(path).load_trajectory(CheckpointFolder::name); }},
      {"fuzz.solved", [](auto& path) { Checkpoint(path).load_solved(CheckpointFolder::name); }}};
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
  return {{"checkpoint", run_checkpoint}, {"study", run_study}};
}

}  // namespace smoothfem::fuzz
