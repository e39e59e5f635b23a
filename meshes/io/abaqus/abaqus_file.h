// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// Reads the mesh of an Abaqus input file (also CalculiX's): *NODE, *ELEMENT with TYPE and ELSET,
/// *ELSET (also GENERATE); keywords in any case, comments (**), lines that continue after a comma.
/// Nodes and cells come in the order of their labels. C3D4, C3D5, C3D6, C3D8 make a volume mesh
/// (their variants, C3D8R, DC3D8, ..., too), without them CPS3, CPS4, S3, S4 and the like a planar
/// one; elements of one dimension less in a set are labelled facets. An element belongs to the set
/// that *ELEMENT names, otherwise to the first *ELSET with it. Sets become physical names with tags
/// 1, 2, ... by appearance, unless a comment "** physical_name dimension tag name" says which; a
/// set PHYSICAL_n stands for tag n without a name. Nodes of the set SMOOTHFEM_FIXED are fixed,
/// without it the boundary. Other keywords are skipped. Refused: several parts, instances that are
/// moved, nodes and elements that Abaqus would generate or include, elements with mid-nodes.
MeshFile read_abaqus(const std::filesystem::path& path);

/// Refused: polygons with five and more nodes. Facets are written as S3, S4 or T2D2 elements with
/// labels behind those of the cells.
void write_abaqus(const std::filesystem::path& path, const MeshView& mesh, const MeshFields& fields,
                  const MeshWriteOptions& options);

/// What an element type of Abaqus is here.
struct AbaqusElement {
  int dimension;
  std::size_t n_nodes;
};
/// type: in capitals. Nothing for a type that is not known or has nodes besides its corners.
std::optional<AbaqusElement> abaqus_element(std::string_view type);

/// Names that reader and writer share.
inline constexpr std::string_view abaqus_fixed_set = "SMOOTHFEM_FIXED",
                                  abaqus_tag_set = "PHYSICAL_",
                                  abaqus_name_comment = "** physical_name ";
/// The format has no end of its own: a file that begins with the first comment is complete only if
/// it ends with the last one.
inline constexpr std::string_view abaqus_first_comment = "** smoothfem mesh",
                                  abaqus_last_comment = "** end of smoothfem mesh";

}  // namespace smoothfem
