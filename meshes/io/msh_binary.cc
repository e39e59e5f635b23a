#include <algorithm>
#include <cstring>
#include <string>
#include <unordered_set>

#include "meshes/io/msh_file.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

/// Walks through a binary file without trusting any count: Gmsh crashes or never returns on wrong
/// ones.
class BinaryMshScanner {
 public:
  BinaryMshScanner(const std::string& path, std::string_view content)
      : path_(path), content_(content) {}

  std::uint64_t scan(bool version_4) {
    line();  // $MeshFormat
    line();  // version, type, size
    if (take<std::int32_t>() != 1) fail("the file was written with another byte order");
    require_end("$MeshFormat");
    bool has_nodes = false, has_elements = false;
    while (skip_blanks()) {
      const std::string section(line());
      if (!section.starts_with('$')) fail("expected the beginning of a section");
      if (section == "$Nodes") {
        version_4 ? scan_nodes_4() : scan_nodes_2();
        has_nodes = true;
      } else if (section == "$Elements") {
        version_4 ? scan_elements_4() : scan_elements_2();
        has_elements = true;
      } else if (section == "$Entities" && version_4) {
        scan_entities();
      } else {
        const std::size_t end = content_.find("$End" + section.substr(1), at_);
        if (end == std::string_view::npos) fail("the section " + section + " has no end");
        at_ = end;
      }
      require_end(section);
    }
    if (!has_nodes || !has_elements)
      throw InputError(path_ + ": the file has no section " + (has_nodes ? "$Elements" : "$Nodes") +
                       "; it is truncated or holds no mesh");
    return n_elements_;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(path_ + ": at byte " + std::to_string(at_) + ": " + message +
                     "; the file is truncated or damaged");
  }

  std::string_view line() {
    const std::size_t begin = at_, end = content_.find('\n', at_);
    if (end == std::string_view::npos) fail("a line has no end");
    at_ = end + 1;
    return content_.substr(begin, end - begin);
  }

  bool skip_blanks() {
    at_ = std::min(content_.find_first_not_of(" \r\n", at_), content_.size());
    return at_ < content_.size();
  }

  void require_end(const std::string& section) {
    const std::string end = "$End" + section.substr(1);
    if (!skip_blanks() || !content_.substr(at_).starts_with(end)) fail("expected " + end);
    at_ += end.size();
  }

  template <class T>
  T take() {
    require(1, sizeof(T));
    T value;
    std::memcpy(&value, content_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }

  void skip(std::uint64_t n, std::size_t size) {
    require(n, size);
    at_ += n * size;
  }

  /// n items of a size have to be left.
  void require(std::uint64_t n, std::size_t size) const {
    if (n > (content_.size() - at_) / size) fail("a count is larger than the file");
  }

  std::uint64_t count_in_text() {
    const std::string text(line());
    if (text.empty() || text.size() > 18 || text.find_first_not_of("0123456789") != text.npos)
      fail("expected a count");
    return std::stoull(text);
  }

  void add_node(std::uint64_t tag) {
    if (!nodes_.insert(tag).second) fail("node " + std::to_string(tag) + " appears twice");
  }

  void require_node(std::uint64_t tag) const {
    if (!nodes_.contains(tag))
      fail("an element names node " + std::to_string(tag) + ", which the file does not have");
  }

  /// Gmsh reserves memory for all tags up to the announced one.
  void require_range(std::uint64_t first, std::uint64_t last, std::uint64_t smallest,
                     std::uint64_t largest) const {
    if (first != smallest || last != largest) fail("tags are not in the announced range");
  }

  void scan_nodes_2() {
    const std::uint64_t n = count_in_text();
    for (std::uint64_t i = 0; i < n; ++i) {
      add_node(static_cast<std::uint64_t>(take<std::int32_t>()));
      skip(3, sizeof(double));
    }
  }

  void scan_elements_2() {
    n_elements_ = count_in_text();
    for (std::uint64_t found = 0; found < n_elements_;) {
      const std::uint64_t n_nodes = nodes_of_type(take<std::int32_t>());
      const auto n = take<std::int32_t>(), n_tags = take<std::int32_t>();
      if (n < 1 || n_tags < 0) fail("a block of elements has a wrong count");
      found += static_cast<std::uint64_t>(n);
      for (std::int32_t i = 0; i < n; ++i) {
        skip(1 + static_cast<std::uint64_t>(n_tags), sizeof(std::int32_t));
        for (std::uint64_t k = 0; k < n_nodes; ++k)
          require_node(static_cast<std::uint64_t>(take<std::int32_t>()));
      }
    }
  }

  void scan_entities() {
    std::uint64_t n[4];
    for (auto& count : n) count = take<std::uint64_t>();
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::uint64_t i = 0; i < n[dimension]; ++i) {
        skip(1, sizeof(std::int32_t));
        skip(dimension == 0 ? 3 : 6, sizeof(double));
        skip(take<std::uint64_t>(), sizeof(std::int32_t));                     // groups
        if (dimension > 0) skip(take<std::uint64_t>(), sizeof(std::int32_t));  // boundary
      }
  }

