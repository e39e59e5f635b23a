// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/vtu_layout.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include "meshes/io/line_reader.h"
#include "meshes/io/vtk/vtk_grid.h"
#include "meshes/io/vtk/vtu_bytes.h"
#include "meshes/io/vtk/xml_tags.h"
#include "smoothing/base/input_error.h"
#include "smoothing/mesh/interfaces.h"

namespace smoothfem {

namespace {

constexpr std::string_view damaged = "it is damaged";

/// A tag of the file, with its own text.
struct FileTag {
  std::uint64_t at = 0;  ///< position in the file
  std::string text{};
  std::string name{};
  bool begins = false, ends = false;

  /// Returns the range of an attribute's value in the text, and the value.
  std::optional<std::string_view> attribute(std::string_view wanted) const {
    for (const auto& [attribute, value] : attributes)
      if (attribute == wanted) return std::string_view(text).substr(value.first, value.second);
    return {};
  }
  /// Returns where a value, as attribute() gives it, lies in the file.
  std::uint64_t position_of(std::string_view value) const {
    return at + static_cast<std::uint64_t>(value.data() - text.data());
  }

  std::vector<std::pair<std::string, std::pair<std::size_t, std::size_t>>> attributes{};
};

struct FoundArray {
  FileTag tag;
  std::string section;
  std::uint64_t at = 0;  ///< of inline data
  std::string name() const { return std::string(tag.attribute("Name").value_or(section)); }
  std::string_view format() const { return tag.attribute("format").value_or("ascii"); }
  bool has(std::string_view wanted_section, std::string_view wanted_name) const {
    return section == wanted_section && (wanted_name.empty() || name() == wanted_name);
  }
};

/// Thrown for the reasons that make a file one for the first process alone.
struct Obstacle {
  std::string why;
};

/// Goes through the tags of a file.
class VtuScan {
 public:
  explicit VtuScan(const std::filesystem::path& path) : path_(path), file_(path) {}

  VtuLayout layout() {
    while (appended_at_ == 0 && next())
      if (tag_.begins) visit();
    if (appended_at_ == 0 && !is_complete_) refuse(damaged);
    if (n_pieces_ != 1)
      refuse(n_pieces_ == 0 ? std::string(damaged)
                            : "it has " + std::to_string(n_pieces_) + " pieces");
    if (layout_.arrays.n_points == 0 || layout_.arrays.n_cells == 0)
      refuse("it has no points or no cells");
    if (std::max(layout_.arrays.n_points, layout_.arrays.n_cells) >= UINT32_MAX)
      refuse("it has numbers above 32 bits");
    find_arrays();
    prepare_copy();
    return std::move(layout_);
  }

 private:
  [[noreturn]] static void refuse(std::string_view why) { throw Obstacle{std::string(why)}; }

  [[noreturn]] static void refuse_text(const FoundArray& array) {
    refuse("its array " + in_quotes(array.name()) + " is text");
  }

  // --- Tags ---

  /// Returns a character of the file, 0 at the end.
  char character(std::uint64_t position) {
    constexpr std::uint64_t step = std::uint64_t{1} << 16;
    if (position >= file_.size()) return '\0';
    if (position < window_at_ || position >= window_at_ + window_.size()) {
      window_at_ = position;
      window_.resize(std::min(step, file_.size() - position));
      file_.read(window_at_, window_);
    }
    return window_[position - window_at_];
  }

  /// Goes to the next character of this kind, or the end of the file.
  void find(char wanted) {
    while (at_ < file_.size() && character(at_) != wanted)
      at_ = window_at_ + std::min(window_.find(wanted, at_ - window_at_), window_.size());
  }

  /// Finds the next tag, past declarations; false at the end of the file.
  bool next() {
    constexpr std::size_t most = std::size_t{1} << 20;
    do {
      find('<');
      if (at_ >= file_.size()) {
        is_complete_ = open_.empty() && n_pieces_ > 0;
        return false;
      }
      tag_ = {.at = at_};
      char quote = '\0';
      for (char c = '\0'; c != '>' || quote != '\0' || !is_closed();) {
        c = character(at_++);
        if (c == '\0' || tag_.text.size() > most) refuse(damaged);
        tag_.text += c;
        if (tag_.text.starts_with("<!")) continue;  // quotes have no meaning there
        if (quote == '\0' && (c == '"' || c == '\''))
          quote = c;
        else if (c == quote)
          quote = '\0';
      }
      if (tag_.text.starts_with("<!") && !is_comment()) refuse("it declares a type of documents");
    } while (tag_.text.starts_with("<?") || is_comment());
    read_tag();
    return true;
  }

