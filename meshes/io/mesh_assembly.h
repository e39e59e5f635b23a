// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// Stands for a node that does not exist.
constexpr NodeIndex no_node = std::numeric_limits<NodeIndex>::max();

/// Elements of one dimension as listed in a file. Each of the vectors is empty or has one entry for
/// each element.
struct ElementList {
  CompressedRows<NodeIndex> nodes;            ///< corners, in the order of volume_elements.h
  CompressedRows<NodeIndex> midside{};        ///< other nodes, in the order of midside_nodes.h
  std::vector<int> tags;                      ///< physical tags; 0 means none
  std::vector<std::size_t> ids;               ///< the file's numbers
  std::vector<std::size_t> lines;             ///< lines of the file
  std::vector<int> entities;                  ///< of the model
  std::vector<std::uint32_t> file_positions;  ///< among all elements of the file, from 0

  /// Adds the nodes of an element. all: in the order of midside_nodes.h.
  void append_nodes(std::span<const NodeIndex> all, std::size_t n_corners) {
    const bool is_first = midside.empty() && all.size() > n_corners;
    while (is_first && midside.size() < nodes.size()) midside.append(std::span<const NodeIndex>());
    nodes.append(all.first(n_corners));
    if (is_first || !midside.empty()) midside.append(all.subspan(n_corners));
  }
  /// Returns the nodes of an element other than its corners.
  std::span<const NodeIndex> midside_of(std::size_t e) const {
    return midside.empty() ? std::span<const NodeIndex>() : midside[e];
  }
};

/// Returns the rows of these elements in this order.
struct ElementNodes {
  CompressedRows<NodeIndex> nodes, midside;
};
ElementNodes selected_nodes(const ElementList& elements, std::span<const std::size_t> rows);

/// Data that a reader of any format collects. Node indices follow the file's order, from 0.
struct MeshParts {
  std::vector<Point<3>> coordinates;
  std::array<ElementList, 4> elements;               ///< by dimension
  std::optional<std::vector<bool>> fixed;            ///< without it the boundary nodes are fixed
  bool fixes_boundary_as_well = false;               ///< in addition to `fixed`
  std::map<std::pair<int, int>, std::string> names;  ///< (dimension, tag) -> physical name
  std::vector<std::size_t> node_ids;                 ///< the file's numbers; may be empty
  bool leaves_out_unused_nodes = false;              ///< points of a CAD model
  /// What else the file says; its elements are in `elements`, and the rows of its element fields
  /// are in the order of the file.
  FileContent content{};
  std::vector<std::string> notes{};  ///< on data that are left out or changed
};

/// Returns the data of a file without making a mesh of it. Throws InputError as read_mesh does, but
/// only for files that cannot be read.
MeshParts read_mesh_parts(const std::filesystem::path& path);

/// Returns the dimension of the elements that become cells: 3 if there are any, otherwise 2.
int dimension_of(const MeshParts& parts);
/// True if all nodes have the same z.
bool is_planar(const MeshParts& parts);

/// Gives the points of a planar mesh in space the coordinates of their plane, which is kept.
void lay_into_plane(MeshParts& parts);

/// Throws InputError that names the first node with a coordinate that is not finite or too large.
void require_usable_coordinates(const MeshParts& parts);

/// Makes a mesh. Elements of dimension 3, if any, make a volume mesh. Otherwise those of dimension
/// 2 make a planar mesh if all points lie in a plane, up to 1e-9 of their extent, and otherwise a
/// surface mesh; its tags and labelled edges are features. Elements of one dimension less are
/// labelled facets if they have a tag; all others are kept in the content. Numbers of nodes and
/// cells are kept if they are positive, all different and not simply 1, 2, ... in order. Nodes stay
/// for the reasons of add_implied_reasons(). Errors of the mesh become InputErrors that start with
/// "path:line: " or "path: ".
MeshFile assemble_mesh(const std::filesystem::path& path, MeshParts parts,
                       const MeshReadOptions& options = {});

/// A mesh that is only written. It has none of the tables of a Topology, which take most of the
/// time of assemble_mesh().
struct PlainMesh {
  int dimension = 3;  ///< of the cells
  std::vector<Point<3>> points{};
  CompressedRows<NodeIndex> cells{};
  std::vector<bool> fixed{};  ///< whether each node stays
  MeshLabels labels{};
};

/// Makes the same mesh as assemble_mesh() without options, but does not check it. points: its new
/// points, of planar meshes in their plane (z is not used). fixed: nodes that stay; those of no
/// cell stay in any case.
PlainMesh plain_mesh(MeshParts parts, std::vector<Point<3>> points, std::vector<bool> fixed);

/// Returns a physical name as one line "dimension tag name", for formats without a section for it.
std::string physical_name_line(const std::pair<int, int>& dimension_and_tag,
                               const std::string& name);
/// Adds the name of such a line; false if it is not such a line.
bool add_physical_name(const std::string& line, MeshParts& parts);

/// Throws InputError if the mesh has a polygon; for writers of formats without polygons.
void require_no_polygons(const std::filesystem::path& path, const MeshView& mesh);

/// Throws InputError for the first element of second order for which
/// holds(dimension, n_corners, n_midside) is false. program: whose format it is, for example
/// "Abaqus". instead: extensions of formats to use.
void require_held(const std::filesystem::path& path, const MeshView& mesh,
                  const std::string& program, const std::string& instead,
                  const std::function<bool(int, std::size_t, std::size_t)>& holds);

/// Gives the nodes new numbers in their order. first[i] is i, or an earlier node that takes the
/// place of node i, or no_node to remove node i, which then no element may use.
void renumber_nodes(MeshParts& parts, std::span<const NodeIndex> first);

/// Removes nodes that no element of dimension 1 or higher uses (points of a CAD model), keeping the
/// order.
void drop_unused_nodes(MeshParts& parts);

}  // namespace smoothfem