  void scan_nodes_4() {
    const auto n_blocks = take<std::uint64_t>(), n_nodes = take<std::uint64_t>();
    const auto smallest = take<std::uint64_t>(), largest = take<std::uint64_t>();
    for (std::uint64_t b = 0; b < n_blocks; ++b) {
      const auto dimension = take<std::int32_t>();
      skip(1, sizeof(std::int32_t));
      const auto parametric = take<std::int32_t>();
      const auto n = take<std::uint64_t>();
      if (dimension < 0 || dimension > 3) fail("an entity has a wrong dimension");
      require(n, 4 * sizeof(double));
      for (std::uint64_t i = 0; i < n; ++i) add_node(take<std::uint64_t>());
      skip(n, (3 + (parametric ? static_cast<std::size_t>(dimension) : 0)) * sizeof(double));
    }
    if (nodes_.size() != n_nodes) fail("there are not as many nodes as announced");
    if (nodes_.empty()) fail("there are no nodes");
    const auto [first, last] = std::minmax_element(nodes_.begin(), nodes_.end());
    require_range(*first, *last, smallest, largest);
  }

  void scan_elements_4() {
    const auto n_blocks = take<std::uint64_t>();
    n_elements_ = take<std::uint64_t>();
    const auto smallest = take<std::uint64_t>(), largest = take<std::uint64_t>();
    std::uint64_t first = UINT64_MAX, last = 0, n_found = 0;
    for (std::uint64_t b = 0; b < n_blocks; ++b) {
      skip(2, sizeof(std::int32_t));
      const std::uint64_t n_nodes = nodes_of_type(take<std::int32_t>());
      const auto n = take<std::uint64_t>();
      for (std::uint64_t i = 0; i < n; ++i) {
        const auto tag = take<std::uint64_t>();
        ++n_found;
        first = std::min(first, tag);
        last = std::max(last, tag);
        for (std::uint64_t k = 0; k < n_nodes; ++k) require_node(take<std::uint64_t>());
      }
    }
    if (n_found != n_elements_) fail("there are not as many elements as announced");
    if (first <= last) require_range(first, last, smallest, largest);
  }

  /// Points, lines, triangles, quadrilaterals and volumes, by Gmsh's numbers of the types.
  std::uint64_t nodes_of_type(std::int32_t type) const {
    switch (type) {
      case 15:
        return 1;
      case 1:
        return 2;
      case 2:
        return 3;
      case 3:
      case 4:
        return 4;
      case 5:
        return 8;
      case 6:
        return 6;
      case 7:
        return 5;
      default:
        throw InputError(path_ + ": the mesh has elements of Gmsh's type " + std::to_string(type) +
                         "; save it with element order 1");
    }
  }

  const std::string& path_;
  std::string_view content_;
  std::size_t at_ = 0;
  std::uint64_t n_elements_ = 0;
  std::unordered_set<std::uint64_t> nodes_;
};

}  // namespace

std::uint64_t check_binary_msh(const std::filesystem::path& path, std::string_view content,
                               bool version_4) {
  const std::string name = path.string();
  return BinaryMshScanner(name, content).scan(version_4);
}

}  // namespace smoothfem
