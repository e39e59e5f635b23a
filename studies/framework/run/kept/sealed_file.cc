// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/kept/sealed_file.h"

#include <fstream>
#include <iterator>

#include "meshes/io/atomic_file.h"
#include "smoothing/base/input_error.h"
#include "studies/framework/results/sha256.h"

namespace smoothfem {

namespace fs = std::filesystem;

namespace {

/// The first bytes of each file. A new format of the contents needs a new number.
constexpr std::string_view format = "smoothfem kept result 3\n";

/// Returns the bytes before the content.
std::string seal(const std::string& name, std::string_view content) {
  const std::string content_sha256 = sha256(content);
  return std::string(format) +
         sha256(name + '\n' + std::to_string(content.size()) + '\n' + content_sha256) + '\n';
}

}  // namespace

void refuse_damaged(const fs::path& path) {
  throw InputError(
      path.string() +
      " is damaged: an earlier run of this version has not written it like this; remove the folder "
      "'kept' of the results and start the study again, which computes its content anew");
}

void write_sealed(const fs::path& folder, const std::string& name, std::string_view content) {
  std::string sealed = seal(name, content);
  sealed += content;
  write_atomically(folder / name, sealed);
}

std::optional<std::string> read_sealed(const fs::path& folder, const std::string& name) {
  const fs::path path = folder / name;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    if (fs::exists(path))
      throw InputError("cannot read " + path.string() + "; check its permissions");
    return std::nullopt;
  }
  std::string content(std::istreambuf_iterator<char>(stream), {});
  const std::size_t length = seal(name, "").size();
  if (content.size() < length) refuse_damaged(path);
  const std::string found = content.substr(0, length);
  content.erase(0, length);
  if (found != seal(name, content)) refuse_damaged(path);
  return content;
}

}  // namespace smoothfem
