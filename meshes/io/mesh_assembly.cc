// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/mesh_assembly.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>

#include "meshes/doctor/repair.h"
#include "meshes/io/all_elements.h"
#include "meshes/io/plane_of_points.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/text.h"
#include "smoothing/geometry/extreme_size.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/mesh/interfaces.h"
#include "smoothing/surface/surface_constraints.h"

namespace smoothfem {

ElementNodes selected_nodes(const ElementList& elements, std::span<const std::size_t> rows) {
  ElementNodes selected;
  for (const std::size_t e : rows) {
    selected.nodes.append(elements.nodes[e]);
    if (!elements.midside.empty()) selected.midside.append(elements.midside[e]);
  }
  return selected;
}

namespace {

/// True if numbers are 1, 2, 3, ...
bool are_plain(const std::vector<std::size_t>& ids) {
  std::size_t next = 1;
  return std::all_of(ids.begin(), ids.end(), [&](std::size_t id) { return id == next++; });
}

/// Returns the file's numbers if they differ from the order; otherwise nothing.
std::vector<std::size_t> worth_keeping(std::vector<std::size_t> ids) {
  if (are_plain(ids)) return {};
  bool ascending = true;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] == 0) return {};
    ascending = ascending && (i == 0 || ids[i] > ids[i - 1]);
  }
  if (ascending) return ids;
  auto sorted = ids;
  std::sort(sorted.begin(), sorted.end());
  const bool unique = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  return unique ? ids : std::vector<std::size_t>();
}

/// Divides the elements of a file into labels and content, and consumes them.
class LabelParts {
 public:
  LabelParts(MeshParts& parts, int dim) : parts_(parts), dim_(dim), content_(parts.content) {}

  MeshLabels make() {
    auto& cells = parts_.elements[dim_];
    for (const ElementList& elements : parts_.elements)
      has_midside_ = has_midside_ || !elements.midside.empty();
    if (has_midside_)
      for (std::size_t c = 0; c < cells.nodes.size(); ++c)
        midside_.of_cells.append(cells.midside_of(c));
    take_positions(cells, all_of(cells));
    const auto is_set = [](int tag) { return tag != 0; };
    if (std::any_of(cells.tags.begin(), cells.tags.end(), is_set))
      labels_.cell_tags = std::move(cells.tags);
    labels_.has_plain_cell_ids = !cells.ids.empty() && are_plain(cells.ids);
    if (!labels_.has_plain_cell_ids) labels_.cell_ids = worth_keeping(std::move(cells.ids));
    labels_.node_ids = worth_keeping(std::move(parts_.node_ids));
    content_.cell_entities = std::move(cells.entities);
    divide_facets();
    for (int d = dim_ - 2; d >= 0; --d) add_others(d, all_of(parts_.elements[d]));
    labels_.names = std::move(parts_.names);
    arrange_fields();
    if (has_midside_) labels_.midside = std::make_shared<const MidsideNodes>(std::move(midside_));
    labels_.content = std::make_shared<const FileContent>(std::move(content_));
    return std::move(labels_);
  }

 private:
  using Rows = std::vector<std::size_t>;

  static Rows all_of(const ElementList& elements) {
    Rows rows(elements.nodes.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    return rows;
  }

  void take_positions(const ElementList& elements, const Rows& rows) {
    if (!elements.file_positions.empty())
      for (const std::size_t e : rows) positions_.push_back(elements.file_positions[e]);
  }

  void divide_facets() {
    const auto& facets = parts_.elements[dim_ - 1];
    Rows labelled, others;
    for (std::size_t f = 0; f < facets.nodes.size(); ++f) {
      const bool fits = dim_ == 2 || facets.nodes[f].size() <= 4;  // no cell has such a face
      const bool has_tag = !facets.tags.empty() && facets.tags[f] != 0;
      (fits && has_tag ? labelled : others).push_back(f);
    }
    take_positions(facets, labelled);
    for (const std::size_t f : labelled) {
      labels_.facets.append(facets.nodes[f]);
      if (has_midside_) midside_.of_facets.append(facets.midside_of(f));
      labels_.facet_tags.push_back(facets.tags[f]);
      if (!facets.ids.empty()) content_.facet_ids.push_back(facets.ids[f]);
      if (!facets.entities.empty()) content_.facet_entities.push_back(facets.entities[f]);
    }
    add_others(dim_ - 1, others);
  }

  void add_others(int dimension, const Rows& rows) {
    const auto& from = parts_.elements[static_cast<std::size_t>(dimension)];
    auto& to = content_.others[static_cast<std::size_t>(dimension)];
    take_positions(from, rows);
    for (const std::size_t e : rows) {
      to.nodes.append(from.nodes[e]);
      if (has_midside_)
        midside_.of_others[static_cast<std::size_t>(dimension)].append(from.midside_of(e));
      to.tags.push_back(from.tags.empty() ? 0 : from.tags[e]);
      if (!from.ids.empty()) to.ids.push_back(from.ids[e]);
      if (!from.entities.empty()) to.entities.push_back(from.entities[e]);
    }
  }

  /// Brings the element fields into the order of all elements, and keeps the file's order.
  void arrange_fields() {
    for (MeshField& field : content_.element_fields)
      std::visit(
          [&](auto& values) {
            std::decay_t<decltype(values)> arranged;
            arranged.reserve(positions_.size() * field.n_components);
            for (const std::size_t row : positions_)
              arranged.insert(
                  arranged.end(),
                  values.begin() + static_cast<std::ptrdiff_t>(row * field.n_components),
                  values.begin() + static_cast<std::ptrdiff_t>((row + 1) * field.n_components));
            values = std::move(arranged);
          },
          field.values);
    if (std::is_sorted(positions_.begin(), positions_.end())) return;
    content_.file_order.resize(positions_.size());
    std::iota(content_.file_order.begin(), content_.file_order.end(), std::uint32_t{0});
    std::sort(content_.file_order.begin(), content_.file_order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return positions_[a] < positions_[b]; });
  }

