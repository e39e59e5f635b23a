// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/definition/seeds.h"

#include <algorithm>
#include <charconv>

#include "meshes/domains/catalogue.h"
#include "studies/framework/definition/study_file.h"

namespace smoothfem {

namespace {

bool depends_on_chance(const StudyMesh& mesh) {
  if (is_distorted(mesh)) return true;
  return mesh.file.empty() && !mesh.domain.empty() &&
         find_domain(mesh.domain).is_random(mesh.elements);
}

}  // namespace

std::vector<std::uint64_t> read_seeds(const std::string& list) {
  std::vector<std::uint64_t> seeds;
  for (const auto& item : split_list(list)) {
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), seed);
    if (error != std::errc() || end != item.data() + item.size())
      throw InputError(
          "'seeds' has '" + item +
          "', which is not a seed; write whole numbers of at least 0, for example 1, 2, 3");
    if (std::find(seeds.begin(), seeds.end(), seed) != seeds.end())
      throw InputError("'seeds' has " + item + " twice; leave out one of them");
    seeds.push_back(seed);
  }
  return seeds;
}

std::vector<StudyMesh> for_each_seed(const std::vector<StudyMesh>& meshes,
                                     const std::vector<std::uint64_t>& seeds) {
  if (seeds.empty()) return meshes;
  std::vector<StudyMesh> all;
  for (const StudyMesh& mesh : meshes) {
    all.push_back(mesh);
    if (!depends_on_chance(mesh)) continue;
    all.back().seed = seeds.front();
    for (std::size_t i = 1; i < seeds.size(); ++i) {
      StudyMesh repetition = mesh;
      repetition.name += ".seed-" + std::to_string(seeds[i]);
      if (std::any_of(meshes.begin(), meshes.end(),
                      [&](const StudyMesh& other) { return other.name == repetition.name; }))
        throw InputError("the mesh " + mesh.name + " with the seed " + std::to_string(seeds[i]) +
                         " is called " + repetition.name +
                         ", which is another mesh; give that one another name");
      repetition.title += ", seed " + std::to_string(seeds[i]);
      repetition.seed = seeds[i];
      repetition.repeats = mesh.name;
      all.push_back(std::move(repetition));
    }
  }
  return all;
}

std::vector<StudyMesh> without_published_repetitions(std::vector<StudyMesh> meshes) {
  std::erase_if(meshes, [](const StudyMesh& mesh) {
    return !mesh.repeats.empty() && !mesh.published_file.empty();
  });
  return meshes;
}

}  // namespace smoothfem
