// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "fem/constraints/node_ties.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {

enum class Cells {
  triangles,
  quadrilaterals,
  mixed,
  tetrahedra,
  hexahedra,
  pyramids,
  prisms,
  mixed_volume
};

constexpr int dimension_of(Cells cells) {
  return cells >= Cells::tetrahedra ? 3 : 2;
}

/// Makes n x n squares on [0, 1]^2, each one quadrilateral or two triangles (mixed: every other
/// square). Inner nodes are moved by `amount` edge lengths in directions that vary from node to
/// node.
inline PlanarMesh unit_square(std::size_t n, Cells kind, double amount) {
  std::vector<Point<2>> points;
  const double h = 1.0 / static_cast<double>(n);
  for (std::size_t j = 0; j <= n; ++j)
    for (std::size_t i = 0; i <= n; ++i) {
      const double x = static_cast<double>(i), y = static_cast<double>(j);
      const bool inner = i > 0 && j > 0 && i < n && j < n;
      const double move = inner ? amount : 0.0;
      points.emplace_back(h * (x + move * std::sin(3.0 * x + 5.0 * y)),
                          h * (y + move * std::cos(4.0 * x - 2.0 * y)));
    }
  CompressedRows<NodeIndex> cells;
  for (NodeIndex j = 0; j < n; ++j)
    for (NodeIndex i = 0; i < n; ++i) {
      const auto width = static_cast<NodeIndex>(n) + 1;
      const NodeIndex a = j * width + i, b = a + 1, c = b + width, d = a + width;
      if (kind == Cells::quadrilaterals || (kind == Cells::mixed && (i + j) % 2 == 0)) {
        cells.append(std::vector{a, b, c, d});
      } else {
        cells.append(std::vector{a, b, c});
        cells.append(std::vector{a, c, d});
      }
    }
  const std::size_t n_nodes = points.size();
  return {std::make_shared<Topology>(2, n_nodes, std::move(cells)), std::move(points)};
}

/// Makes n x n x n cubes on [0, 1]^3, each one hexahedron, six tetrahedra or pyramids, or two
/// prisms; mixed: layers of each. Inner nodes are moved at random, by up to `amount` edge lengths
/// in each direction.
inline VolumeMesh unit_cube(std::size_t n, Cells kind, double amount) {
  const auto size = static_cast<std::uint32_t>(n);
  using test::BoxCells;
  VolumeMesh mesh = test::box_mesh(size, size, size,
                                   kind == Cells::tetrahedra  ? BoxCells::tetrahedra
                                   : kind == Cells::hexahedra ? BoxCells::hexahedra
                                   : kind == Cells::pyramids  ? BoxCells::pyramids
                                   : kind == Cells::prisms    ? BoxCells::prisms
                                                              : BoxCells::mixed);
  if (amount > 0.0) test::distort(mesh, amount, 1);
  for (auto& p : mesh.coordinates()) p /= static_cast<double>(n);
  return mesh;
}

/// dim: dimension of the cells.
template <int dim>
Mesh<dim> unit_mesh(std::size_t n, Cells kind, double amount) {
  if constexpr (dim == 2)
    return unit_square(n, kind, amount);
  else
    return unit_cube(n, kind, amount);
}

/// Returns the mesh with each boundary facet in a group: "left" at x = 0, "right" at x = 1,
/// otherwise "side", with the tags 1, 2 and 3.
template <int dim>
Mesh<dim> with_groups(const Mesh<dim>& mesh) {
  const Topology& topology = mesh.topology();
  MeshLabels labels;
  labels.names = {{{dim - 1, 1}, "left"}, {{dim - 1, 2}, "right"}, {{dim - 1, 3}, "side"}};
  for (std::size_t f = 0; f < topology.boundary_facets().size(); ++f) {
    const auto facet = topology.boundary_facets()[f];
    const auto all_at = [&](double x) {
      return std::all_of(facet.begin(), facet.end(), [&](NodeIndex node) {
        return std::abs(mesh.coordinates()[node].x() - x) < 1e-12;
      });
    };
    labels.facets.append(facet);
    labels.facet_tags.push_back(all_at(0.0) ? 1 : all_at(1.0) ? 2 : 3);
  }
  return {std::make_shared<const Topology>(dim, mesh.n_nodes(), topology.cells(), std::nullopt,
                                           std::move(labels)),
          mesh.copied_coordinates()};
}

