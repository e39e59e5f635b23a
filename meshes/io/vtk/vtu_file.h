// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meshes/io/line_reader.h"
#include "meshes/io/vtk/vtk_numbers.h"
#include "meshes/io/vtk/vtu_bytes.h"
#include "meshes/io/vtk/xml_tags.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

/// An element `<DataArray>`.
struct VtuArray {
  std::string_view name, type, format;
  std::uint64_t n_components = 1;
  std::uint64_t n_tuples = 0;  ///< of field data; other arrays do not give it
  std::string_view text;       ///< between its tags
  std::uint64_t offset = 0;    ///< in the appended data
  std::size_t position = 0;    ///< in the file
};

/// The arrays below one element: `<Points>`, `<Cells>`, `<PointData>`, `<CellData>` or
/// `<FieldData>`.
using VtuSection = std::vector<VtuArray>;

struct VtuPiece {
  std::uint64_t n_points = 0, n_cells = 0;
  std::map<std::string, VtuSection, std::less<>> sections;
  /// Attributes of `<PointData>` and `<CellData>`: the role of an array, and its name.
  std::map<std::string, std::map<std::string, std::string>, std::less<>> roles;

  /// Returns null if there is no such array; an empty name means any.
  const VtuArray* array(std::string_view section, std::string_view name) const;
};

/// The elements of a .vtu file with an unstructured grid. No count is trusted: arrays are read only
/// after the file has shown that it can hold them. Each array can be read once: the text of large
/// Base64 arrays is then released, so that large meshes do not need the memory twice. Throws
/// InputError "path:line: ..." for any error.
class VtuFile {
 public:
  VtuFile(const std::filesystem::path& path, std::string content);
  VtuFile(const VtuFile&) = delete;
  VtuFile& operator=(const VtuFile&) = delete;

  const std::vector<VtuPiece>& pieces() const { return pieces_; }
  const VtuSection& field_data() const { return field_data_; }
  /// True if an array of a piece is not text.
  bool has_binary_array() const;

  /// Calls use(number) for the n numbers that the array must have, each as Value: double,
  /// AnyNumber, or std::int64_t, for which the array must hold integers. Calls start() before, when
  /// the numbers are known to exist: allocate memory there.
  template <class Value, class Start, class Use>
  void read(const VtuArray& array, std::uint64_t n, const Start& start, const Use& use) {
    const VtkNumber type = type_of(array);
    if ((std::is_integral_v<Value> || std::is_same_v<Value, AnyInteger>)&&!is_integer(type))
      fail(array, "has numbers of type " + in_quotes(array.type) + " instead of integers");
    if (array.format == "ascii") {
      LineReader lines = open_text(array, n);
      start();
      for (std::uint64_t i = 0; i < n; ++i) use(number_in_text<Value>(lines));
      if (lines.find_word())
        fail(array, "has more values than the " + std::to_string(n) + " announced");
    } else if (n > 0) {
      auto bytes = open_binary(array, n, type);
      start();
      std::vector<char> chunk;
      for (std::uint64_t left = n; left > 0;) {
        const std::size_t n_now = std::min<std::uint64_t>(left, 4096);
        chunk.resize(n_now * size_of(type));
        in_array(array, [&] { bytes.read(chunk.data(), chunk.size()); });
        for_each_vtk_number<Value>(type, encoding_.is_swapped, chunk.data(), n_now, use);
        left -= n_now;
      }
      release(array);
    }
  }

  /// True if the type of an array is one of numbers.
  bool has_numbers(const VtuArray& array) const;
  /// Throws InputError if the type is not one of numbers.
  VtkNumber type_of(const VtuArray& array) const;

  [[noreturn]] void fail(const VtuArray& array, const std::string& message) const;
  /// Throws InputError about a piece as a whole.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  void read_tag();
  void read_file_tag();
  void read_roles();
  void read_array_tag();
  void read_appended();
  std::uint64_t number(std::string_view attribute, std::uint64_t fallback) const;
  void release(const VtuArray& array);

  LineReader open_text(const VtuArray& array, std::uint64_t n) const;
  VtuArrayBytes open_binary(const VtuArray& array, std::uint64_t n, VtkNumber type);

  /// Adds the position of the array to errors of a call.
  template <class Call>
  decltype(auto) in_array(const VtuArray& array, const Call& call) const {
    try {
      return call();
    } catch (const InputError& error) {
      fail(array, error.what());
    }
  }

  template <class Value>
  static Value number_in_text(LineReader& lines) {
    lines.require_word("a number");
    if constexpr (std::is_floating_point_v<Value>) {
      return lines.number("a number");
    } else if constexpr (std::is_same_v<Value, AnyInteger>) {
      const std::string_view found = lines.word();
      if (const auto value = any_integer(found)) return *value;
      lines.fail("found " + in_quotes(found) + ", which is not an integer");
    } else if constexpr (std::is_same_v<Value, AnyNumber>) {
      const std::string_view found = lines.word();
      if (const auto value = any_number(found)) return *value;
      lines.fail("found " + in_quotes(found) + ", which is not a number");
    } else {
      const std::string_view found = lines.word();
      Value value = 0;
      const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
      if (error != std::errc() || end != found.data() + found.size())
        lines.fail("found " + in_quotes(found) + ", which is not an integer");
      return value;
    }
  }

  std::filesystem::path path_;
  std::string content_;
  XmlTags tags_;
  VtuEncoding encoding_;
  std::string_view appended_;
  bool appended_is_base64_ = false;
  std::vector<VtuPiece> pieces_;
  VtuSection field_data_;
  std::uint64_t n_decompressed_ = 0;
};

}  // namespace smoothfem
