// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "studies/framework/definition/study.h"

namespace smoothfem {

/// The numbers of a list such as "1, 2, 3". Throws InputError for what is no whole number from 0
/// on, and for one that is there twice.
std::vector<std::uint64_t> read_seeds(const std::string& list);

/// A study's meshes, those that depend on chance (distorted ones, domains that are random) once for
/// each seed: with the first one under their own name, with the others behind it under NAME.seed-2
/// and so on. All as they are if there are no seeds. Throws InputError if such a name is taken.
std::vector<StudyMesh> for_each_seed(const std::vector<StudyMesh>& meshes,
                                     const std::vector<std::uint64_t>& seeds);

/// For studies of published meshes, which no seed changes.
std::vector<StudyMesh> without_published_repetitions(std::vector<StudyMesh> meshes);

}  // namespace smoothfem