/// Returns the unit mesh of n cells in each direction, n even, with inner nodes moved, but those at
/// x = 1/2 only along that plane. Its cells have the tags 1, "left", and 2, "right".
template <int dim>
Mesh<dim> two_materials(std::size_t n, Cells kind, double amount) {
  const Mesh<dim> plain = unit_mesh<dim>(n, kind, 0.0), grouped = with_groups(plain);
  MeshLabels labels = grouped.topology().labels();
  labels.names.insert({{{dim, 1}, "left"}, {{dim, 2}, "right"}});
  for (CellIndex c = 0; c < plain.n_cells(); ++c) {
    double x = 0.0;
    for (const NodeIndex node : plain.topology().cell_nodes(c)) x += plain.coordinates()[node].x();
    const bool left = x < 0.5 * static_cast<double>(plain.topology().cell_nodes(c).size());
    labels.cell_tags.push_back(left ? 1 : 2);
  }
  auto x = unit_mesh<dim>(n, kind, amount).copied_coordinates();
  for (NodeIndex i = 0; i < x.size(); ++i)
    if (std::abs(plain.coordinates()[i].x() - 0.5) < 1e-12) x[i].x() = 0.5;
  return {std::make_shared<const Topology>(dim, plain.n_nodes(), plain.topology().cells(),
                                           std::nullopt, std::move(labels)),
          std::move(x)};
}

/// Ties the nodes at x = 1 of a unit mesh to those at x = 0.
template <int dim>
NodeTies periodic_in_x(const Mesh<dim>& mesh) {
  NodeTies ties;
  const auto& x = mesh.coordinates();
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    for (NodeIndex j = 0; x[i].x() == 1.0 && j < mesh.n_nodes(); ++j)
      if ((x[i] - x[j] - Point<dim>::Unit(0)).norm() < 1e-12) ties.nodes.push_back({i, {{j, 1.0}}});
  for (std::size_t f = 0; f < mesh.topology().boundary_facets().size(); ++f) {
    const auto facet = mesh.topology().boundary_facets()[f];
    std::vector<NodeIndex> nodes(facet.begin(), facet.end());
    std::sort(nodes.begin(), nodes.end());
    for (const double side : {0.0, 1.0})
      if (std::all_of(nodes.begin(), nodes.end(), [&](NodeIndex i) { return x[i].x() == side; }))
        ties.inner_facets.insert(nodes);
  }
  return ties;
}

/// An element type and degree, as a test parameter.
struct Case {
  Cells cells;
  int degree;

  /// Calls body.operator()<dim>(mesh) with the unit mesh of these cells: n_planar or n_volume of
  /// them in each direction.
  template <class Body>
  void on_mesh(std::size_t n_planar, std::size_t n_volume, double amount, const Body& body) const {
    with_dimension(dimension_of(cells), [&]<int dim>() {
      body(unit_mesh<dim>(dim == 2 ? n_planar : n_volume, cells, amount));
    });
  }
};

inline const char* name_of(Cells cells) {
  constexpr const char* names[] = {"triangles", "quadrilaterals", "mixed",  "tetrahedra",
                                   "hexahedra", "pyramids",       "prisms", "mixed_volume"};
  return names[static_cast<int>(cells)];
}
inline void PrintTo(Cells cells, std::ostream* out) {
  *out << name_of(cells);
}

/// Name for ParamInfo and failure messages.
inline std::string name_of(const Case& c) {
  return std::string(name_of(c.cells)) + "_degree_" + std::to_string(c.degree);
}
inline void PrintTo(const Case& c, std::ostream* out) {
  *out << name_of(c);
}

/// Returns every kind of cells with each of its degrees.
inline std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const Cells cells :
       {Cells::triangles, Cells::quadrilaterals, Cells::mixed, Cells::tetrahedra, Cells::hexahedra})
    for (const int degree : {1, 2}) cases.push_back({cells, degree});
  for (const Cells cells : {Cells::pyramids, Cells::prisms, Cells::mixed_volume})
    cases.push_back({cells, 1});
  return cases;
}

/// Returns the cases of deal.II 9.4, which does not number dofs of mixed volume meshes.
inline std::vector<Case> cases_of_deal_ii() {
  auto cases = all_cases();
  std::erase_if(cases, [](const Case& c) { return c.cells == Cells::mixed_volume; });
  return cases;
}

/// Returns the cases of volume meshes.
inline std::vector<Case> volume_cases() {
  auto cases = all_cases();
  std::erase_if(cases, [](const Case& c) { return dimension_of(c.cells) == 2; });
  return cases;
}

}  // namespace smoothfem
