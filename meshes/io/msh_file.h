#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <unordered_map>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// Reads a Gmsh file, version 2.2 or 4.1, text or binary, through the Gmsh library. Nodes and cells
/// come in the order of their tags; nodes that no element uses are dropped. Physical groups of
/// cells and facets are kept with their names (of several groups of one entity the first), node and
/// element tags too; points and facets without a group are ignored, parametric coordinates and
/// other sections too. Refused: files that are not complete, other versions, surfaces that are not
/// planar, elements with mid-nodes.
MeshFile read_msh(const std::filesystem::path& path);

/// Version and encoding follow the options. Refused: polygons with five and more nodes; in version
/// 2.2 also meshes where only some cells have a tag, which it cannot tell from meshes without tags.
void write_msh(const std::filesystem::path& path, const MeshView& mesh, const MeshFields& fields,
               const MeshWriteOptions& options);

/// What a .msh file says about itself. Gmsh accepts several kinds of damaged files silently.
struct MshStructure {
  bool binary = false;
  std::uint64_t n_elements = 0;  ///< as announced
  std::unordered_map<std::uint64_t, std::size_t>
      element_lines;  ///< by element tag; text files only
};

/// Checks the sections of a .msh file: version, each section closed, and in text files as many
/// nodes and elements as announced, all numbers finite. Throws InputError "path:line: what is
/// wrong".
MshStructure check_msh_structure(const std::filesystem::path& path, std::string_view content);

/// The part of check_msh_structure for binary files; returns the number of elements.
std::uint64_t check_binary_msh(const std::filesystem::path& path, std::string_view content,
                               bool version_4);

}  // namespace smoothfem
