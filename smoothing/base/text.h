// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <charconv>
#include <filesystem>
#include <string>
#include <vector>

namespace smoothfem {

/// Appends a number with the fewest digits (at most 17) that read back as the same value, bit for
/// bit.
template <class Number>
void append_number(std::string& text, Number value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

template <class Number>
std::string number_text(Number value) {
  std::string text;
  append_number(text, value);
  return text;
}

/// Returns the items of a comma-separated list, without surrounding spaces and without empty items.
std::vector<std::string> split_list(const std::string& text);

/// Returns the text for a message: at most about 60 bytes, followed by "..." if there are more.
std::string shortened(const std::string& text);

/// Returns the words of the text with one space between them, for a message; at most 400 bytes.
std::string in_one_line(const std::string& text);

/// Returns the text with U+FFFD in place of each byte that is not UTF-8. Names of files may have
/// such bytes.
std::string as_utf8(const std::string& text);

/// Returns the content of a file, byte by byte; empty if it cannot be read.
std::string file_content(const std::filesystem::path& path);

}  // namespace smoothfem
