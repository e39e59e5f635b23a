// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// Reads a Gmsh file, version 2.2 or 4.1, text or binary in either byte order, or 4.0 as text,
/// which is all that Gmsh has of it (format: reference manual of Gmsh, "MSH file format"). Nodes
/// and cells come in the order of their tags; nodes that no element uses are dropped. Physical
/// groups of cells and facets are kept with their names (of several groups of one entity the
/// first), node and element tags too. Points, parametric coordinates and other sections are
/// skipped, of partitions only their groups are read. Memory is a small multiple of the file's
/// size, whatever counts it announces.
///
/// Throws InputError "path:line: what is wrong" ("path: at byte N: ..." for binary files) for other
/// versions, files that are not complete, nodes or elements with equal tags, coordinates that are
/// not finite, and elements with nodes besides their corners.
MeshFile read_msh(const std::filesystem::path& path);

/// Version and encoding follow the options; text has the digits that give back every bit. Each
/// physical tag is an entity of the model. Throws InputError for polygons with five and more nodes;
/// in version 2.2 also for meshes where only some cells have a tag, and for numbers of nodes or
/// cells that do not fit into 32 bits.
void write_msh(const std::filesystem::path& path, const MeshView& mesh, const MeshFields& fields,
               const MeshWriteOptions& options);

}  // namespace smoothfem
