// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/cli/watched_files.h"

#include <set>
#include <sstream>

#include "smoothing/loop/method_scheme.h"

namespace smoothfem {

namespace fs = std::filesystem;

namespace {

/// Returns the words between blanks and commas.
std::vector<std::string> words_of(std::string value) {
  for (char& c : value)
    if (c == ',') c = ' ';
  std::istringstream stream(value);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// Returns the path in a method's name such as python:FILE:CLASS; otherwise the word.
std::string path_in(const std::string& word) {
  try {
    if (const auto method = method_in_file(word)) return method->file.string();
  } catch (const InputError&) {  // the file is missing yet
  }
  return word;
}

}  // namespace

std::vector<fs::path> files_of(const StudyText& text) {
  std::vector<fs::path> files{text.file()};
  for (const auto& file : text.included()) files.push_back(file);
  return files;
}

std::vector<fs::path> named_files(const StudyParameters& parameters, const fs::path& folder) {
  std::set<fs::path> files;
  std::error_code ignored;  // a word that is no path
  for (const auto& [key, value] : parameters)
    for (const auto& word : words_of(value)) {
      const fs::path path = folder / path_in(word);
      if (word.find_first_of("*?") != std::string::npos) {
        if (fs::is_directory(path.parent_path(), ignored)) files.insert(path.parent_path());
      } else if (fs::is_regular_file(path, ignored)) {
        files.insert(path.lexically_normal());
        if (path.extension() != ".py") continue;
        for (const auto& entry :
             fs::directory_iterator(path.parent_path().empty() ? "." : path.parent_path()))
          if (entry.path().extension() == ".py") files.insert(entry.path().lexically_normal());
      }
    }
  return {files.begin(), files.end()};
}

}  // namespace smoothfem
