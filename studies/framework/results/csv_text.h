// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <charconv>
#include <optional>
#include <string>

namespace smoothfem {

/// Lines of comma-separated fields; numbers in the shortest form that reads back the same.
class CsvText {
 public:
  explicit CsvText(const std::string& header) : text_(header + "\n") {}

  CsvText& field(const std::string& value) {
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
  std::string text_;
  bool first_ = true;
};

}  // namespace smoothfem
