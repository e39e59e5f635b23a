// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// Reads a Gmsh file: version 2.2 or 4.1, text or binary in either byte order, or version 1 or 4.0
/// as text, their only form (reference manual of Gmsh, "MSH file format"). Nodes and cells come in
/// the order of their tags; nodes that no element uses are dropped. Kept are elements of all
/// dimensions, node and element tags, physical groups and their names, the entities of the model,
/// periodic nodes, node and element data, and the text of other sections. The first of several
/// groups of an entity is the tag of its elements. Version 2 repeats an element for each of its
/// groups; such elements are joined, and the numbers and data of their rows are kept. Parametric
/// coordinates, partitions and ghost elements are left out, with a note. Another note says that the
/// file is one of those into which Gmsh has split a mesh. Memory is a small multiple
/// of the file's size, whatever counts it announces.
///
/// Throws InputError "path:line: message" ("path: at byte N: ..." for binary files). Causes: other
/// versions, incomplete files, nodes or elements with equal tags, coordinates that are not finite,
/// and elements of an order above 2.
MeshParts read_msh(const std::filesystem::path& path, const MeshReadOptions& = {});

/// Writes a Gmsh file. Version and encoding follow the options; text has enough digits to keep
/// every bit. Each physical tag is an entity of the model. Throws InputError for polygons with five
/// or more nodes. In version 2.2 throws it also if only some cells have a tag, or if numbers of
/// nodes or cells do not fit into 32 bits.
void write_msh(const std::filesystem::path& path, const MeshView& mesh, const MeshFields& fields,
               const MeshWriteOptions& options);

}  // namespace smoothfem
