// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/refinement/split_cells.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <utility>

#include "meshes/io/losses.h"
#include "smoothing/mesh/fixed_nodes.h"

namespace smoothfem {

namespace {

/// A set of a cell's nodes, node i as bit i. Their mean is a node of a part.
using Corners = unsigned int;
/// The nodes of a part, in the order of its element.
using Part = std::vector<Corners>;
using Parts = std::vector<Part>;

constexpr Corners at(std::initializer_list<unsigned int> nodes) {
  Corners corners = 0;
  for (const unsigned int node : nodes) corners |= 1U << node;
  return corners;
}

/// Corners of a square or a cube with edges of length one.
constexpr std::array<std::array<unsigned int, 3>, 8> corner_of{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

/// Returns the corners of a square or cube, of n nodes, whose mean is a point of the lattice {0, 1,
/// 2}^n.
Corners at_lattice(std::size_t n_nodes, const std::array<unsigned int, 3>& point) {
  Corners corners = 0;
  for (std::size_t i = 0; i < n_nodes; ++i) {
    bool near = true;
    for (std::size_t d = 0; d < 3; ++d) near &= point[d] == 1 || point[d] == 2 * corner_of[i][d];
    if (near) corners |= 1U << i;
  }
  return corners;
}

Parts parts_of_box(std::size_t n_nodes) {
  Parts parts;
  for (std::size_t part = 0; part < n_nodes; ++part) {
    auto& nodes = parts.emplace_back();
    for (std::size_t i = 0; i < n_nodes; ++i)
      nodes.push_back(at_lattice(
          n_nodes, {corner_of[part][0] + corner_of[i][0], corner_of[part][1] + corner_of[i][1],
                    corner_of[part][2] + corner_of[i][2]}));
  }
  return parts;
}

Parts parts_of_triangle() {
  const Corners a = at({0}), b = at({1}), c = at({2});
  return {{a, a | b, a | c}, {a | b, b, b | c}, {a | c, b | c, c}, {a | b, b | c, a | c}};
}

/// The four parts of its triangle, below and above the middle.
Parts parts_of_prism() {
  Parts parts;
  for (const Part& triangle : parts_of_triangle())
    for (const auto& [below, above] : {std::pair{1U, 9U}, {9U, 8U}}) {  // 9: bits 0 and 3
      auto& nodes = parts.emplace_back();
      for (const unsigned int level : {below, above})
        for (const Corners corners : triangle) nodes.push_back(corners * level);
    }
  return parts;
}

Parts parts_of_pyramid() {
  const Corners base = at({0, 1, 2, 3}), tip = at({4});
  Parts parts;
  for (unsigned int i = 0; i < 4; ++i) {
    const Corners here = at({i}), next = at({(i + 1) % 4}), last = at({(i + 3) % 4});
    parts.push_back({here, here | next, base, here | last, here | tip});
    parts.push_back({here | next, base, here | tip, next | tip});
  }
  parts.push_back({at({0, 4}), at({1, 4}), at({2, 4}), at({3, 4}), tip});
  parts.push_back({at({0, 4}), at({3, 4}), at({2, 4}), at({1, 4}), base});
  return parts;
}

Parts parts_of_corners_of_tetrahedron() {
  Parts parts;
  for (unsigned int i = 0; i < 4; ++i) {
    auto& nodes = parts.emplace_back();
    for (unsigned int j = 0; j < 4; ++j) nodes.push_back(at({i}) | at({j}));
  }
  return parts;
}

/// A diagonal of the octahedron inside a tetrahedron, and the nodes around it.
struct Octahedron {
  Corners from, to;
  std::array<Corners, 4> around;
};

const std::array<Octahedron, 3>& octahedra() {
  const Corners a = at({0, 1}), b = at({0, 2}), c = at({0, 3}), d = at({1, 2}), e = at({1, 3}),
                f = at({2, 3});
  static const std::array<Octahedron, 3> ways{
      {{a, f, {b, d, e, c}}, {b, e, {a, c, f, d}}, {c, d, {a, e, f, b}}}};
  return ways;
}

template <int dim>
class Splitting {
 public:
  Splitting(const Mesh<dim>& mesh, std::span<const std::uint32_t> numbers)
      : mesh_(mesh), numbers_(numbers), points_(mesh.copied_coordinates()) {}

  SplitCells<dim> split() {
    const Topology& topology = mesh_.topology();
    const MeshLabels& labels = topology.labels();
    MeshLabels of_parts;
    of_parts.names = labels.names;
    std::vector<CellIndex> origins;
    for (CellIndex c = 0; c < topology.n_cells(); ++c) {
      const std::size_t before = cells_.size();
      split_cell(topology.cell_nodes(c), topology.cell_type(c));
      origins.insert(origins.end(), cells_.size() - before, c);
      if (!labels.cell_tags.empty())
        of_parts.cell_tags.insert(of_parts.cell_tags.end(), cells_.size() - before,
                                  labels.cell_tags[c]);
    }
    for (std::size_t f = 0; f < labels.facets.size(); ++f) {
      const std::size_t before = of_parts.facets.size();
      split_facet(labels.facets[f], of_parts.facets);
      of_parts.facet_tags.insert(of_parts.facet_tags.end(), of_parts.facets.size() - before,
                                 labels.facet_tags[f]);
    }
    of_parts.content = content_of_parts(labels.content.get());
    return {std::move(points_), std::move(means_), std::move(cells_), std::move(origins),
            std::move(of_parts)};
  }

 private:
  using Nodes = std::span<const NodeIndex>;

  /// Returns the plane of a planar mesh in space, in which existing nodes keep their points.
  std::shared_ptr<const FileContent> content_of_parts(const FileContent* content) const {
    if constexpr (dim == 2)
      if (content && content->plane) {
        PlaneInSpace plane = *content->plane;
        auto initial = std::exchange(plane.initial, {});
        for (auto i = static_cast<NodeIndex>(initial.size()); i > 0 && i < points_.size(); ++i)
          initial.push_back(plane.in_space(i, points_[i]));
        plane.initial = std::move(initial);
        FileContent result;
        result.plane = std::move(plane);
        return std::make_shared<const FileContent>(std::move(result));
      }
    return nullptr;
  }

  void split_cell(Nodes nodes, ElementType type) {
    static const Parts triangle = parts_of_triangle(), square = parts_of_box(4),
                       cube = parts_of_box(8), prism = parts_of_prism(),
                       pyramid = parts_of_pyramid(),
                       tetrahedron = parts_of_corners_of_tetrahedron();
    switch (type) {
      case ElementType::triangle:
        return append(nodes, triangle, cells_);
      case ElementType::quadrilateral:
        return append(nodes, square, cells_);
      case ElementType::hexahedron:
        return append(nodes, cube, cells_);
      case ElementType::prism:
        return append(nodes, prism, cells_);
      case ElementType::pyramid:
        return append(nodes, pyramid, cells_);
      case ElementType::tetrahedron:
        append(nodes, tetrahedron, cells_);
        if constexpr (dim == 3) append_octahedron(nodes);
        return;
      default:
        throw InputError("a cell with " + std::to_string(nodes.size()) +
                         " nodes cannot be split; cells may have three or four nodes in the plane");
    }
  }

  void split_facet(Nodes nodes, CompressedRows<NodeIndex>& facets) {
    static const Parts edge{{at({0}), at({0, 1})}, {at({0, 1}), at({1})}};
    static const Parts triangle = parts_of_triangle(), square = parts_of_box(4);
    append(nodes, nodes.size() == 2 ? edge : nodes.size() == 3 ? triangle : square, facets);
  }

  void append(Nodes nodes, const Parts& parts, CompressedRows<NodeIndex>& rows) {
    std::vector<NodeIndex> row;
    for (const Part& part : parts) {
      row.clear();
      for (const Corners corners : part) row.push_back(node(nodes, corners));
      rows.append(row);
    }
  }

  void append_octahedron(Nodes nodes) {
    const Octahedron* shortest = nullptr;
    double least = 0.0;
    for (const auto& way : octahedra()) {
      const double length =
          (points_[node(nodes, way.from)] - points_[node(nodes, way.to)]).squaredNorm();
      if (shortest != nullptr && length >= least) continue;
      shortest = &way;
      least = length;
    }
    for (std::size_t i = 0; i < 4; ++i)
      cells_.append(
          positive({node(nodes, shortest->from), node(nodes, shortest->to),
                    node(nodes, shortest->around[i]), node(nodes, shortest->around[(i + 1) % 4])}));
  }

  std::array<NodeIndex, 4> positive(std::array<NodeIndex, 4> tetrahedron) const {
    Eigen::Matrix<double, dim, dim> edges;
    for (int d = 0; d < dim; ++d)
      edges.col(d) =
          points_[tetrahedron[static_cast<std::size_t>(d) + 1]] - points_[tetrahedron[0]];
    if (edges.determinant() < 0.0) std::swap(tetrahedron[2], tetrahedron[3]);
    return tetrahedron;
  }

  /// Returns the node in the middle of these corners. Cells with the same corners share it.
  NodeIndex node(Nodes nodes, Corners corners) {
    constexpr NodeIndex none = std::numeric_limits<NodeIndex>::max();
    std::array<NodeIndex, 8> key;
    key.fill(none);
    std::size_t n = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if ((corners >> i & 1U) != 0) key[n++] = nodes[i];
    if (n == 1) return key[0];
    const auto is_before = [&](NodeIndex a, NodeIndex b) {
      return numbers_.empty() ? a < b : numbers_[a] < numbers_[b];
    };
    std::sort(key.begin(), key.begin() + static_cast<std::ptrdiff_t>(n), is_before);
    const auto [found, is_new] =
        new_nodes_.try_emplace(key, static_cast<NodeIndex>(points_.size()));
    if (is_new) {
      Point<dim> sum = Point<dim>::Zero();
      for (std::size_t i = 0; i < n; ++i) sum += points_[key[i]];
      points_.push_back(sum / static_cast<double>(n));
      means_.append(std::span(key).first(n));
    }
    return found->second;
  }

  const Mesh<dim>& mesh_;
  std::span<const std::uint32_t> numbers_;
  std::vector<Point<dim>> points_;
  CompressedRows<NodeIndex> means_, cells_;
  std::map<std::array<NodeIndex, 8>, NodeIndex> new_nodes_;
};

}  // namespace

template <int dim>
SplitCells<dim> split_cells(const Mesh<dim>& mesh, std::span<const std::uint32_t> numbers) {
  require_linear(mesh.topology(), "splitting");
  return Splitting<dim>(mesh, numbers).split();
}

namespace {

template <int dim>
Mesh<dim> mesh_of(SplitCells<dim> split) {
  auto topology = std::make_shared<const Topology>(dim, split.points.size(), std::move(split.cells),
                                                   std::nullopt, std::move(split.labels));
  return {std::move(topology), std::move(split.points)};
}

}  // namespace

template <int dim>
Mesh<dim> with_split_cells(const Mesh<dim>& mesh) {
  return mesh_of(split_cells(mesh));
}

template <int dim>
Mesh<dim> refined(const Mesh<dim>& mesh) {
  SplitCells<dim> split = split_cells(mesh);
  const CompressedRows<NodeIndex> means = std::move(split.means);
  Mesh<dim> result = mesh_of(std::move(split));
  std::vector<bool> stays;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    stays.push_back(mesh.topology().fixed_reasons(i) != 0);
  for (std::size_t i = 0; i < means.size(); ++i) {
    const auto mean = means[i];
    stays.push_back(
        result.topology().on_boundary()[mesh.n_nodes() + i] &&
        std::all_of(mean.begin(), mean.end(), [&](NodeIndex node) -> bool { return stays[node]; }));
  }
  return with_fixed_nodes(std::move(result), stays);
}

std::vector<std::string> losses_of_splitting(const MeshLabels& labels) {
  std::vector<std::string> lost;
  const auto add = [&](bool is_lost, const std::string& what) {
    if (is_lost) lost.push_back(what);
  };
  add(!labels.node_ids.empty() || !labels.cell_ids.empty(),
      "the file's numbers of nodes and cells");
  if (!labels.content) return lost;
  const FileContent& content = *labels.content;
  const auto is_number = [](const MeshField& field, const auto& roles) {
    const auto role = roles.find("GlobalIds");
    return role != roles.end() && role->second == field.name;
  };
  for (const MeshField& field : content.node_fields)
    add(!is_number(field, content.node_roles), "the field " + field.name);
  for (const MeshField& field : content.element_fields)
    add(!is_number(field, content.element_roles) && field.name != content.tag_field &&
            !is_own_field(field),
        "the field " + field.name);
  for (const MeshField& field : content.file_fields) add(true, "the field " + field.name);
  add(std::any_of(content.others.begin(), content.others.end(),
                  [](const OtherElements& others) { return !others.nodes.empty(); }),
      "elements that are neither cells nor labelled facets");
  add(!content.periodic.empty(), "periodic partners");
  add(!content.entities.empty(), "entities of the model");
  for (const std::string& name : content.section_names) add(true, name);
  return lost;
}

template SplitCells<2> split_cells(const Mesh<2>&, std::span<const std::uint32_t>);
template SplitCells<3> split_cells(const Mesh<3>&, std::span<const std::uint32_t>);
template Mesh<2> with_split_cells(const Mesh<2>&);
template Mesh<3> with_split_cells(const Mesh<3>&);
template Mesh<2> refined(const Mesh<2>&);
template Mesh<3> refined(const Mesh<3>&);

}  // namespace smoothfem
