// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/xml_tags.h"

#include <algorithm>

#include "meshes/io/line_reader.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/text.h"

namespace smoothfem {

std::string escaped_for_xml(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < ' ')
      throw InputError("the name '" + shortened(text) +
                       "' has a control character, which XML cannot hold; rename it");
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

namespace {

constexpr std::string_view blanks = " \t\r\n";

}  // namespace

std::optional<std::string_view> XmlTag::attribute(std::string_view attribute_name) const {
  for (const auto& [name, value] : attributes)
    if (name == attribute_name) return value;
  return {};
}

std::string_view XmlTags::parent() const {
  const std::size_t own = tag_.begins && !tag_.ends ? 1 : 0;
  return open_.size() > own ? open_[open_.size() - own - 1] : std::string_view();
}

void XmlTags::fail_at(std::size_t position, const std::string& message) const {
  const auto line =
      1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(position), '\n');
  throw InputError(path_ + ":" + std::to_string(line) + ": " + message);
}

bool XmlTags::skip(std::string_view begin, std::string_view end) {
  if (!text_.substr(at_).starts_with(begin)) return false;
  const std::size_t found = text_.find(end, at_ + begin.size());
  if (found == text_.npos)
    fail_at(at_, in_quotes(begin) + " has no end; the file is truncated or damaged");
  at_ = found + end.size();
  return true;
}

void XmlTags::skip_blanks() {
  at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size());
}

std::string_view XmlTags::name() {
  const std::size_t end = std::min(text_.find_first_of(" \t\r\n=/><\"'", at_), text_.size());
  const std::string_view found = text_.substr(at_, end - at_);
  if (found.empty()) fail_at(at_, "a tag is damaged: a name is missing");
  at_ = end;
  return found;
}

void XmlTags::read_attribute() {
  const std::string_view attribute = name();
  skip_blanks();
  if (!skip("=", "")) fail_at(at_, "the attribute " + in_quotes(attribute) + " has no value");
  skip_blanks();
  const char quote = at_ < text_.size() ? text_[at_] : '\0';
  const std::size_t end =
      quote == '"' || quote == '\'' ? text_.find(quote, at_ + 1) : std::string_view::npos;
  if (end == text_.npos)
    fail_at(at_, "the value of the attribute " + in_quotes(attribute) + " is not in quotes");
  tag_.attributes.emplace_back(attribute, text_.substr(at_ + 1, end - at_ - 1));
  at_ = end + 1;
}

bool XmlTags::next() {
  do {
    at_ = std::min(text_.find('<', at_), text_.size());
  } while (skip("<!--", "-->") || skip("<?", "?>") || skip("<!", ">"));
  if (at_ == text_.size()) {
    if (!open_.empty())
      fail_at(at_, "the file ends inside the element " + in_quotes(open_.back()) +
                       "; it is truncated or damaged");
    return false;
  }
  tag_ = {.name = {}, .attributes = {}, .first = at_};
  ++at_;
  tag_.ends = skip("/", "");
  tag_.begins = !tag_.ends;
  tag_.name = name();
  for (skip_blanks(); tag_.begins && !tag_.ends && !skip(">", ""); skip_blanks()) {
    if (skip("/", ""))
      tag_.ends = true;
    else
      read_attribute();
  }
  if (tag_.ends && !skip(">", ""))
    fail_at(at_, "a tag has no end; the file is truncated or damaged");
  tag_.past_last = at_;
  if (tag_.begins && open_.empty() && n_roots_++ > 0)
    fail("the file has a second root element; it is damaged");
  if (tag_.begins && !tag_.ends) open_.push_back(tag_.name);
  if (tag_.ends && !tag_.begins) {
    if (open_.empty() || open_.back() != tag_.name)
      fail("</" + std::string(tag_.name.substr(0, 40)) + "> ends no element; the file is damaged");
    open_.pop_back();
  }
  return true;
}

}  // namespace smoothfem
