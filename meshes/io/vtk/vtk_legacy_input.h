// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "meshes/io/line_reader.h"
#include "meshes/io/vtk/vtk_numbers.h"

namespace smoothfem {

/// The words and numbers of a legacy VTK file. Numbers are text, or big-endian bytes after the line
/// that announces them. All errors are InputErrors "path:line: ..."; lines count as an editor shows
/// them, also in binary files.
class LegacyVtkInput {
 public:
  /// Reads the lines before the data set. The content must outlive the input.
  LegacyVtkInput(const std::filesystem::path& path, std::string_view content);

  /// Returns the first number of the format's version.
  int version() const { return version_; }

  bool is_binary() const { return is_binary_; }

  /// Goes to the next word, the name of a section; false at the end of the file.
  bool next_keyword();
  /// In lower case.
  const std::string& keyword() const { return keyword_; }
  void require_keyword(const std::string& keyword);

  std::string_view word(std::string_view what);
  /// True if this line has another word.
  bool has_word() const { return lines_.has_word(); }
  std::uint64_t count(std::string_view what);
  /// Reads the type that the next word names; it must be a type of numbers.
  VtkNumber number_type();
  VtkNumber integer_type();
  /// Returns nothing if it is not a type of numbers.
  std::optional<VtkNumber> number_type(const std::string& name) const;

  /// Throws InputError for counts of numbers that the file cannot hold.
  void require_numbers(std::uint64_t n, std::uint64_t components, VtkNumber type,
                       const std::string& what) const;
  /// Calls use(number) for n numbers as Value: double, AnyNumber or
  /// std::int64_t. Call require_numbers before.
  template <class Value, class Use>
  void read_numbers(VtkNumber type, std::uint64_t n, std::string_view what, const Use& use) {
    if (is_binary_) {
      for_each_vtk_number<Value>(type, true, lines_.rest().data(), n, use);
      lines_.skip_bytes(n * size_of(type));
    } else {
      for (; n > 0; --n) use(number_in_text<Value>(what));
    }
  }

  /// Skips an array whose type may also be bits or strings.
  void skip_array(const std::string& type, std::uint64_t n_components, std::uint64_t n_tuples);
  /// Skips colours: bytes or, in text, fractions.
  void skip_colours(std::uint64_t n, std::uint64_t n_components);
  /// Skips VTK's information about an array, up to a blank line.
  void skip_metadata();

  /// Returns VTK's number of a cell's type, which must be one byte.
  std::uint8_t cell_type(std::size_t cell, std::int64_t type) const;

  [[noreturn]] void fail(const std::string& message) const { lines_.fail(message); }

 private:
  template <class Value>
  Value number_in_text(std::string_view what) {
    lines_.require_word(what);
    if constexpr (std::is_floating_point_v<Value>) {
      return lines_.number(what);
    } else if constexpr (std::is_same_v<Value, AnyInteger>) {
      const std::string_view found = lines_.word();
      if (const auto value = any_integer(found)) return *value;
      fail(std::string(what) + " is " + in_quotes(found) + ", which is not an integer");
    } else if constexpr (std::is_same_v<Value, AnyNumber>) {
      const std::string_view found = lines_.word();
      if (const auto value = any_number(found)) return *value;
      fail(std::string(what) + " is " + in_quotes(found) + ", which is not a number");
    } else {
      const std::string_view found = lines_.word();
      Value value = 0;
      const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
      if (error != std::errc() || end != found.data() + found.size())
        fail(std::string(what) + " has " + in_quotes(found) + ", which is not an integer");
      return value;
    }
  }

  void skip_numbers(VtkNumber type, std::uint64_t n, std::uint64_t components);
  void skip_bytes(std::uint64_t n);
  void skip_strings(std::uint64_t n);
  void skip_binary_string();

  LineReader lines_;
  int version_ = 0;
  bool is_binary_ = false;
  std::string keyword_;
};

/// Returns the name of an array without VTK's codes, for example %20 for a blank.
std::string decoded_vtk_name(std::string_view name);

}  // namespace smoothfem
