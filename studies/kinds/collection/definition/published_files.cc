// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/base/find_named.h"
#include "studies/kinds/collection/definition/collection.h"

namespace smoothfem {

Collection with_published_files(Collection collection, const std::filesystem::path& mesh_dir) {
  const std::string& study = collection.header.name;
  if (!collection.published.empty() && mesh_dir.empty()) {
    const bool has_choice = collection.header.built_in && collection.published.size() > 1;
    throw InputError("the study " + study + " needs published meshes; add --published" +
                     (has_choice ? " NAME, where NAME is " + joined(collection.published) +
                                       " (without NAME: all of them)"
                                 : "") +
                     ", which fetches them once");
  }
  for (auto& member : collection.members) {
    if (member.mesh.published_file.empty()) continue;
    member.mesh.file = mesh_dir / member.mesh.published_file;
    if (!std::filesystem::exists(member.mesh.file))
      throw InputError("the folder of published meshes has no file " + member.mesh.file.string() +
                       "; 'smoothfem study " + study + " --published' fetches it");
  }
  return collection;
}

}  // namespace smoothfem