  MeshParts& parts_;
  int dim_;
  FileContent& content_;
  MeshLabels labels_;
  bool has_midside_ = false;
  MidsideNodes midside_;
  std::vector<std::uint32_t> positions_;  ///< in the file, of all elements
};

std::vector<FixedReasons> reasons_of(const MeshParts& parts, const Topology& topology) {
  std::vector<FixedReasons> reasons(topology.n_nodes(), 0);
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
    reasons[i] = topology.fixed_reasons(i) & bit(FixedReason::midside);
  const auto& on_boundary = topology.on_boundary();
  bool fixes_boundary = true;
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
    if (parts.fixed && !parts.fixes_boundary_as_well && on_boundary[i] && !(*parts.fixed)[i])
      fixes_boundary = false;
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
    if (on_boundary[i] && fixes_boundary) reasons[i] |= bit(FixedReason::boundary);
  add_implied_reasons(topology, reasons);
  if (parts.fixed) add_marks(*parts.fixed, reasons);
  return reasons;
}

std::shared_ptr<const Topology> make_topology(MeshParts& parts, int dim) {
  auto topology = std::make_shared<const Topology>(dim, parts.coordinates.size(),
                                                   std::move(parts.elements[dim].nodes),
                                                   std::nullopt, LabelParts(parts, dim).make());
  auto reasons = reasons_of(parts, *topology);
  if (reasons == topology->fixed_reasons()) return topology;
  return std::make_shared<const Topology>(dim, topology->n_nodes(), topology->cells(),
                                          std::move(reasons), topology->labels());
}

AnyMesh make_mesh(MeshParts& parts, int dim) {
  if (parts.coordinates.size() >= std::numeric_limits<NodeIndex>::max())
    throw InputError("the mesh has more nodes than 32 bits can count");
  if (dim == 3) {
    auto topology = make_topology(parts, dim);
    return VolumeMesh(std::move(topology), std::move(parts.coordinates));
  }
  if (!is_planar(parts)) {
    MeshLabels labels = LabelParts(parts, dim).make();
    return make_surface_mesh(std::move(parts.elements[dim].nodes), std::move(parts.coordinates),
                             std::move(labels), std::move(parts.fixed));
  }
  std::vector<Point<2>> points;
  points.reserve(parts.coordinates.size());
  for (const auto& point : parts.coordinates) points.emplace_back(point.x(), point.y());
  auto topology = make_topology(parts, dim);
  return PlanarMesh(std::move(topology), std::move(points));
}

/// Returns how many points of the model each group has, by its name or else its tag.
std::map<std::string, std::size_t> groups_of_points(const MeshParts& parts) {
  const ElementList& points = parts.elements[0];
  std::map<std::string, std::size_t> n_points;
  for (std::size_t e = 0; e < points.nodes.size() && !points.tags.empty(); ++e) {
    const int entity = points.entities.empty() ? 0 : points.entities[e];
    for (const int group : groups_of(&parts.content, 0, entity, points.tags[e])) {
      const auto name = parts.names.find({0, group});
      ++n_points[name == parts.names.end() ? std::to_string(group) : name->second];
    }
  }
  return n_points;
}

