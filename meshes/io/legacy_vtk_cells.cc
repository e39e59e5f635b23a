#include <algorithm>
#include <charconv>
#include <cstdint>
#include <sstream>
#include <string>

#include "meshes/io/vtk_files.h"
#include "smoothing/mesh/input_error.h"

namespace smoothfem {

namespace {

/// Integers after a section's title: big-endian 32-bit numbers or words.
class Integers {
 public:
  Integers(std::string_view bytes, bool binary) : bytes_(bytes), binary_(binary) {}

  /// False at the end of the text and at a word that is no integer.
  bool next(std::int64_t& value) { return binary_ ? next_binary(value) : next_word(value); }

 private:
  bool next_binary(std::int64_t& value) {
    if (bytes_.size() < 4) return false;
    std::uint32_t bits = 0;
    for (int i = 0; i < 4; ++i) bits = bits << 8 | static_cast<unsigned char>(bytes_[i]);
    value = static_cast<std::int32_t>(bits);
    bytes_.remove_prefix(4);
    return true;
  }

  bool next_word(std::int64_t& value) {
    bytes_.remove_prefix(std::min(bytes_.find_first_not_of(" \t\r\n"), bytes_.size()));
    const auto [end, error] = std::from_chars(bytes_.data(), bytes_.data() + bytes_.size(), value);
    if (error != std::errc()) return false;
    bytes_.remove_prefix(static_cast<std::size_t>(end - bytes_.data()));
    return true;
  }

  std::string_view bytes_;
  bool binary_;
};

/// n rows "k i1 .. ik" of size integers altogether.
bool rows_fit(Integers integers, std::int64_t n, std::int64_t size) {
  std::int64_t used = 0, node = 0;
  for (std::int64_t row = 0; row < n; ++row) {
    std::int64_t length = 0;
    if (!integers.next(length) || length < 0 || length >= size - used) return false;
    for (std::int64_t k = 0; k < length; ++k)
      if (!integers.next(node)) return false;
    used += length + 1;
  }
  return used == size;
}

std::string third_line(std::string_view content) {
  std::istringstream lines{std::string(content.substr(0, 1000))};
  std::string line;
  for (int i = 0; i < 3; ++i) std::getline(lines, line);
  return line;
}

}  // namespace

void check_legacy_vtk_cells(const std::filesystem::path& path, std::string_view content) {
  constexpr std::string_view before_version = "# vtk DataFile Version ";
  if (content.size() > before_version.size() && content[before_version.size()] >= '5') return;
  const bool binary = third_line(content).starts_with("BINARY");
  for (const std::string section : {"CELLS", "POLYGONS", "LINES", "VERTICES"}) {
    const std::size_t begin = content.find("\n" + section + " ");
    const std::size_t end = content.find('\n', begin == content.npos ? begin : begin + 1);
    if (begin == content.npos || end == content.npos) continue;
    std::istringstream title{std::string(content.substr(begin, end - begin))};
    std::string keyword;
    std::int64_t n = -1, size = -1;
    title >> keyword >> n >> size;
    if (n < 0 || size < 0 || !rows_fit(Integers(content.substr(end + 1), binary), n, size))
      throw InputError(path.string() + ": the section " + section +
                       " does not have the rows it announces; the file is truncated or damaged");
  }
}

}  // namespace smoothfem
