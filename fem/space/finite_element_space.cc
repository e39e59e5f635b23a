// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/space/finite_element_space.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "fem/space/curved_points.h"
#include "fem/space/natural_load.h"
#include "fem/space/numbered_dofs.h"

namespace smoothfem {

namespace {

constexpr auto absent = FiniteElementSpace<2>::absent;

/// Nodes around each local dof, from any cell that has it; their weights are all equal.
template <int dim>
void locate_dofs(FiniteElementSpace<dim>& space) {
  if (space.in_parts) {  // each dof is a node; short of memory
    std::vector<NodeIndex> node_of(space.n_local);
    for (NodeIndex node = 0; node < space.vertex_dof.size(); ++node)
      if (space.vertex_dof[node] != absent) node_of[space.vertex_dof[node]] = node;
    std::vector<RowOffset> offsets(space.n_local + 1);
    std::iota(offsets.begin(), offsets.end(), RowOffset{0});
    space.dof_nodes = {std::move(offsets), std::move(node_of)};
    return;
  }
  std::vector<std::vector<NodeIndex>> nodes(space.n_local);
  // Nodes of dofs are known only if these are numbered by nodes. Then some dofs may have no cell
  // here.
  for (NodeIndex node = 0; node < space.vertex_dof.size(); ++node)
    if (space.vertex_dof[node] != absent) nodes[space.vertex_dof[node]] = {node};
  for (const auto& group : space.groups) {
    const auto& element = group.element;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) {
      auto& row = nodes[group.dofs[k]];
      if (!row.empty()) continue;
      const std::size_t cell = k / element.n_dofs, i = k % element.n_dofs;
      for (const std::size_t v : element.vertices_around(i))
        row.push_back(group.vertices[cell * element.n_vertices + v]);
      std::sort(row.begin(), row.end());
    }
  }
  space.vertex_dof.assign(space.nodes.size(), absent);
  for (std::uint32_t dof = 0; dof < nodes.size(); ++dof) {
    space.dof_nodes.append(nodes[dof]);
    if (nodes[dof].size() == 1) space.vertex_dof[nodes[dof][0]] = dof;
  }
}

/// Finds the points of the dofs among those of the curved cells.
template <int dim>
void locate_curved_dofs(FiniteElementSpace<dim>& space) {
  auto& points = space.curved_dof_points;
  points.assign(space.n_local, absent);
  for (std::uint32_t dof = 0; dof < space.n_local; ++dof)
    if (space.dof_nodes[dof].size() == 1) points[dof] = space.dof_nodes[dof][0];
  for (const auto& group : space.groups) {
    const auto& element = group.element;
    for (std::size_t i = 0; i < element.n_dofs; ++i) {
      const std::size_t p = element.mapping.find(element.vertices_around(i));
      for (std::size_t cell = 0; cell < group.n_cells(); ++cell)
        points[group.dofs[cell * element.n_dofs + i]] = group.mapping_points(cell)[p];
    }
  }
  for (std::uint32_t dof = 0; dof < space.n_local; ++dof)
    if (points[dof] < space.nodes.size()) space.vertex_dof[points[dof]] = dof;
}

/// A cell of a space: its group, and its number there.
using CellOfGroup = std::pair<std::uint32_t, std::uint32_t>;

/// For each of this rank's equations the cells that contribute to it: the first one of each row,
/// and those of all rows.
template <int dim>
std::pair<std::vector<std::size_t>, std::vector<CellOfGroup>> cells_of_rows(
    const FiniteElementSpace<dim>& space) {
  const auto for_each_own = [&](const auto& visit) {
    for (std::uint32_t g = 0; g < space.groups.size(); ++g) {
      const auto& group = space.groups[g];
      for (std::size_t k = 0; k < group.dofs.size(); ++k)
        space.for_each_master(group.dofs[k], [&](std::uint32_t dof, double) {
          if (dof < space.n_own)
            visit(dof, CellOfGroup(g, static_cast<std::uint32_t>(k / group.element.n_dofs)));
        });
    }
  };
  std::vector<std::size_t> ends(space.n_own + 1, 0);
  for_each_own([&](std::uint32_t dof, const CellOfGroup&) { ++ends[dof + 1]; });
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<CellOfGroup> cells(ends.back());
  auto next = ends;
  for_each_own([&](std::uint32_t dof, const CellOfGroup& cell) { cells[next[dof]++] = cell; });
  return {std::move(ends), std::move(cells)};
}

template <int dim>
void build_pattern(FiniteElementSpace<dim>& space) {
  const auto [first, cells] = cells_of_rows(space);
  auto& [starts, columns, n_columns] = space.pattern;
  n_columns = space.n_columns;
  starts.reserve(space.n_own + 1);
  std::vector<std::uint32_t> row;
  for (std::size_t i = 0; i < space.n_own; ++i) {
    row.clear();
    for (std::size_t k = first[i]; k < first[i + 1]; ++k) {
      const auto& [g, c] = cells[k];
      const auto& group = space.groups[g];
      const auto* dofs = &group.dofs[c * group.element.n_dofs];
      for (std::size_t j = 0; j < group.element.n_dofs; ++j)
        space.for_each_master(dofs[j], [&](std::uint32_t dof, double) {
          if (dof < space.n_columns) row.push_back(dof);
        });
    }
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    columns.insert(columns.end(), row.begin(), row.end());
    starts.push_back(static_cast<int>(columns.size()));
  }
}

template <int dim>
void find_entries(FiniteElementSpace<dim>& space) {
  for (auto& group : space.groups) {
    const std::size_t n = group.element.n_dofs;
    group.entries.reserve(group.n_cells() * n * n);
    for (std::size_t first = 0; first < group.dofs.size(); first += n)
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          group.entries.push_back(space.entry(group.dofs[first + i], group.dofs[first + j]));
  }
}

}  // namespace