/// groups, left: those of points before and after nodes were left out.
std::string note_on_unused_nodes(std::size_t n, const std::map<std::string, std::size_t>& groups,
                                 const std::map<std::string, std::size_t>& left) {
  std::vector<std::string> lost;
  for (const auto& [name, n_points] : groups)
    if (const auto found = left.find(name); found == left.end() || found->second < n_points)
      lost.push_back(name);
  const bool is_one = n == 1;
  std::string note = std::to_string(n) +
                     (is_one ? " node that no cell uses is" : " nodes that no cell uses are") +
                     " left out";
  if (!lost.empty())
    note += (is_one ? ", with its point of the " : ", with their points of the ") +
            std::string(lost.size() == 1 ? "group " : "groups ") + joined(lost);
  return note;
}

/// Largest coordinate: its sixth powers (squares of volumes) do not overflow.
constexpr double largest_coordinate = 1e50;

}  // namespace

void require_usable_coordinates(const MeshParts& parts) {
  for (std::size_t i = 0; i < parts.coordinates.size(); ++i) {
    for (const double x : parts.coordinates[i]) {
      if (std::abs(x) <= largest_coordinate) continue;
      const bool has_id = !parts.node_ids.empty() && parts.node_ids[i] != 0;
      std::string text =
          "node " + std::to_string(has_id ? parts.node_ids[i] : i) + " has the coordinate ";
      append_number(text, x);
      throw InputError(text + (std::isfinite(x) ? ", so large that sizes of cells overflow; "
                                                  "choose a larger unit of length"
                                                : ", which is not a finite number"));
    }
  }
  if (!parts.coordinates.empty())
    require_ordinary_numbers(extreme_exponent(std::span<const Point<3>>(parts.coordinates)));
}

int dimension_of(const MeshParts& parts) {
  return parts.elements[3].nodes.empty() ? 2 : 3;
}

namespace {

/// Returns the points of the nodes that lines and cells have; empty if these have all nodes.
std::vector<Point<3>> points_of_elements(const MeshParts& parts) {
  std::vector<bool> is_used(parts.coordinates.size(), false);
  for (int dim = 1; dim <= 2; ++dim)
    for (const auto* rows : {&parts.elements[dim].nodes, &parts.elements[dim].midside})
      for (const NodeIndex node : rows->entries()) is_used[node] = true;
  std::vector<Point<3>> points;
  if (std::find(is_used.begin(), is_used.end(), false) == is_used.end()) return points;
  for (std::size_t i = 0; i < is_used.size(); ++i)
    if (is_used[i]) points.push_back(parts.coordinates[i]);
  return points;
}

}  // namespace

/// Nodes without an element may lie off the plane. They do not move, so they keep their points.
void lay_into_plane(MeshParts& parts) {
  if (dimension_of(parts) == 3) return;
  const auto points = points_of_elements(parts);
  auto plane = plane_of(points.empty() ? parts.coordinates : points);
  if (!plane) return;
  if (!points.empty()) {
    plane->initial.clear();
    for (NodeIndex i = 0; i < parts.coordinates.size(); ++i)
      if (plane->in_space(i, plane->in_plane(parts.coordinates[i])) != parts.coordinates[i]) {
        plane->initial = parts.coordinates;
        break;
      }
  }
  if (*plane == PlaneInSpace()) return;
  for (Point<3>& point : parts.coordinates) {
    const Point<2> in_plane = plane->in_plane(point);
    point = {in_plane.x(), in_plane.y(), 0.0};
  }
  parts.content.plane = std::move(plane);
}

namespace {

/// Throws CellError for an element of this dimension that names a node twice, with the node's
/// number in the file. Topology knows positions only.
void require_different_nodes(const MeshParts& parts, int dim) {
  const ElementList& cells = parts.elements[dim];
  std::vector<NodeIndex> sorted;
  for (std::size_t e = 0; e < cells.nodes.size(); ++e) {
    sorted.assign(cells.nodes[e].begin(), cells.nodes[e].end());
    const auto midside = cells.midside_of(e);
    sorted.insert(sorted.end(), midside.begin(), midside.end());
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice == sorted.end()) continue;
    // Files without numbers of nodes count from 0, apart from those of Medit.
    const std::size_t number = *twice < parts.node_ids.size()
                                   ? parts.node_ids[*twice]
                                   : *twice + (parts.content.format == "medit");
    throw CellError(e, "names node " + std::to_string(number) +
                           " more than once; give the cell different nodes, or remove it");
  }
}

}  // namespace

bool is_planar(const MeshParts& parts) {
  const auto& points = parts.coordinates;
  return std::all_of(points.begin(), points.end(),
                     [&](const auto& point) { return point.z() == points.front().z(); });
}

