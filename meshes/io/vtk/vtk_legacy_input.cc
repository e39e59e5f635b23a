// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/vtk_legacy_input.h"

#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

/// VTK's indices are 32 bits wide in files.
constexpr std::array type_names{
    VtkNumberName{"char", VtkNumber::int8},
    VtkNumberName{"signed_char", VtkNumber::int8},
    VtkNumberName{"unsigned_char", VtkNumber::uint8},
    VtkNumberName{"short", VtkNumber::int16},
    VtkNumberName{"unsigned_short", VtkNumber::uint16},
    VtkNumberName{"int", VtkNumber::int32},
    VtkNumberName{"unsigned_int", VtkNumber::uint32},
    VtkNumberName{"vtkidtype", VtkNumber::int32},
    VtkNumberName{"long", VtkNumber::int64},
    VtkNumberName{"unsigned_long", VtkNumber::uint64},
    VtkNumberName{"vtktypeint8", VtkNumber::int8},
    VtkNumberName{"vtktypeuint8", VtkNumber::uint8},
    VtkNumberName{"vtktypeint16", VtkNumber::int16},
    VtkNumberName{"vtktypeuint16", VtkNumber::uint16},
    VtkNumberName{"vtktypeint32", VtkNumber::int32},
    VtkNumberName{"vtktypeuint32", VtkNumber::uint32},
    VtkNumberName{"vtktypeint64", VtkNumber::int64},
    VtkNumberName{"vtktypeuint64", VtkNumber::uint64},
    VtkNumberName{"float", VtkNumber::float32},
    VtkNumberName{"double", VtkNumber::float64},
};

}  // namespace

LegacyVtkInput::LegacyVtkInput(const std::filesystem::path& path, std::string_view content)
    : lines_(path, content) {
  constexpr std::string_view title = "# vtk DataFile Version ";
  const std::string_view first = lines_.whole_line().value_or("");
  if (!first.starts_with(title.substr(0, 14)))
    fail("the first line is not '# vtk DataFile Version ...'; this is not a legacy VTK file");
  if (first.size() > title.size()) version_ = first[title.size()] - '0';
  if (!lines_.whole_line()) fail("the file ends after its first line; it is truncated");
  const std::string type = lower_case(word("the file type, ASCII or BINARY"));
  is_binary_ = type.starts_with("binary");
  if (!is_binary_ && !type.starts_with("ascii"))
    fail("the file type is " + in_quotes(type) + " instead of ASCII or BINARY");
}

bool LegacyVtkInput::next_keyword() {
  if (!lines_.find_word()) return false;
  keyword_ = lower_case(lines_.word());
  return true;
}

void LegacyVtkInput::require_keyword(const std::string& keyword) {
  const std::string_view found = word("'" + keyword + "'");
  if (lower_case(found) != keyword)
    fail("expected '" + keyword + "', but found " + in_quotes(found));
}

std::string_view LegacyVtkInput::word(std::string_view what) {
  lines_.require_word(what);
  return lines_.word();
}

std::uint64_t LegacyVtkInput::count(std::string_view what) {
  lines_.require_word(what);
  return lines_.integer(what);
}

VtkNumber LegacyVtkInput::number_type() {
  const std::string_view name = word("the type of the numbers");
  if (const auto type = number_type(std::string(name))) return *type;
  fail("the type " + in_quotes(name) + " of the numbers is not known");
}

VtkNumber LegacyVtkInput::integer_type() {
  const VtkNumber type = number_type();
  if (!is_integer(type)) fail("these numbers must be integers");
  return type;
}

std::optional<VtkNumber> LegacyVtkInput::number_type(const std::string& name) const {
  return vtk_number(type_names, lower_case(name));
}

