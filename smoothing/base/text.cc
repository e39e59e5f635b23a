// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/base/text.h"

#include <boost/locale/utf.hpp>
#include <fstream>
#include <sstream>

namespace smoothfem {

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> items;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');) {
    const auto first = item.find_first_not_of(" \t");
    if (first == std::string::npos) continue;
    items.push_back(item.substr(first, item.find_last_not_of(" \t") - first + 1));
  }
  return items;
}

std::string shortened(const std::string& text) {
  std::size_t length = 60;
  if (text.size() <= length) return text;
  const auto continues = [&] { return (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80; };
  while (length > 0 && continues()) --length;  // no half character
  return text.substr(0, length) + "...";
}

std::string in_one_line(const std::string& text) {
  constexpr std::size_t longest = 400;
  std::istringstream words(text);
  std::string line;
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  return line.size() > longest ? line.substr(0, longest) + "..." : line;
}

std::string as_utf8(const std::string& text) {
  namespace utf = boost::locale::utf;
  std::string result;
  for (auto at = text.begin(); at != text.end();) {
    const auto begin = at;
    if (utf::is_valid_codepoint(utf::utf_traits<char>::decode(at, text.end()))) {
      result.append(begin, at);
    } else {
      result += "\xEF\xBF\xBD";
      at = begin + 1;
    }
  }
  return result;
}

std::string file_content(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace smoothfem
