// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// Elements of one dimension as a file lists them. The vectors are empty or have one entry each.
struct ElementList {
  CompressedRows<NodeIndex> nodes;  ///< in the order of volume_elements.h
  std::vector<int> tags;            ///< physical tags; 0 stands for none
  std::vector<std::size_t> ids;     ///< the file's numbers
  std::vector<std::size_t> lines;   ///< lines of the file
};

/// What the reader of any format collects; node indices are the file's order, from 0.
struct MeshParts {
  std::vector<Point<3>> coordinates;
  std::array<ElementList, 4> elements;               ///< by dimension
  std::optional<std::vector<bool>> fixed;            ///< without it the boundary nodes are fixed
  bool boundary_is_fixed_too = false;                ///< where `fixed` is given
  std::map<std::pair<int, int>, std::string> names;  ///< (dimension, tag) -> physical name
  std::vector<std::size_t> node_ids;                 ///< the file's numbers; may be empty
};

/// Makes the mesh: a volume mesh of the elements of dimension 3 if there are any, otherwise a
/// planar one of those of dimension 2, or a surface mesh where z is not constant (its tags and
/// labelled edges are features). Elements of one dimension less are labelled facets if they have a
/// tag; all others are left out. Numbers of nodes and cells are kept if they are positive, all
/// different and not just 1, 2, ... in order. Errors of the mesh become InputErrors that start with
/// "path:line: " or "path: ".
MeshFile assemble_mesh(const std::filesystem::path& path, MeshParts parts);

/// A physical name as one line "dimension tag name", for formats that have no section for it.
std::string physical_name_line(const std::pair<int, int>& dimension_and_tag,
                               const std::string& name);
/// Adds the name of such a line; false if it is none.
bool add_physical_name(const std::string& line, MeshParts& parts);

/// For writers of formats without polygons: throws InputError if the mesh has one.
void require_no_polygons(const std::filesystem::path& path, const MeshView& mesh);

/// Removes nodes that no element of dimension 1 and more uses (points of a CAD model), keeping the
/// order.
void drop_unused_nodes(MeshParts& parts);

}  // namespace smoothfem
