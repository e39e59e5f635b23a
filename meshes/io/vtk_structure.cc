// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <map>
#include <sstream>
#include <string>

#include "meshes/io/vtk_files.h"
#include "smoothing/base/input_error.h"

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

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// The section FIELD of a data set, before its points: VTK crashes where it cannot read it.
class FieldSection {
 public:
  explicit FieldSection(std::string_view content) : rest_(content) {}

  /// True if there is none, or it has all arrays. Text is only looked at for its titles.
  bool fits() {
    line();  // version
    line();  // name
    const bool binary = line().starts_with("BINARY");
    std::istringstream dataset(line());
    std::istringstream title(line());
    std::string keyword, kind, name;
    dataset >> keyword >> kind;
    if (kind.find("FIELD") != kind.npos || !(dataset >> std::ws).eof()) return false;
    int n_arrays = -1;
    title >> keyword;
    if (!lower_case(keyword).starts_with("field")) return true;  // all that VTK looks at
    if (keyword.size() != 5 || !(title >> name >> n_arrays) || n_arrays < 0) return false;
    for (int i = 0; i < n_arrays && binary; ++i)
      if (!skip_array()) return false;
    return rest_.find("POINTS ") != rest_.npos;
  }

 private:
  std::string line() {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string text(rest_.substr(0, end));
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return text;
  }

  bool skip(std::size_t n, std::size_t size) {
    if (n > rest_.size() / size) return false;
    rest_.remove_prefix(n * size);
    return true;
  }

  bool skip_array() {
    std::string text = line();
    while (text.empty() && !rest_.empty()) text = line();
    std::istringstream title(text);
    std::string name, type;
    std::int64_t n_components = -1, n_tuples = -1;
    if (!(title >> name >> n_components >> n_tuples >> type) || n_components < 1 || n_tuples < 0 ||
        n_components > static_cast<std::int64_t>(rest_.size()) ||
        n_tuples > static_cast<std::int64_t>(rest_.size()))
      return false;
    const auto n = static_cast<std::size_t>(n_components * n_tuples);
    if (type != "string") return size_of(type) != 0 && skip(n, size_of(type));
    for (std::size_t i = 0; i < n; ++i)
      if (!skip_string()) return false;
    return true;
  }

  /// 0 for a type that is not known.
  static std::size_t size_of(const std::string& type) {
    static const std::map<std::string, std::size_t> sizes = {
        {"char", 1},           {"signed_char", 1}, {"unsigned_char", 1}, {"short", 2},
        {"unsigned_short", 2}, {"int", 4},         {"unsigned_int", 4},  {"vtkidtype", 4},
        {"float", 4},          {"long", 8},        {"unsigned_long", 8}, {"vtktypeint64", 8},
        {"vtktypeuint64", 8},  {"double", 8}};
    const auto size = sizes.find(lower_case(type));
    return size == sizes.end() ? 0 : size->second;
  }

  /// The two highest bits of the first byte tell how many bytes hold the length.
  bool skip_string() {
    if (rest_.empty()) return false;
    const auto first = static_cast<unsigned char>(rest_.front());
    const std::size_t n_bytes = std::size_t{8} >> (first >> 6);
    if (n_bytes > rest_.size()) return false;
    std::size_t length = first & 0x3F;
    for (std::size_t i = 1; i < n_bytes; ++i)
      length = length << 8 | static_cast<unsigned char>(rest_[i]);
    return skip(n_bytes, 1) && skip(length, 1);
  }

  std::string_view rest_;
};

}  // namespace

void check_legacy_vtk_structure(const std::filesystem::path& path, std::string_view content) {
  if (!FieldSection(content).fits())
    throw InputError(path.string() +
                     ": the section FIELD does not have the arrays it announces; the file is "
                     "truncated or damaged");
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

void check_vtu_field_data(const std::filesystem::path& path, std::string_view content) {
  constexpr std::string_view types[] = {"Int8",  "UInt8",  "Int16",   "UInt16",  "Int32",  "UInt32",
                                        "Int64", "UInt64", "Float32", "Float64", "String", "Bit"};
  const std::size_t begin = content.find("<FieldData");
  if (begin == content.npos) return;
  std::string_view section = content.substr(begin + 1, content.find("</FieldData") - begin - 1);
  for (std::size_t tag = section.find('<'); tag != section.npos; tag = section.find('<')) {
    section.remove_prefix(tag + 1);
    const std::string_view element = section.substr(0, section.find('>'));
    const bool is_array = !element.starts_with('/') && !element.starts_with("InformationKey") &&
                          !element.starts_with("Value");
    const auto has_type = [&](std::string_view type) {
      return element.find(" type=\"" + std::string(type) + "\"") != element.npos;
    };
    if (is_array && std::none_of(std::begin(types), std::end(types), has_type))
      throw InputError(path.string() +
                       ": an array of the field data has no known type; the file "
                       "is damaged");
  }
}

}  // namespace smoothfem
