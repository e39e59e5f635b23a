// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/abaqus/abaqus_sources.h"

#include <algorithm>

#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace fs = std::filesystem;

namespace {

/// Files that include one file many times could fill the memory.
constexpr std::size_t max_included = 1000;

fs::path without_links(const fs::path& path) {
  std::error_code error;
  auto result = fs::weakly_canonical(path, error);
  return error ? path : result;
}

bool is_below(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

}  // namespace

AbaqusSources::AbaqusSources(const fs::path& path, std::string_view content)
    : folder_(path.parent_path()) {
  sources_.push_back(std::make_unique<Source>(path, content));
  sources_.back()->path = without_links(path);
}

bool AbaqusSources::next_line() {
  while (!reader().next_line()) {
    if (sources_.size() == 1) return false;
    copy_up_to(*sources_.back(), sources_.back()->content.size());
    if (!text_.ends_with('\n')) text_ += '\n';
    sources_.pop_back();
  }
  return true;
}

void AbaqusSources::mark_keyword() {
  Source& source = *sources_.back();
  source.keyword = static_cast<std::size_t>(reader().text().data() - source.content.data());
}

void AbaqusSources::copy_up_to(Source& source, std::size_t end) {
  text_ += source.content.substr(source.n_copied, end - source.n_copied);
  source.n_copied = end;
}

fs::path AbaqusSources::allowed_path(const std::string& name) const {
  if (name.empty()) reader().fail("the keyword names no file to include; give it by INPUT=");
  const fs::path path = folder_ / name, real = without_links(path);
  const std::string file = "the included file " + in_quotes(name);
  if (!is_below(real, without_links(folder_.empty() ? "." : folder_)))
    reader().fail(file + " is not in the folder of the mesh file, and is not read; copy it there");
  if (!fs::is_regular_file(real))
    reader().fail(file +
                  " does not exist, or is not a file; it is looked for in the folder of "
                  "the mesh file");
  if (std::any_of(sources_.begin(), sources_.end(),
                  [&](const auto& source) { return source->path == real; }))
    reader().fail(file + " includes itself; remove one of the lines");
  return path;
}

void AbaqusSources::include(const std::string& name, std::string_view replacement) {
  const fs::path path = allowed_path(name);
  if (++n_included_ > max_included)
    reader().fail("the file includes more than " + std::to_string(max_included) +
                  " files; put their text into fewer files");
  Source& source = *sources_.back();
  copy_up_to(source, source.keyword);
  text_ += replacement;
  source.n_copied = source.content.size() - source.reader.rest().size();
  std::string content;
  if (fs::file_size(path) > 0) content = read_whole_file(path);
  sources_.push_back(std::make_unique<Source>(path, std::move(content)));
  sources_.back()->path = without_links(path);
}

std::string AbaqusSources::whole_text() && {
  copy_up_to(*sources_.front(), sources_.front()->content.size());
  return std::move(text_);
}

}  // namespace smoothfem
