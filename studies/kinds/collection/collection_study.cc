// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "studies/kinds/collection/run_collection.h"
#include "studies/kinds/study_kinds.h"

namespace smoothfem {

namespace {

ReadyStudy read(const std::filesystem::path& file, const std::string& scale) {
  auto collection = std::make_shared<const Collection>(read_collection(file, scale));
  return {.header = collection->header,
          .has_shards = true,
          .published = collection->published,
          .run = [collection](const StudyOptions& options) {
            // A dry run needs no files.
            const bool has_files = !options.dry_run || !options.mesh_dir.empty();
            run_collection(
                has_files ? with_published_files(*collection, options.mesh_dir) : *collection,
                options);
          }};
}

const RegisteredStudyKind collection_kind({"collection", read, collection_template});

}  // namespace

}  // namespace smoothfem
