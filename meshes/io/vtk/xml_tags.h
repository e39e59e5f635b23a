// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace smoothfem {

/// `<name a="1" b="2">`, `</name>` or `<name/>`, as they stand in the text.
struct XmlTag {
  std::string_view name;
  std::vector<std::pair<std::string_view, std::string_view>> attributes;
  bool begins = false, ends = false;     ///< an element; one may do both
  std::size_t first = 0, past_last = 0;  ///< its characters

  std::optional<std::string_view> attribute(std::string_view attribute_name) const;
};

/// Walks through the tags of an XML file; what stands between them is left to the caller. The text
/// must outlive it. Throws InputError "path:line: ..." for tags that are not closed or do not
/// belong together.
class XmlTags {
 public:
  XmlTags(std::string path, std::string_view text) : path_(std::move(path)), text_(text) {}

  /// Goes to the next tag, past comments and declarations; false at the end of the text, where no
  /// element may be open.
  bool next();
  const XmlTag& tag() const { return tag_; }
  /// The element around the present one; empty if there is none.
  std::string_view parent() const;
  /// The text goes on here; what stands before has no tags.
  void go_to(std::size_t position) { at_ = position; }

  /// Throws InputError; position: in the text.
  [[noreturn]] void fail_at(std::size_t position, const std::string& message) const;
  [[noreturn]] void fail(const std::string& message) const { fail_at(tag_.first, message); }

 private:
  bool skip(std::string_view begin, std::string_view end);
  void skip_blanks();
  std::string_view name();
  void read_attribute();

  std::string path_;
  std::string_view text_;
  std::size_t at_ = 0;
  XmlTag tag_;
  std::vector<std::string_view> open_;
  std::size_t n_roots_ = 0;
};

}  // namespace smoothfem
