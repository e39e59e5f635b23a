// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>

#include "meshes/domains/catalogue.h"
#include "studies/framework/definition/seeds.h"
#include "studies/framework/definition/study_file.h"
#include "studies/framework/definition/study_keys.h"
#include "studies/kinds/collection/definition/collection.h"
#include "studies/kinds/collection/definition/collection_keys.h"
#include "studies/kinds/collection/definition/expand_members.h"

namespace smoothfem {

namespace {

using dealii::ParameterHandler;

/// Reads the settings that members of one dimension share. The collection's file is read as a study
/// of one mesh that is never made. A solution defined in the collection replaces the named one.
Study read_common(const StudyText& text, const std::string& scale, int dimension,
                  bool has_own_solutions) {
  Study study = study_of_text(
      text.with_text(text.text() + "set kind = smoothing\nset dimension = " +
                     std::to_string(dimension) + "\nset meshes = member\n" +
                     (has_own_solutions ? "subsection solution\nset name = sine\nend\n" : "")),
      scale);
  if (study.in_parts)
    throw InputError(text.file().string() +
                     ": the meshes of a collection are whole; leave out 'set in parts = true', or "
                     "write a study of one mesh in parts");
  study.meshes.clear();
  for (auto* parameters : {&study.header.parameters, &study.header.file_parameters})
    std::erase_if(*parameters, [&](const auto& entry) {
      return entry.first.starts_with("mesh ") || entry.first == "meshes" ||
             entry.first == "dimension";
    });
  return study;
}

/// Reads the shared settings for each dimension that can occur. Files may have any dimension,
/// generated meshes have their domain's.
void read_common(Collection& collection, const StudyText& text, const std::string& scale) {
  std::set<int> needed;
  bool any_dimension = false;
  for (const auto& member : collection.members)
    if (member.mesh.domain.empty())
      any_dimension = true;
    else
      needed.insert(find_domain(member.mesh.domain).dimension);
  for (const int dimension : {2, 3}) try {
      if (any_dimension || needed.contains(dimension))
        collection.common.emplace(
            dimension, read_common(text, scale, dimension, !collection.solutions.empty()));
    } catch (const InputError& error) {
      if (needed.contains(dimension)) throw;
      collection.refusals[dimension] = error.what();
    }
  if (collection.common.empty()) throw InputError(collection.refusals.begin()->second);
}

/// Returns the collection's own parameters, followed by further ones of its members.
StudyParameters joined_parameters(const StudyParameters& own, const StudyParameters& common) {
  StudyParameters all = own;
  for (const auto& entry : common)
    if (std::none_of(own.begin(), own.end(),
                     [&](const auto& known) { return known.first == entry.first; }))
      all.push_back(entry);
  return all;
}

}  // namespace

Collection read_collection(const std::filesystem::path& file, const std::string& scale) {
  const StudyText text(file);
  ParameterHandler lists;  // the lists determine which subsections exist
  declare_collection(lists);
  parse_study(lists, text, true);
  const auto scales = known_scales(lists, scale, file.string());
  if (!lists.get("meshes").empty())
    throw InputError(
        file.string() +
        ": a collection has no list 'meshes'; name files by 'collection' and domains by 'domains'");
  ParameterHandler p;
  declare_collection(p);
  std::vector<std::string> solutions = split_list(lists.get("solutions"));
  for (const auto& name : scales) {
    declare_collection_scale(lists, name);
    declare_collection_scale(p, name);
  }
  parse_study(lists, text, true);
  for (const auto& name : scales) {
    const Subsection subsection(lists, "scale " + name);
    for (const auto& more : split_list(lists.get("solutions")))
      if (std::find(solutions.begin(), solutions.end(), more) == solutions.end())
        solutions.push_back(more);
  }
  for (const auto& name : solutions) {
    check_label(name, "solution", file.string());
    declare_collection_solution(p, name);
  }
  declare_group_diffusivities(p, text);
  parse_study(p, text, true);
  const StudyParameters said = all_parameters(p);
  apply_scale(p, scale, file.string(), {}, collection_lists);

  Collection collection;
  KeyLines lines = scale.empty() ? KeyLines{} : lines_of_section(text, "scale " + scale);
  lines.merge(lines_of_section(text, ""));
  try {
    for (const auto& name : split_list(p.get("solutions")))
      collection.solutions.emplace(name, read_solution(p, text, name));
    collection.published = split_list(p.get("published"));
    collection.members = expand_members(p, std::filesystem::absolute(file).parent_path());
    collection.notes = unused_keys(collection.members, read_seeds(p.get("seeds")).size());
  } catch (const InputError& error) {
    const std::string message = with_line(lines, error.what());
    throw InputError(message == error.what() ? file.string() + ": " + message : message);
  }
  read_common(collection, without_collection_keys(text, solutions), scale);
  for (auto& [dimension, study] : collection.common)
    study.write_meshes = p.get_bool("write meshes");
  collection.header = collection.common.begin()->second.header;
  collection.header.parameters = joined_parameters(all_parameters(p), collection.header.parameters);
  collection.header.file_parameters = joined_parameters(said, collection.header.file_parameters);
  // Results do not depend on it, and it may be raised for members that have failed.
  std::erase_if(collection.header.file_parameters,
                [](const auto& entry) { return entry.first == "time limit"; });
  collection.time_limit = p.get_double("time limit");
  return collection;
}

std::string collection_template() {
  ParameterHandler p;
  declare_collection(p);
  declare_collection_scale(p, "NAME");
  declare_collection_solution(p, "NAME");
  return "# In addition: all keys of the kind smoothing except 'meshes', 'dimension' and "
         "'surface'.\n" +
         commented_keys(p);
}

}  // namespace smoothfem
