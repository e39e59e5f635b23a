// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/abaqus/abaqus_sources.h"

#include <algorithm>

#include "meshes/io/nearby_file.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace fs = std::filesystem;

namespace {

/// Files that include one file many times could fill the memory.
constexpr std::size_t max_included = 1000;

}  // namespace

AbaqusSources::AbaqusSources(const fs::path& path, std::string_view content) : main_(path) {
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
  fs::path path;
  try {
    path = nearby_file(main_, name, "the included file");
  } catch (const InputError& error) {
    reader().fail(error.what());
  }
  const fs::path real = without_links(path);
  if (std::any_of(sources_.begin(), sources_.end(),
                  [&](const auto& source) { return source->path == real; }))
    reader().fail("the included file " + in_quotes(name) +
                  " includes itself; remove one of the lines");
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