void LegacyVtkInput::require_numbers(std::uint64_t n, std::uint64_t components, VtkNumber type,
                                     const std::string& what) const {
  // In text a number has at least two bytes, except for the last one of a file; some numbers may be
  // on this line.
  const std::uint64_t n_bytes =
      is_binary_ ? lines_.rest().size() : lines_.rest().size() + lines_.text().size() + 1;
  const std::uint64_t most = n_bytes / (is_binary_ ? size_of(type) : 2);
  if (components > 0 && n > most / components)
    fail(std::to_string(n) + " " + what +
         " are announced, more than the file has; it is truncated "
         "or the count is wrong");
}

void LegacyVtkInput::skip_bytes(std::uint64_t n) {
  if (n > lines_.rest().size())
    fail("the array has fewer values than announced; the file is truncated");
  lines_.skip_bytes(n);
}

void LegacyVtkInput::skip_numbers(VtkNumber type, std::uint64_t n, std::uint64_t components) {
  require_numbers(n, components, type, "values");
  if (is_binary_) return lines_.skip_bytes(n * components * size_of(type));
  for (std::uint64_t i = n * components; i > 0; --i) word("a value");
}

void LegacyVtkInput::skip_array(const std::string& type_name, std::uint64_t n_components,
                                std::uint64_t n_tuples) {
  if (const auto type = number_type(type_name)) return skip_numbers(*type, n_tuples, n_components);
  // A bit takes at least an eighth of a byte, and a string at least one byte.
  require_numbers(n_components, n_tuples > 0 ? 1 : 0, VtkNumber::int8, "components");
  require_numbers(n_tuples / 8, n_components, VtkNumber::int8, "values");
  const std::string name = lower_case(type_name);
  const std::uint64_t n = n_components * n_tuples;
  if (name == "string") return skip_strings(n);
  if (name != "bit") fail("the type " + in_quotes(type_name) + " of an array is not known");
  if (is_binary_) return skip_bytes((n + 7) / 8);
  for (std::uint64_t i = n; i > 0; --i) word("a value");
}

void LegacyVtkInput::skip_colours(std::uint64_t n, std::uint64_t n_components) {
  skip_numbers(VtkNumber::uint8, n, n_components);
}

void LegacyVtkInput::skip_strings(std::uint64_t n) {
  for (; n > 0; --n) {
    if (is_binary_)
      skip_binary_string();
    else if (!lines_.whole_line())
      fail("the file ends before the last string of an array; it is truncated");
  }
}

/// The two highest bits of the first byte define the number of bytes of the length.
void LegacyVtkInput::skip_binary_string() {
  const std::string_view rest = lines_.rest();
  if (rest.empty()) fail("the file ends before the last string of an array; it is truncated");
  const auto first = static_cast<unsigned char>(rest.front());
  const std::size_t n_bytes = std::size_t{8} >> (first >> 6);
  std::uint64_t length = first & 0x3F;
  for (std::size_t i = 1; i < n_bytes && i < rest.size(); ++i)
    length = length << 8 | static_cast<unsigned char>(rest[i]);
  skip_bytes(n_bytes);
  skip_bytes(length);
}

void LegacyVtkInput::skip_metadata() {
  while (const auto line = lines_.whole_line())
    if (line->find_first_not_of(" \t\r") == line->npos) return;
}

std::string decoded_vtk_name(std::string_view name) {
  std::string decoded;
  for (std::size_t i = 0; i < name.size(); ++i) {
    int code = 0;
    const char* const digits = name.data() + i + 1;
    if (name[i] == '%' && i + 2 < name.size() &&
        std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
      decoded += static_cast<char>(code);
      i += 2;
    } else {
      decoded += name[i];
    }
  }
  return decoded;
}

std::uint8_t LegacyVtkInput::cell_type(std::size_t cell, std::int64_t type) const {
  if (type < 0 || type > 255)
    fail("cell " + std::to_string(cell) + " has the VTK type " + std::to_string(type) +
         ", which there is not");
  return static_cast<std::uint8_t>(type);
}

}  // namespace smoothfem
