// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "studies/kinds/collection/run_collection.h"
#include "studies/kinds/study_kinds.h"

namespace smoothfem {

namespace {

ReadyStudy read(const std::filesystem::path& file, const std::string& scale) {
  auto collection = std::make_shared<const Collection>(read_collection(file, scale));
  return {
      .header = collection->header,
      .has_shards = true,
      .run = [collection](const StudyOptions& options) { run_collection(*collection, options); }};
}

const RegisteredStudyKind collection_kind({"collection", read, collection_template});

}  // namespace

}  // namespace smoothfem
