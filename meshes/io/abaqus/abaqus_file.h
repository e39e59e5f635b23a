// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "meshes/io/mesh_file.h"
#include "meshes/io/node_order.h"

namespace smoothfem {

/// Reads the mesh of an Abaqus input file, also of CalculiX. Keywords: *NODE, *ELEMENT with TYPE
/// and ELSET, *ELSET (also GENERATE), in upper or lower case; comments (**); lines that continue
/// after a comma. Other keywords are skipped. Nodes and cells come in the order of their labels.
///
/// C3D4, C3D5, C3D6, C3D8 and their variants (C3D8R, DC3D8, ...) make a volume mesh. Without them
/// CPS3, CPS4, S3, S4 and similar types make a planar mesh. Elements of one dimension less in a set
/// are labelled facets. The tag of an element is that of the set that *ELEMENT names, otherwise of
/// the first *ELSET with it; it belongs to the groups of all its sets. Sets become physical names
/// with tags 1, 2, ... in the order of appearance. A comment "** physical_name dimension tag name"
/// sets the tag; a set PHYSICAL_n means tag n without a name. Nodes of the set SMOOTHFEM_FIXED are
/// fixed; without it the boundary is fixed. Included files (*INCLUDE, INPUT=) are read if they are
/// in the folder of the file or below.
///
/// Elements of second order (C3D10, C3D13, C3D15, C3D20, CPS6, CPS8, S6, S8, T2D3, B32 and
/// variants) are read, too.
///
/// Throws InputError for nodes and elements that Abaqus would generate.
MeshParts read_abaqus(const std::filesystem::path& path, const MeshReadOptions& = {});

/// Writes an Abaqus input file. A mesh that was read from one gets its text, with that of included
/// files in place, so that the file is complete in whatever folder. Throws InputError for polygons
/// with five or more nodes. Facets of other meshes are written as S3, S4 or T2D2 elements with
/// labels after those of the cells.
void write_abaqus(const std::filesystem::path& path, const MeshView& mesh, const MeshFields& fields,
                  const MeshWriteOptions& options);

/// An element type of Abaqus. Types of second order list the corners first and then the nodes of
/// the edges, as VTK does; lines list their middle node between the ends.
struct AbaqusElement {
  int dimension;
  std::size_t n_corners;
  const NodeOrder* order = nullptr;  ///< null: linear elements

  std::size_t n_nodes() const { return order ? order->size : n_corners; }
};
/// Returns the element of a type in capitals; nothing for unknown types.
std::optional<AbaqusElement> abaqus_element(std::string_view type);

/// Names that reader and writer share.
inline constexpr std::string_view abaqus_fixed_set = "SMOOTHFEM_FIXED",
                                  abaqus_tag_set = "PHYSICAL_",
                                  abaqus_name_comment = "** physical_name ";
/// The format has no end mark: a file that begins with the first comment is complete only if it
/// ends with the last one.
inline constexpr std::string_view abaqus_first_comment = "** smoothfem mesh",
                                  abaqus_last_comment = "** end of smoothfem mesh";

}  // namespace smoothfem
