// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "smoothing/mesh/mesh_labels.h"

namespace smoothfem {

/// Numbers at all vertices, or at all elements of a section of the mesh.
struct MeditSolutionSection {
  std::string of;  ///< "Vertices", "Triangles", ...
  std::size_t n_rows = 0;
  std::vector<MeshField> fields;  ///< with 1, 2, 3 or 6 components
};

struct MeditSolution {
  int dimension = 3;
  std::vector<MeditSolutionSection> sections;
};

/// Name of the solution's fields of a mesh; the second one ends with "_2".
inline constexpr std::string_view medit_solution_field = "medit:solution";
std::string medit_solution_name(std::size_t i);

/// True for a field that a solution can hold.
bool is_medit_solution(const MeshField& field);

/// Returns the name of the file with the solution of a mesh file: "part.sol" for "part.mesh".
std::filesystem::path medit_solution_path(const std::filesystem::path& mesh);

/// Reads a solution in Medit's text format (.sol). Throws InputError.
MeditSolution read_medit_solution(const std::filesystem::path& path);
/// Writes it; the file appears complete or not at all.
void write_medit_solution(const std::filesystem::path& path, const MeditSolution& solution);

}  // namespace smoothfem