SparseMatrix SparsityPattern::zeros() const {
  SparseMatrix matrix(static_cast<Eigen::Index>(n_rows()), static_cast<Eigen::Index>(n_columns));
  matrix.resizeNonZeros(static_cast<Eigen::Index>(columns.size()));
  std::copy(starts.begin(), starts.end(), matrix.outerIndexPtr());
  std::copy(columns.begin(), columns.end(), matrix.innerIndexPtr());
  matrix.coeffs().setZero();
  return matrix;
}

template <int dim>
std::uint32_t FiniteElementSpace<dim>::entry(std::uint32_t row, std::uint32_t column) const {
  if (row >= n_own || column >= n_columns) return absent;
  const int* columns = pattern.columns.data();
  return static_cast<std::uint32_t>(std::lower_bound(columns + pattern.starts[row],
                                                     columns + pattern.starts[row + 1],
                                                     static_cast<int>(column)) -
                                    columns);
}

template <int dim>
std::vector<Point<dim>> FiniteElementSpace<dim>::local_coordinates(
    std::span<const Point<dim>> coordinates) const {
  if (in_parts) return {coordinates.begin(), coordinates.end()};
  std::vector<Point<dim>> of_ranks;
  of_ranks.reserve(nodes_of_ranks.size());
  for (const NodeIndex node : nodes_of_ranks) of_ranks.push_back(coordinates[node]);
  auto points = ranks.scatter(of_ranks, nodes.size());
  for (const SubstitutePoint& sum : substitute_points) points.push_back(weighted_sum(sum, points));
  return points;
}

template <int dim>
std::vector<Point<dim>> FiniteElementSpace<dim>::dof_points(
    std::span<const Point<dim>> local_coordinates) const {
  std::vector<Point<dim>> points(n_local);
  for (std::size_t dof = 0; dof < curved_dof_points.size(); ++dof)
    points[dof] = local_coordinates[curved_dof_points[dof]];
  for (std::size_t dof = curved_dof_points.size(); dof < n_local; ++dof) {
    Point<dim> sum = Point<dim>::Zero();
    for (const NodeIndex node : dof_nodes[dof]) sum += local_coordinates[node];
    points[dof] = sum / static_cast<double>(dof_nodes[dof].size());
  }
  return points;
}

template <int dim>
std::shared_ptr<const FiniteElementSpace<dim>> make_finite_element_space(
    const Mesh<dim>* mesh, int degree, const TensorPoints& tensor_points, const Ranks& ranks,
    const std::vector<std::string>& natural_groups, const NodeTies* ties, Geometry geometry) {
  if (degree != 1 && degree != 2)
    throw InputError("finite elements of degree " + std::to_string(degree) +
                     " are not available; choose 1 or 2");
  auto space = std::make_shared<FiniteElementSpace<dim>>();
  space->degree = degree;
  space->ranks = ranks;
  bool is_of_second_order = mesh != nullptr && has_curved_cells(mesh->topology(), Geometry::curved);
  ranks.broadcast(is_of_second_order);
  space->is_curved = is_of_second_order && geometry == Geometry::curved;
  const NaturalBoundary natural = number_dofs(mesh, tensor_points, natural_groups, ties, *space);
  if (space->n_free == 0)
    throw InputError(
        "no unknown is left for the finite element solution: every node of the mesh is on its "
        "boundary, so refine the mesh or use degree 2");
  std::optional<CurvedPoints<dim>> curved;
  if (space->is_curved || (degree == 2 && is_of_second_order))
    curved.emplace(mesh == nullptr ? nullptr : &mesh->topology(), *space);
  if (!space->in_parts) space->nodes_of_ranks = ranks.gather(space->nodes);
  locate_dofs(*space);
  if (space->is_curved) locate_curved_dofs(*space);
  find_natural_facets(natural, space->is_curved ? &*curved : nullptr, *space);
  build_pattern(*space);
  if (!space->in_parts) find_entries(*space);
  return space;
}

template struct FiniteElementSpace<2>;
template struct FiniteElementSpace<3>;
template std::shared_ptr<const FiniteElementSpace<2>> make_finite_element_space(
    const Mesh<2>*, int, const TensorPoints&, const Ranks&, const std::vector<std::string>&,
    const NodeTies*, Geometry);
template std::shared_ptr<const FiniteElementSpace<3>> make_finite_element_space(
    const Mesh<3>*, int, const TensorPoints&, const Ranks&, const std::vector<std::string>&,
    const NodeTies*, Geometry);

}  // namespace smoothfem
