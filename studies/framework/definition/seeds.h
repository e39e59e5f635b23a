// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "studies/framework/definition/study.h"

namespace smoothfem {

/// Returns the numbers of a list such as "1, 2, 3". Throws InputError if an entry is not a whole
/// number of at least 0, or occurs twice.
std::vector<std::uint64_t> read_seeds(const std::string& list);

/// Returns a study's meshes, with one copy per seed of each mesh that depends on chance: distorted
/// meshes and random domains.
/// The first seed keeps the mesh's name; the others follow it as NAME.seed-2 and so on. Without
/// seeds, all meshes are unchanged. Throws InputError if such a name is taken.
std::vector<StudyMesh> for_each_seed(const std::vector<StudyMesh>& meshes,
                                     const std::vector<std::uint64_t>& seeds);

/// Removes the copies for further seeds of published meshes, which no seed changes.
std::vector<StudyMesh> without_published_repetitions(std::vector<StudyMesh> meshes);

}  // namespace smoothfem
