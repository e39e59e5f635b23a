// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace smoothfem {

/// Returns a text as the value of an attribute. Throws InputError for control characters, which XML
/// cannot hold.
std::string escaped_for_xml(const std::string& text);

/// A tag `<name a="1" b="2">`, `</name>` or `<name/>` of the text.
struct XmlTag {
  std::string_view name;
  std::vector<std::pair<std::string_view, std::string_view>> attributes;
  bool begins = false, ends = false;     ///< an element; one tag may do both
  std::size_t first = 0, past_last = 0;  ///< its characters

  std::optional<std::string_view> attribute(std::string_view attribute_name) const;
};

/// Iterates over the tags of an XML file; the caller reads the text between them. The text must
/// outlive it. Throws InputError "path:line: ..." for tags that are not closed or do not match.
class XmlTags {
 public:
  XmlTags(std::string path, std::string_view text) : path_(std::move(path)), text_(text) {}

  /// Goes to the next tag, past comments and declarations; false at the end of the text, where no
  /// element may be open.
  bool next();
  const XmlTag& tag() const { return tag_; }
  /// Returns the element around the present one; empty if there is no such element.
  std::string_view parent() const;
  /// Continues at this position; the skipped text has no tags.
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