MeshFile assemble_mesh(const std::filesystem::path& path, MeshParts parts,
                       const MeshReadOptions& options) {
  const int dim = dimension_of(parts);
  std::vector<std::size_t> lines;
  try {
    const std::size_t n_nodes = parts.coordinates.size();
    const auto groups = groups_of_points(parts);
    if (parts.leaves_out_unused_nodes) drop_unused_nodes(parts);
    if (const std::size_t n = parts.elements[1].nodes.size();
        n > 0 && parts.elements[2].nodes.empty() && parts.elements[3].nodes.empty())
      throw InputError("the mesh has no cells, only " + std::to_string(n) +
                       (n == 1 ? " line" : " lines") +
                       "; use a mesh of triangles, quadrilaterals or volume elements");
    if (const std::size_t n = n_nodes - parts.coordinates.size(); n > 0)
      parts.notes.push_back(note_on_unused_nodes(n, groups, groups_of_points(parts)));
    require_usable_coordinates(parts);
    lay_into_plane(parts);
    auto notes = std::move(parts.notes);
    for (std::string& done : repair_while_reading(parts, options)) notes.push_back(std::move(done));
    lines = std::move(parts.elements[dim].lines);
    require_different_nodes(parts, dim);
    return {make_mesh(parts, dim), lines, std::move(notes)};
  } catch (const CellError& error) {
    std::string position = path.string() + ":";
    if (!lines.empty()) position += std::to_string(lines[error.cell()]) + ":";
    throw InputError(position + " " + error.what());
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

PlainMesh plain_mesh(MeshParts parts, std::vector<Point<3>> points, std::vector<bool> fixed) {
  PlainMesh mesh{
      .dimension = dimension_of(parts), .points = std::move(points), .fixed = std::move(fixed)};
  lay_into_plane(parts);
  mesh.labels = LabelParts(parts, mesh.dimension).make();  // before the cells are taken
  mesh.cells = std::move(parts.elements[mesh.dimension].nodes);
  std::vector<bool> is_used(mesh.points.size(), false);
  for (const NodeIndex node : mesh.cells.entries()) is_used[node] = true;
  for (NodeIndex i = 0; i < is_used.size(); ++i) {
    if (!is_used[i]) mesh.fixed[i] = true;
    if (mesh.dimension == 3) continue;
    const Point<2> p = mesh.points[i].head<2>();
    const auto& plane = mesh.labels.content->plane;
    mesh.points[i] = plane ? plane->in_space(i, p) : Point<3>(p.x(), p.y(), 0.0);
  }
  return mesh;
}

std::string physical_name_line(const std::pair<int, int>& dimension_and_tag,
                               const std::string& name) {
  return std::to_string(dimension_and_tag.first) + " " + std::to_string(dimension_and_tag.second) +
         " " + name;
}

bool add_physical_name(const std::string& line, MeshParts& parts) {
  std::istringstream words(line);
  int dimension = 0, tag = 0;
  std::string name;
  if (!(words >> dimension >> tag) || !std::getline(words.ignore(1), name)) return false;
  parts.names[{dimension, tag}] = name;
  return true;
}

void require_no_polygons(const std::filesystem::path& path, const MeshView& mesh) {
  const Topology& topology = mesh.topology();
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    if (topology.cell_type(c) != ElementType::polygon) continue;
    std::vector<std::string> others;
    for (const auto& format : mesh_formats())
      if (format.holds_polygons) others.push_back(format.extension);
    throw InputError("cannot write " + path.string() + ": cell " + std::to_string(c) + " has " +
                     std::to_string(topology.cell_nodes(c).size()) + " nodes, and " +
                     path.extension().string() +
                     " files hold only triangles and quadrilaterals; use one of " + joined(others));
  }
}

void require_held(const std::filesystem::path& path, const MeshView& mesh,
                  const std::string& program, const std::string& instead,
                  const std::function<bool(int, std::size_t, std::size_t)>& holds) {
  if (!mesh.topology().midside()) return;
  const AllElements elements(mesh);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const std::size_t n_corners = elements.nodes(e).size(), n_midside = elements.midside(e).size();
    if (n_midside == 0 || holds(elements.dimension(e), n_corners, n_midside)) continue;
    const std::string shape =
        elements.dimension(e) == 1
            ? "line"
            : std::string(name_of(element_type(elements.dimension(e), n_corners)));
    throw InputError("cannot write " + path.string() + ": no element of " + program +
                     " is known for a " + shape + " with " + std::to_string(n_corners + n_midside) +
                     " nodes; use " + instead);
  }
}

