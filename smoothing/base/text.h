// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <charconv>
#include <filesystem>
#include <string>
#include <vector>

namespace smoothfem {

/// Appends a number with as many digits (at most 17) as give back the same bits when read.
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

/// The items of a list that are separated by commas, without spaces around them; empty ones are
/// left out.
std::vector<std::string> split_list(const std::string& text);

/// What is in a file, byte by byte; empty if it cannot be read.
std::string file_content(const std::filesystem::path& path);

}  // namespace smoothfem
