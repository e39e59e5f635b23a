// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "smoothing/mesh/compressed_rows.h"
#include "smoothing/mesh/midside_nodes.h"
#include "smoothing/mesh/number_type.h"
#include "smoothing/mesh/point.h"

/// What a mesh file says besides nodes and cells. Smoothing does not change it: it is copied from
/// input to output.

namespace smoothfem {

/// Numbers at nodes or elements, or of the mesh as a whole.
struct MeshField {
  std::string name;
  std::size_t n_components = 1;
  NumberType type = NumberType::float64;
  /// Row by row. Integers of 64 bits without a sign are kept with their bits.
  std::variant<std::vector<double>, std::vector<std::int64_t>> values{};
  double time = 0.0;  ///< of a result, as in .msh files
  int step = 0;

  std::size_t n_rows() const {
    return std::visit([this](const auto& v) { return v.size() / n_components; }, values);
  }
  double number(std::size_t i) const {
    return std::visit([i](const auto& v) { return static_cast<double>(v[i]); }, values);
  }
  bool operator==(const MeshField&) const = default;
};

/// Elements of one dimension that are neither cells nor labelled facets: facets without a tag,
/// edges of volume meshes, and points.
struct OtherElements {
  CompressedRows<NodeIndex> nodes;
  std::vector<int> tags;         ///< physical tag of each; 0: none
  std::vector<int> entities;     ///< of the model; empty if the file has none
  std::vector<std::size_t> ids;  ///< the file's numbers; empty if it has none

  bool operator==(const OtherElements&) const = default;
};

/// An entity (point, curve, surface or volume) of the model that a mesh was made of, as in .msh
/// files. A format without entities gets one for each combination of groups that elements have.
struct ModelEntity {
  std::vector<int> groups;    ///< tags of all its physical groups
  std::vector<int> boundary;  ///< numbers of the entities on its boundary, with signs
  std::vector<double> box;    ///< two corners, or the coordinates of a point; may be empty

  bool operator==(const ModelEntity&) const = default;
};

/// A further row of an element, which version 2 of Gmsh's format repeats for each of its groups.
struct RepeatedElement {
  int group = 0;
  std::size_t id = 0;            ///< the row's number
  std::vector<double> values{};  ///< of all element fields, one after the other

  bool operator==(const RepeatedElement&) const = default;
};

/// Nodes of an entity that are images of nodes of a partner entity.
struct PeriodicEntity {
  int dimension = 0, entity = 0, partner = 0;
  std::vector<double> affine;  ///< 4 x 4, maps the partner to the entity; may be empty
  std::vector<std::array<NodeIndex, 2>> nodes;  ///< node, and its partner

  bool operator==(const PeriodicEntity&) const = default;
};

/// The plane in space that a planar mesh lies in: point (u, v) of the mesh is
/// origin + u * x_axis + v * y_axis.
struct PlaneInSpace {
  Point<3> origin = Point<3>::Zero(), x_axis = Point<3>::UnitX(), y_axis = Point<3>::UnitY();
  /// Nodes of the file that are off the plane by rounding; empty if none is. A node that has not
  /// moved keeps its point.
  std::vector<Point<3>> initial;

  Point<2> in_plane(const Point<3>& point) const {
    return {(point - origin).dot(x_axis), (point - origin).dot(y_axis)};
  }
  Point<3> in_space(NodeIndex node, const Point<2>& point) const {
    if (!initial.empty() && in_plane(initial[node]) == point) return initial[node];
    return origin + point.x() * x_axis + point.y() * y_axis;
  }
  bool operator==(const PlaneInSpace&) const = default;
};

/// Everything that a file says beyond MeshLabels. "All elements" are, in this order: the cells, the
/// labelled facets, and the other elements from the highest dimension to points.
struct FileContent {
  std::string format;   ///< name in mesh_formats()
  std::string version;  ///< of the format, for example "2.2"; may be empty
  bool is_binary = false;

  std::vector<std::size_t> facet_ids;  ///< the file's numbers of labelled facets; may be empty
  std::vector<int> cell_entities, facet_entities;  ///< of the model; empty if the file has none
  std::array<OtherElements, 3> others;             ///< by dimension
  std::vector<std::uint32_t> file_order;  ///< all elements as in the file; empty: in our order

  std::map<std::pair<int, int>, ModelEntity> entities;  ///< by dimension and number
  /// Further rows of elements, by the elements' dimension and number.
  std::map<std::pair<int, std::size_t>, std::vector<RepeatedElement>> repeated;
  std::vector<std::array<int, 2>> node_entities;  ///< dimension and number; empty: not known
  std::vector<PeriodicEntity> periodic;

  std::optional<PlaneInSpace> plane;  ///< of planar meshes; nothing for the plane z = 0

  std::string tag_field;  ///< name of the array with the tags, in formats that name it
  std::vector<MeshField> node_fields, element_fields, file_fields;
  /// Names of the arrays that have a role in VTK files, by the role, for example "Scalars".
  std::map<std::string, std::string> node_roles, element_roles;
  std::vector<std::string> sections;       ///< text that only the same version of the format holds
  std::vector<std::string> section_names;  ///< what these say, for messages

  bool operator==(const FileContent&) const = default;
};

class MeshPart;  // smoothing/parts/mesh_part.h

/// Labels of a file for nodes and cells, copied from input to output unchanged.
struct MeshLabels {
  std::vector<int> cell_tags;        ///< physical tag of each cell; empty if the file has none
  CompressedRows<NodeIndex> facets;  ///< labelled edges of planar meshes, faces of volume meshes
  std::vector<int> facet_tags;       ///< physical tag of each facet, never 0
  std::map<std::pair<int, int>, std::string> names;  ///< (dimension, tag) -> physical name
  std::vector<std::size_t> node_ids;  ///< the file's number of each node; empty if it has none
  std::vector<std::size_t> cell_ids;  ///< the file's number of each cell; empty if they are plain
  bool has_plain_cell_ids = false;    ///< the file's numbers of cells are 1, 2, 3, ...
  std::shared_ptr<const FileContent> content{};   ///< null if the file says nothing else
  std::shared_ptr<const MidsideNodes> midside{};  ///< null if all elements are linear
  std::shared_ptr<const MeshPart> part{};         ///< null if this is the whole mesh

  /// Returns the number of a cell for messages: the file's, otherwise the index.
  std::size_t cell_number(CellIndex cell) const {
    return cell_ids.empty() ? std::size_t{cell} + has_plain_cell_ids : cell_ids[cell];
  }

  /// Does not compare the content.
  bool operator==(const MeshLabels& other) const {
    return cell_tags == other.cell_tags && facets == other.facets &&
           facet_tags == other.facet_tags && names == other.names && node_ids == other.node_ids &&
           cell_ids == other.cell_ids;
  }
};

/// Returns the physical groups of an element: those of its entity, otherwise its tag.
inline std::vector<int> groups_of(const FileContent* content, int dimension, int entity, int tag) {
  if (content)
    if (const auto found = content->entities.find({dimension, entity});
        found != content->entities.end() && !found->second.groups.empty())
      return found->second.groups;
  return tag == 0 ? std::vector<int>() : std::vector<int>{tag};
}

}  // namespace smoothfem