  bool is_comment() const { return tag_.text.starts_with("<!--"); }
  bool is_closed() const {
    return !is_comment() || (tag_.text.size() >= 7 && tag_.text.ends_with("-->"));
  }

  void read_tag() {
    if (tag_.text.starts_with("</")) {
      tag_.ends = true;
      tag_.name = tag_.text.substr(2, tag_.text.find_first_of(" \t\r\n>") - 2);
      if (open_.empty() || open_.back() != tag_.name) refuse(damaged);
      open_.pop_back();
      if (tag_.name == "InformationKey" && range_at_ != 0)
        layout_.edits.push_back({range_at_, at_ - range_at_, ""});
      if (tag_.name == "InformationKey") range_at_ = 0;
      return;
    }
    XmlTags tags(path_.string(), tag_.text);
    if (tags.next()) {
      tag_.name = tags.tag().name;
      tag_.begins = true;
      tag_.ends = tags.tag().ends;
      for (const auto& [attribute, value] : tags.tag().attributes)
        tag_.attributes.emplace_back(
            attribute,
            std::pair(static_cast<std::size_t>(value.data() - tag_.text.data()), value.size()));
    }
  }

  std::uint64_t number(const FileTag& tag, std::string_view attribute,
                       std::uint64_t fallback) const {
    const auto text = tag.attribute(attribute);
    if (!text) return fallback;
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
    if (error != std::errc() || end != text->data() + text->size()) refuse(damaged);
    return value;
  }

  void visit() {
    if (tag_.name == "VTKFile")
      visit_file();
    else if (tag_.name == "Piece")
      visit_piece();
    else if (tag_.name == "CellData" && tag_.attribute("GlobalIds"))
      refuse("its cells have an array with the role GlobalIds");
    else if (tag_.name == "AppendedData")
      return visit_appended();
    else if (tag_.name == "InformationKey")
      visit_key();
    if (tag_.name == "DataArray" || tag_.name == "Array") visit_array();
    if (!tag_.ends) open_.push_back(tag_.name);
  }

  void visit_file() {
    if (tag_.attribute("type") != "UnstructuredGrid") refuse("it holds no unstructured grid");
    if (tag_.attribute("byte_order").value_or("LittleEndian") != "LittleEndian")
      refuse("it has another byte order");
    const std::string_view header = tag_.attribute("header_type").value_or("UInt32"),
                           compressor = tag_.attribute("compressor").value_or("");
    if (header != "UInt32" && header != "UInt64") refuse(damaged);
    const auto* const found = std::find(vtu_compressors.begin(), vtu_compressors.end(), compressor);
    if (found == vtu_compressors.end()) refuse(damaged);
    packing() = {.compressor = static_cast<std::uint32_t>(found - vtu_compressors.begin()),
                 .header_size = header == "UInt64" ? 8u : 4u};
  }

  void visit_piece() {
    ++n_pieces_;
    layout_.arrays.n_points = number(tag_, "NumberOfPoints", 0);
    layout_.arrays.n_cells = number(tag_, "NumberOfCells", 0);
  }

  /// Ranges of the points are left out of copies.
  void visit_key() {
    if (open_.size() >= 2 && open_[open_.size() - 2] == "Points" && !tag_.ends &&
        tag_.attribute("name").value_or("").ends_with("_RANGE"))
      range_at_ = tag_.at;
  }

  /// Goes past the data of inline arrays, in which tags need not be looked for.
  void visit_array() {
    FoundArray array{.tag = tag_, .section = open_.empty() ? std::string() : open_.back()};
    if (array.format() == "ascii" && (array.section == "Points" || array.section == "Cells"))
      refuse_text(array);
    if (array.format() == "binary" && !tag_.ends) {
      skip_blanks();
      array.at = at_;
      if (character(at_) != '<') {
        at_ = VtuArrayParts(file_, array.name(), {.at = at_, .is_base64 = true}, packing())
                  .past_last();
        skip_blanks();
        if (character(at_) != '<') refuse(damaged);
      }
    }
    arrays_.push_back(std::move(array));
  }

