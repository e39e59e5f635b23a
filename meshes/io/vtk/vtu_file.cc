// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/vtu_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>

namespace smoothfem {

namespace {

constexpr std::array<std::string_view, 5> section_names{"Points", "Cells", "PointData", "CellData",
                                                        "FieldData"};

}  // namespace

const VtuArray* VtuPiece::array(std::string_view section, std::string_view name) const {
  const auto arrays = sections.find(section);
  if (arrays == sections.end()) return nullptr;
  for (const VtuArray& array : arrays->second)
    if (name.empty() || array.name == name) return &array;
  return nullptr;
}

VtuFile::VtuFile(const std::filesystem::path& path, std::string content)
    : path_(path), content_(std::move(content)), tags_(path.string(), content_) {
  if (content_.find("<VTKFile") == content_.npos)
    throw InputError(path.string() +
                     ": the file has no element <VTKFile>; this is not a .vtu file");
  while (tags_.next())
    if (tags_.tag().begins) read_tag();
}

void VtuFile::fail(const VtuArray& array, const std::string& message) const {
  const std::string name(array.name.substr(0, 40));
  tags_.fail_at(array.position, "the array " + in_quotes(name) + " " + message);
}

void VtuFile::fail(const std::string& message) const {
  throw InputError(path_.string() + ": " + message);
}

void VtuFile::read_tag() {
  const std::string_view name = tags_.tag().name;
  if (name == "VTKFile")
    read_file_tag();
  else if (name == "Piece")
    pieces_.push_back({number("NumberOfPoints", 0), number("NumberOfCells", 0), {}, {}});
  else if (name == "PointData" || name == "CellData")
    read_roles();
  else if (name == "DataArray" || name == "Array")
    read_array_tag();
  else if (name == "AppendedData")
    read_appended();
}

std::uint64_t VtuFile::number(std::string_view attribute, std::uint64_t fallback) const {
  const auto text = tags_.tag().attribute(attribute);
  if (!text) return fallback;
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (error != std::errc() || end != text->data() + text->size())
    tags_.fail(std::string(attribute) + " is " + in_quotes(*text) +
               ", which is not an integer of at least 0");
  return value;
}

void VtuFile::read_file_tag() {
  const XmlTag& tag = tags_.tag();
  if (tag.attribute("type") != "UnstructuredGrid")
    tags_.fail("the file holds no unstructured grid, but " +
               in_quotes(tag.attribute("type").value_or("")));
  const auto choice = [&](std::string_view attribute, std::string_view first,
                          std::string_view second) {
    const std::string_view value = tag.attribute(attribute).value_or(first);
    if (value != first && value != second)
      tags_.fail(std::string(attribute) + " is " + in_quotes(value) + " instead of " +
                 std::string(first) + " or " + std::string(second));
    return value == second;
  };
  encoding_.is_swapped = choice("byte_order", "LittleEndian", "BigEndian");
  encoding_.header_size = choice("header_type", "UInt32", "UInt64") ? 8 : 4;
  encoding_.compressor = tag.attribute("compressor").value_or("");
}

/// Sections outside pieces are of damaged files, and so are their arrays.
void VtuFile::read_roles() {
  if (pieces_.empty()) return;
  auto& roles = pieces_.back().roles[std::string(tags_.tag().name)];
  for (const auto& [role, name] : tags_.tag().attributes) roles.emplace(role, name);
}

void VtuFile::read_array_tag() {
  const XmlTag& tag = tags_.tag();
  const std::string_view section = tags_.parent();
  if (std::find(section_names.begin(), section_names.end(), section) == section_names.end()) return;
  VtuArray array{.name = tag.attribute("Name").value_or(section),
                 .type = tag.attribute("type").value_or(""),
                 .format = tag.attribute("format").value_or("ascii"),
                 .n_components = number("NumberOfComponents", 1),
                 .n_tuples = number("NumberOfTuples", 0),
                 .text = {},
                 .offset = number("offset", 0),
                 .position = tag.first};
  if (!tag.ends)
    array.text = std::string_view(content_).substr(
        tag.past_last,
        std::min(content_.find('<', tag.past_last), content_.size()) - tag.past_last);
  if (section == "FieldData")
    field_data_.push_back(array);
  else if (pieces_.empty())
    tags_.fail("arrays of points and cells must stand in an element <Piece>");
  else
    pieces_.back().sections[std::string(section)].push_back(array);
}

/// Raw data may contain tags, so that the rest of the file is searched from its end.
void VtuFile::read_appended() {
  const XmlTag& tag = tags_.tag();
  const std::string_view encoding = tag.attribute("encoding").value_or("base64");
  appended_is_base64_ = encoding == "base64";
  if (!appended_is_base64_ && encoding != "raw")
    tags_.fail("the encoding is " + in_quotes(encoding) + " instead of raw or base64");
  const std::size_t begin = content_.find('_', tag.past_last),
                    end = content_.rfind("</AppendedData");
  if (begin == content_.npos || end == content_.npos || end < begin)
    tags_.fail(
        "the appended data have no beginning '_' or no end; the file is truncated or damaged");
  appended_ = std::string_view(content_).substr(begin + 1, end - begin - 1);
  tags_.go_to(end);
}

bool VtuFile::has_binary_array() const {
  for (const VtuPiece& piece : pieces_)
    for (const auto& [name, section] : piece.sections)
      for (const VtuArray& array : section)
        if (array.format != "ascii") return true;
  return false;
}

bool VtuFile::has_numbers(const VtuArray& array) const {
  return vtk_number(vtu_type_names, array.type).has_value();
}

VtkNumber VtuFile::type_of(const VtuArray& array) const {
  if (const auto type = vtk_number(vtu_type_names, array.type)) return *type;
  fail(array, "has numbers of the type " + in_quotes(array.type) + ", which is not known");
}

/// Releases whole pages only, and only if they are worth the call.
void VtuFile::release(const VtuArray& array) {
  constexpr std::size_t least = std::size_t{1} << 20;
  if (array.text.size() < least) return;
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  void* begin = content_.data() + (array.text.data() - content_.data());
  std::size_t size = array.text.size() - page;
  if (std::align(page, size - page, begin, size))
    ::madvise(begin, size / page * page, MADV_DONTNEED);
}

LineReader VtuFile::open_text(const VtuArray& array, std::uint64_t n) const {
  if (n > array.text.size() / 2 + 1)
    fail(array, "has fewer values than the " + std::to_string(n) + " announced");
  const auto begin = static_cast<std::size_t>(array.text.data() - content_.data());
  if (array.text.empty()) return LineReader(path_, {});
  LineReader lines(path_, std::string_view(content_).substr(0, begin + array.text.size()));
  lines.skip_bytes(begin);
  return lines;
}

VtuArrayBytes VtuFile::open_binary(const VtuArray& array, std::uint64_t n, VtkNumber type) {
  if (array.format != "binary" && array.format != "appended")
    fail(array,
         "has the format " + in_quotes(array.format) + " instead of ascii, binary or appended");
  const bool is_appended = array.format == "appended";
  if (is_appended && array.offset > appended_.size())
    fail(array, "begins behind the end of the appended data; the file is truncated or damaged");
  const VtuBytes encoded = is_appended
                               ? VtuBytes(appended_.substr(array.offset), appended_is_base64_)
                               : VtuBytes(array.text, true);
  return in_array(array, [&] {
    VtuArrayBytes bytes(encoded, encoding_);
    if (bytes.size() % size_of(type) != 0 || bytes.size() / size_of(type) != n)
      throw InputError("has " + std::to_string(bytes.size()) + " bytes, but its " +
                       std::to_string(n) + " values need " + std::to_string(size_of(type)) +
                       " bytes each; the file is damaged");
    n_decompressed_ += bytes.is_compressed() ? bytes.size() : 0;
    if (n_decompressed_ > max_decompressed_size(content_.size()))
      throw InputError(
          "would be more than 100 times as large as the file when decompressed; it is damaged");
    return bytes;
  });
}

}  // namespace smoothfem
