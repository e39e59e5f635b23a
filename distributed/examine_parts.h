// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "distributed/scattered_mesh.h"
#include "meshes/doctor/examine.h"

namespace smoothfem {

/// Examines a mesh of which no rank holds all, as it was read for an examination: the same findings
/// as examine() of the whole mesh. Each rank examines its cells, and ranks exchange what they have
/// in common. The root gets the cells around the boundary, in which it looks for hanging and
/// coincident nodes and for pieces that touch. If these are more than 5e7 cells, it does not, and
/// the result says so.
///
/// The result is complete on the root. Other ranks have as many findings, but they are empty.
/// Collective. Throws InputError on all ranks as examine() does, and if two cells have one number.
template <int dim>
Examination examine_parts(const Ranks& ranks, ScatteredMesh<dim> mesh);

/// Throws InputError "path: ...; purpose needs a mesh that conforms" on all ranks if the mesh has
/// faults of these kinds. Returns sentences about what was not looked for, on all ranks.
/// Collective.
template <int dim>
std::vector<std::string> require_conforming_parts(const Ranks& ranks,
                                                  const std::filesystem::path& path,
                                                  ScatteredMesh<dim> mesh,
                                                  std::initializer_list<FindingKind> faults,
                                                  const std::string& purpose);

}  // namespace smoothfem