  void skip_blanks() {
    constexpr std::string_view blanks = " \t\r\n";
    while (at_ < file_.size() && blanks.find(character(at_)) != blanks.npos) ++at_;
  }

  void visit_appended() {
    const std::string_view encoding = tag_.attribute("encoding").value_or("base64");
    if (encoding != "base64" && encoding != "raw") refuse(damaged);
    appended_is_base64_ = encoding == "base64";
    skip_blanks();
    if (character(at_) != '_') refuse(damaged);
    appended_at_ = at_ + 1;
    constexpr std::uint64_t most = 1024;  // of the text behind the data
    const std::uint64_t begin = std::max(appended_at_, file_.size() - std::min(most, file_.size()));
    std::string tail(file_.size() - begin, '\0');
    file_.read(begin, tail);
    const std::size_t end = tail.rfind("</AppendedData");
    if (end == tail.npos || tail.find("</VTKFile>", end) == tail.npos) refuse(damaged);
    appended_end_ = begin + end;
  }

  // --- Arrays ---

  VtuPacking& packing() { return layout_.arrays.packing; }

  const FoundArray* find(std::string_view section, std::string_view name) const {
    for (const FoundArray& array : arrays_)
      if (array.has(section, name)) return &array;
    return nullptr;
  }

  /// Returns where an array of n tuples lies. An empty name means any.
  VtuPlace place(std::string_view section, std::string_view name, std::uint64_t n) {
    const FoundArray* array = find(section, name);
    if (!array) return {};
    const auto type =
        vtk_number(vtu_type_names, array->tag.attribute("type").value_or(std::string_view()));
    if (!type) return {};
    if (array->format() == "ascii") refuse_text(*array);
    VtuPlace found{.n = n,
                   .at = array->at,
                   .n_components = number(array->tag, "NumberOfComponents", 1),
                   .type = *type,
                   .is_base64 = true};
    if (array->format() == "appended") {
      const std::uint64_t offset = number(array->tag, "offset", 0);
      if (appended_at_ == 0 || offset >= appended_end_ - appended_at_) refuse(damaged);
      found.at = appended_at_ + offset;
      found.is_base64 = appended_is_base64_;
    } else if (array->format() != "binary" || found.at == 0) {
      refuse(damaged);
    }
    const VtuArrayParts parts(file_, array->name(), found, packing());
    const std::uint64_t tuple = size_of(*type) * found.n_components;
    if (found.n_components == 0 || found.n_components > UINT32_MAX)  // no overflow below
      refuse(damaged);
    if (n == UINT64_MAX) found.n = parts.n_bytes() / tuple;
    if (parts.n_bytes() / tuple != found.n || parts.n_bytes() % tuple != 0) refuse(damaged);
    if (appended_at_ != 0 && found.at >= appended_at_ && parts.past_last() > appended_end_)
      refuse(damaged);
    constexpr std::uint64_t large = std::uint64_t{1} << 24;
    if (parts.block_size() > large) refuse("its compressed blocks are large");
    n_decompressed_ += parts.n_bytes();
    if (packing().compressor != 0 && n_decompressed_ > max_decompressed_size(file_.size()))
      refuse(damaged);
    return found;
  }

  /// Returns the place of the first of these arrays that the file has.
  template <class Names>
  VtuPlace first_of(const Names& names, std::uint64_t n) {
    for (const std::string_view name : names)
      if (const VtuPlace found = place("CellData", name, n); found.n > 0) return found;
    return {};
  }

  void refuse_marks() const {
    for (const char* name : {required_field, corner_field, ridge_field})
      if (find("PointData", name) || find("CellData", name))
        refuse("its data '" + std::string(name) + "' say which nodes must stay");
    if (find("CellData", "vtkGhostType")) refuse("it has ghost cells");
  }