namespace {

CompressedRows<NodeIndex> renumbered(const CompressedRows<NodeIndex>& rows,
                                     const std::vector<NodeIndex>& new_index) {
  CompressedRows<NodeIndex> result;
  std::vector<NodeIndex> nodes;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    nodes.clear();
    for (const NodeIndex node : rows[i]) nodes.push_back(new_index[node]);
    result.append(nodes);
  }
  return result;
}

}  // namespace

namespace {

/// Keeps those rows of a field whose node takes no other's place.
void keep_rows(MeshField& field, std::span<const NodeIndex> first) {
  std::visit(
      [&](auto& values) {
        const std::size_t n = field.n_components;
        std::size_t n_kept = 0;
        for (std::size_t i = 0; i < first.size() && (i + 1) * n <= values.size(); ++i)
          if (first[i] == i)
            for (std::size_t k = 0; k < n; ++k) values[n_kept++] = values[i * n + k];
        values.resize(n_kept);
      },
      field.values);
}

template <class Value>
void keep_values(std::vector<Value>& values, std::span<const NodeIndex> first) {
  if (values.empty()) return;
  std::size_t n_kept = 0;
  for (std::size_t i = 0; i < first.size(); ++i)
    if (first[i] == i) values[n_kept++] = values[i];
  values.resize(n_kept);
}

/// Removes the points of the model at nodes that are removed.
void remove_points(ElementList& points, const std::vector<NodeIndex>& new_index) {
  ElementList kept;
  const auto keep = [](const auto& from, std::size_t e, auto& to) {
    if (!from.empty()) to.push_back(from[e]);
  };
  for (std::size_t e = 0; e < points.nodes.size(); ++e) {
    const NodeIndex node = new_index[points.nodes[e][0]];
    if (node == no_node) continue;
    kept.nodes.append(std::array{node});
    keep(points.tags, e, kept.tags);
    keep(points.ids, e, kept.ids);
    keep(points.lines, e, kept.lines);
    keep(points.entities, e, kept.entities);
    keep(points.file_positions, e, kept.file_positions);
  }
  points = std::move(kept);
}

/// Renumbers the nodes in what else the file says.
void renumber_content(MeshParts& parts, std::span<const NodeIndex> first,
                      const std::vector<NodeIndex>& new_index) {
  FileContent& content = parts.content;
  for (MeshField& field : content.node_fields) keep_rows(field, first);
  keep_values(content.node_entities, first);
  if (content.plane) keep_values(content.plane->initial, first);
  for (PeriodicEntity& periodic : content.periodic) {
    std::erase_if(periodic.nodes, [&](const auto& pair) {
      return new_index[pair[0]] == no_node || new_index[pair[1]] == no_node;
    });
    for (auto& pair : periodic.nodes) pair = {new_index[pair[0]], new_index[pair[1]]};
  }
  remove_points(parts.elements[0], new_index);
}

}  // namespace

void renumber_nodes(MeshParts& parts, std::span<const NodeIndex> first) {
  std::vector<NodeIndex> new_index(parts.coordinates.size(), no_node);
  NodeIndex n_left = 0;
  for (std::size_t i = 0; i < new_index.size(); ++i) {
    if (first[i] == no_node) continue;
    if (first[i] != i) {
      new_index[i] = new_index[first[i]];
      if (parts.fixed && (*parts.fixed)[i]) (*parts.fixed)[new_index[i]] = true;
      continue;
    }
    new_index[i] = n_left;
    parts.coordinates[n_left] = parts.coordinates[i];
    if (parts.fixed) (*parts.fixed)[n_left] = (*parts.fixed)[i];
    if (!parts.node_ids.empty()) parts.node_ids[n_left] = parts.node_ids[i];
    ++n_left;
  }
  if (n_left == parts.coordinates.size()) return;
  renumber_content(parts, first, new_index);
  parts.coordinates.resize(n_left);
  if (parts.fixed) parts.fixed->resize(n_left);
  if (!parts.node_ids.empty()) parts.node_ids.resize(n_left);
  for (int dim = 1; dim <= 3; ++dim)
    for (auto* rows : {&parts.elements[dim].nodes, &parts.elements[dim].midside})
      *rows = renumbered(*rows, new_index);
}

void drop_unused_nodes(MeshParts& parts) {
  std::vector<NodeIndex> first(parts.coordinates.size(), no_node);
  for (int dim = 1; dim <= 3; ++dim)
    for (const auto* rows : {&parts.elements[dim].nodes, &parts.elements[dim].midside})
      for (const NodeIndex node : rows->entries()) first[node] = node;
  renumber_nodes(parts, first);
}

}  // namespace smoothfem
