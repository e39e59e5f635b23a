// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <vector>

#include "smoothing/base/text.h"

namespace smoothfem {

/// Returns the fields of a line of CsvText. The fields must not contain line breaks.
inline std::vector<std::string> csv_fields(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      fields.back() += line[i++];
    else if (line[i] == '"')
      quoted = !quoted;
    else if (line[i] == ',' && !quoted)
      fields.emplace_back();
    else
      fields.back() += line[i];
  }
  return fields;
}

/// Lines of comma-separated fields in UTF-8; other bytes become U+FFFD. Numbers have the shortest
/// form that reads back as the same number.
class CsvText {
 public:
  explicit CsvText(const std::string& header) : text_(header + "\n") {}

  CsvText& field(const std::string& value) {
    const auto is_ascii = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
    return std::all_of(value.begin(), value.end(), is_ascii) ? utf8_field(value)
                                                             : utf8_field(as_utf8(value));
  }
  CsvText& number(double value) {
    char buffer[32];
    return field({buffer, std::to_chars(buffer, buffer + sizeof(buffer), value).ptr});
  }
  CsvText& number(std::optional<double> value) { return value ? number(*value) : field(""); }
  CsvText& integer(std::size_t value) { return field(std::to_string(value)); }
  void end_line() {
    text_ += '\n';
    first_ = true;
  }
  std::string text() const { return text_; }

 private:
  CsvText& utf8_field(const std::string& value) {
    if (!first_) text_ += ',';
    first_ = false;
    if (value.find_first_of(",\"\n") == std::string::npos) {
      text_ += value;
      return *this;
    }
    text_ += '"';
    for (const char c : value) text_ += c == '"' ? std::string("\"\"") : std::string(1, c);
    text_ += '"';
    return *this;
  }

  std::string text_;
  bool first_ = true;
};

}  // namespace smoothfem
