// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/gmsh/msh_parts.h"

#include <array>
#include <charconv>
#include <cstring>
#include <string_view>

#include "meshes/io/atomic_file.h"
#include "meshes/io/line_reader.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/text.h"

namespace smoothfem {

namespace {

/// Returns the stem without an ending _NUMBER; the whole stem if it has none.
std::string stem_of_parts(const std::filesystem::path& path, const std::string& number) {
  const std::string stem = path.stem().string(), ending = "_" + number;
  return stem.size() > ending.size() && stem.ends_with(ending)
             ? stem.substr(0, stem.size() - ending.size())
             : stem;
}

/// Reads numbers one after the other. After a fault all are zero.
class Cursor {
 public:
  Cursor(std::string_view content, std::size_t at, bool is_binary)
      : content_(content), at_(at), is_binary_(is_binary) {}

  std::size_t at() const { return at_; }
  bool failed() const { return failed_; }

  std::uint64_t count() { return is_binary_ ? take<std::uint64_t>() : word<std::uint64_t>(); }
  std::int32_t integer() { return is_binary_ ? take<std::int32_t>() : word<std::int32_t>(); }
  /// Returns the position of the next number, and skips it.
  std::size_t skip_number() {
    if (!is_binary_) return skip_word();
    const std::size_t begin = at_;
    take<double>();
    return begin;
  }
  /// Skips a word of text; returns its position.
  std::size_t skip_word() {
    constexpr std::string_view blanks = " \t\r\n";
    const std::size_t begin = content_.find_first_not_of(blanks, at_);
    failed_ = failed_ || begin == content_.npos;
    if (failed_) return content_.size();
    at_ = std::min(content_.find_first_of(blanks, begin), content_.size());
    return begin;
  }

 private:
  template <class T>
  T take() {
    T value{};
    failed_ = failed_ || content_.size() - at_ < sizeof value;
    if (failed_) return value;
    std::memcpy(&value, content_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  template <class T>
  T word() {
    const std::size_t begin = skip_word();
    T value{};
    const char* const last = content_.data() + at_;
    const auto [end, error] = std::from_chars(content_.data() + begin, last, value);
    failed_ = failed_ || error != std::errc() || end != last;
    return failed_ ? T{} : value;
  }

  std::string_view content_;
  std::size_t at_;
  bool is_binary_, failed_ = false;
};

}  // namespace

std::filesystem::path msh_part_file(const std::filesystem::path& path, int k) {
  return path.parent_path() /
         (stem_of_parts(path, "1") + "_" + std::to_string(k) + path.extension().string());
}

std::vector<std::filesystem::path> files_of_msh_parts(const std::filesystem::path& path,
                                                      const MshPart& part) {
  const std::string number = std::to_string(part.number), stem = stem_of_parts(path, number);
  if (stem == path.stem().string())
    throw InputError(path.string() + ": the file has part " + number + " of the " +
                     std::to_string(part.n_all) +
                     " parts of a mesh, but the other files are not found, because its name does "
                     "not end with _" +
                     number + path.extension().string() + "; give all files their names of Gmsh");
  std::vector<std::filesystem::path> files;
  for (std::uint64_t k = 1; k <= part.n_all; ++k)
    files.push_back(path.parent_path() /
                    (stem + "_" + std::to_string(k) + path.extension().string()));
  return files;
}

MshNodeFile::MshNodeFile(const std::filesystem::path& path)
    : path_(path), content_(read_whole_file(path)) {
  const std::string_view content(content_);
  const std::size_t head = content.find("4.1 ");
  is_binary_ = head != content.npos && content.substr(head, 5) == "4.1 1";
  constexpr std::string_view section = "$Nodes";
  bool is_found = false;
  // Bytes of another section may look like the beginning.
  for (std::size_t at = content.find(section); head < 64 && !is_found && at != content.npos;
       at = content.find(section, at + 1))
    is_found = read_nodes(at + section.size());
  if (!is_found)
    throw InputError(path.string() +
                     ": the nodes are not found; save it as version 4.1 of Gmsh's format");
}

bool MshNodeFile::read_nodes(std::size_t begin) {
  tags_.clear();
  places_.clear();
  while (begin < content_.size() && content_[begin] == '\r') ++begin;
  if (begin >= content_.size() || content_[begin] != '\n') return false;
  Cursor cursor(content_, begin + 1, is_binary_);
  const std::uint64_t n_blocks = cursor.count(), n_nodes = cursor.count();
  cursor.count();  // the smallest and the largest tag
  cursor.count();
  for (std::uint64_t b = 0; b < n_blocks && !cursor.failed(); ++b) {
    const int dimension = cursor.integer();
    cursor.integer();  // entity
    const int n_parameters = cursor.integer() != 0 ? dimension : 0;
    const std::uint64_t n = cursor.count();
    for (std::uint64_t i = 0; i < n && !cursor.failed(); ++i) tags_.push_back(cursor.count());
    for (std::uint64_t i = 0; i < n && !cursor.failed(); ++i) {
      places_.push_back(cursor.skip_number());
      for (int k = 1; k < 3 + n_parameters; ++k) cursor.skip_number();
    }
  }
  const std::size_t end = cursor.skip_word();
  return !cursor.failed() && tags_.size() == n_nodes &&
         std::string_view(content_).substr(end).starts_with("$EndNodes");
}

void MshNodeFile::write(const std::filesystem::path& out, std::size_t dim,
                        const std::function<const double*(std::size_t)>& point) const {
  std::string text;
  text.reserve(content_.size());
  std::size_t done = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const double* const x = point(i);
    if (x == nullptr) continue;
    text.append(content_, done, places_[i] - done);
    Cursor cursor(content_, places_[i], is_binary_);
    for (std::size_t d = 0; d < dim; ++d) {
      if (is_binary_) {
        text.append(reinterpret_cast<const char*>(x + d), sizeof(double));
      } else {
        if (d > 0) text += ' ';
        append_number(text, x[d]);
      }
      cursor.skip_number();
    }
    done = cursor.at();
  }
  text.append(content_, done);
  write_atomically(out, text);
}

}  // namespace smoothfem
