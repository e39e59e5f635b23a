// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/results/method_files.h"

#include "studies/framework/results/sha256.h"

namespace smoothfem {

namespace {

template <int dim, int spacedim>
void note_files_of(StudyMethod& entry, const std::filesystem::path& folder) {
  auto method = entry.make<dim, spacedim>();
  use_folders(method, {folder, {}});
  std::vector<std::filesystem::path> files;
  if (!method.info.library.empty()) files.push_back(method.info.library);
  for (auto& stage : method.stages) try {
      const SmootherOrigin origin = stage->origin();
      files.insert(files.end(), origin.files.begin(), origin.files.end());
      if (!origin.version.empty()) entry.version = origin.version;
    } catch (const SmootherFailure&) {
    }
  for (const auto& file : files)
    entry.files.push_back({file.filename().string(), sha256_of_file(file)});
}

template <int dim>
void note_files_of(StudySolver& entry) {
  const SmootherOrigin origin = entry.make<dim>()->origin();
  entry.version = origin.version;
  auto files = origin.files;
  if (const auto library = library_of_solver(entry.type); !library.empty())
    files.push_back(library);
  for (const auto& file : files)
    entry.files.push_back({file.filename().string(), sha256_of_file(file)});
}

}  // namespace

void note_files(Study& study) {
  with_dimensions(study.dimensions, [&]<int dim, int spacedim>() {
    for (auto& method : study.methods) note_files_of<dim, spacedim>(method, study.folder);
    if constexpr (dim == spacedim)
      for (auto& solver : study.solvers) note_files_of<dim>(solver);
  });
}

}  // namespace smoothfem