  void find_arrays() {
    refuse_marks();
    VtuArrays& arrays = layout_.arrays;
    arrays.points = place("Points", "", arrays.n_points);
    arrays.offsets = place("Cells", "offsets", arrays.n_cells);
    arrays.types = place("Cells", "types", arrays.n_cells);
    arrays.connectivity = place("Cells", "connectivity", UINT64_MAX);
    arrays.fixed = place("PointData", "fixed", arrays.n_points);
    arrays.node_ids = place("PointData", "node_id", arrays.n_points);
    arrays.cell_ids = place("CellData", "cell_id", arrays.n_cells);
    arrays.tags = first_of(vtk_tag_fields, arrays.n_cells);
    arrays.lower_tags = first_of(vtk_boundary_fields, arrays.n_cells);
    if (arrays.points.n == 0 || arrays.points.n_components != 3) refuse(damaged);
    for (const VtuPlace& integers : {arrays.offsets, arrays.types, arrays.connectivity})
      if (integers.n == 0 || integers.n_components != 1 || !is_integer(integers.type))
        refuse(damaged);
    VtuArrayParts offsets(file_, "offsets", arrays.offsets, packing());
    std::uint64_t n_corners = 0;
    offsets.read<std::int64_t>(arrays.n_cells - 1, arrays.n_cells, false, [&](std::int64_t offset) {
      n_corners = static_cast<std::uint64_t>(offset);
    });
    if (n_corners != arrays.connectivity.n) refuse(damaged);
  }

  // --- Copies ---

  /// The tag of the points: numbers of 64 bits, and no range, which would be that of the old ones.
  void prepare_copy() {
    const FoundArray& points = *find("Points", "");
    if (std::count_if(arrays_.begin(), arrays_.end(),
                      [](const FoundArray& array) { return array.section == "Points"; }) > 1)
      refuse("it has several arrays of points");
    if (packing().header_size == 4 && packing().compressor == 0 &&
        24 * layout_.arrays.n_points > UINT32_MAX)
      refuse("its points with 64 bits would not fit into its headers of 32 bits");
    const auto edit = [&](std::string_view attribute, const std::string& text) {
      const auto value = points.tag.attribute(attribute);
      if (value && *value != text)
        layout_.edits.push_back({points.tag.position_of(*value), value->size(), text});
    };
    edit("type", "Float64");
    for (const auto& [attribute, value] : points.tag.attributes)
      if (attribute == "RangeMin" || attribute == "RangeMax") {
        const std::uint64_t end = points.tag.at + value.first + value.second + 1;
        std::uint64_t begin = points.tag.at + points.tag.text.rfind(attribute, value.first);
        if (character(begin - 1) == ' ') --begin;
        layout_.edits.push_back({begin, end - begin, ""});
      }
    layout_.points_end =
        VtuArrayParts(file_, "Points", layout_.arrays.points, packing()).past_last();
    if (points.format() != "appended") return;
    const std::uint64_t own = layout_.arrays.points.at - appended_at_;
    for (const FoundArray& array : arrays_) {
      const auto text = array.tag.attribute("offset");
      if (array.format() != "appended" || !text || &array == &points) continue;
      const std::uint64_t offset = number(array.tag, "offset", 0);
      if (offset >= own && appended_at_ + offset < layout_.points_end) refuse(damaged);
      if (offset > own)
        layout_.later_offsets.push_back({array.tag.position_of(*text), text->size(), offset});
    }
  }

  std::filesystem::path path_;
  FileParts file_;
  std::uint64_t at_ = 0, window_at_ = 0;
  std::string window_;
  FileTag tag_;
  std::vector<std::string> open_;
  std::uint64_t range_at_ = 0;  ///< of an open element with a range of the points
  bool is_complete_ = false, appended_is_base64_ = false;
  std::uint64_t appended_at_ = 0, appended_end_ = 0, n_decompressed_ = 0;
  std::size_t n_pieces_ = 0;
  std::vector<FoundArray> arrays_;
  VtuLayout layout_;
};

}  // namespace

bool begins_as_vtk_xml(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  try {
    const FileParts file(path);
    std::string beginning(std::min<std::uint64_t>(file.size(), 1024), '\0');
    file.read(0, beginning);
    return beginning.find("<VTKFile") != beginning.npos;
  } catch (const InputError&) {
    return false;
  }
}

VtuLayout vtu_layout(const std::filesystem::path& path) {
  try {
    return VtuScan(path).layout();
  } catch (const Obstacle& obstacle) {
    return {.obstacle = obstacle.why};
  } catch (const InputError&) {
    return {.obstacle = std::string(damaged)};
  }
}

}  // namespace smoothfem
