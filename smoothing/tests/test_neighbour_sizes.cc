// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "smoothing/geometry/cell_size.h"
#include "smoothing/getme/element_pass.h"
#include "smoothing/getme/neighbour_sizes.h"
#include "smoothing/getme/regularize.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using test::box_mesh;
using test::BoxCells;
using test::distorted_meshes;
using test::grid_mesh;
using test::GridCells;

template <int dim>
double fitting_size(const Mesh<dim>& mesh, CellIndex cell) {
  NeighbourSizes<dim> sizes;
  sizes.update(mesh);
  return sizes.of(mesh.topology().cell_nodes(cell));
}

/// Computes the expected sizes from another formula: size(mesh, cell).
template <int dim, class Size>
void expect_means_of(const Mesh<dim>& mesh, const Size& size) {
  const Topology& topology = mesh.topology();
  NeighbourSizes<dim> sizes;
  sizes.update(mesh);
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    double sum = 0.0;
    for (const NodeIndex i : topology.cell_nodes(c)) {
      double at_node = 0.0;
      std::size_t n_around = 0;
      for (CellIndex other = 0; other < mesh.n_cells(); ++other)
        if (std::ranges::count(topology.cell_nodes(other), i) > 0) {
          at_node += size(mesh, other);
          ++n_around;
        }
      sum += at_node / static_cast<double>(n_around);
    }
    const double expected = sum / static_cast<double>(topology.cell_nodes(c).size());
    EXPECT_NEAR(sizes.of(topology.cell_nodes(c)), expected, 1e-13 * expected) << c;
  }
}

/// Every node simplex of a triangle or tetrahedron is the cell; those of a quadrilateral add up to
/// twice its area.
TEST(NeighbourSizes, AreMeansOfAreasAndVolumes) {
  const auto twice_area = [](const auto& mesh, CellIndex c) {
    return 2.0 * signed_cell_size(mesh, c);
  };
  const auto area = [](const auto& mesh, CellIndex c) { return signed_cell_size(mesh, c); };
  const auto six_volumes = [](const auto& mesh, CellIndex c) {
    return 6.0 * signed_cell_size(mesh, c);
  };
  auto triangles = grid_mesh(7, GridCells::triangles);
  test::distort(triangles, 0.25, 5);
  expect_means_of(triangles, twice_area);
  auto quadrilaterals = grid_mesh(7, GridCells::quadrilaterals);
  test::distort(quadrilaterals, 0.25, 5);
  expect_means_of(quadrilaterals, area);
  auto tetrahedra = box_mesh(3, 3, 3, BoxCells::tetrahedra);
  test::distort(tetrahedra, 0.2, 5);
  expect_means_of(tetrahedra, six_volumes);
  // a unit cube has eight corners, each with a tetrahedron of volume 1/6
  EXPECT_DOUBLE_EQ(fitting_size(box_mesh(3, 3, 3, BoxCells::hexahedra), 0), 1.0);
}

/// With edges of equal length, cells of all types have sizes of the same magnitude.
TEST(NeighbourSizes, OfCellsOfAllTypesMayBeMixed) {
  const double cube = 1.0, prism = std::sqrt(0.75), simplex = std::sqrt(0.5);
  EXPECT_NEAR(fitting_size(test::equilateral_prisms(5, 3), 0), prism, 1e-12);
  EXPECT_NEAR(prism / cube, simplex / prism, 0.06);
}

TEST(NeighbourSizes, DoNotCountSigns) {
  auto mesh = grid_mesh(4, GridCells::triangles);
  const double before = fitting_size(mesh, 0);
  for (auto& p : mesh.coordinates()) p.x() = -p.x();  // all cells turned over
  EXPECT_DOUBLE_EQ(fitting_size(mesh, 0), before);
}

template <int dim>
void expect_same_of_some_nodes() {
  for (const auto& [name, mesh] : distorted_meshes<dim>()) {
    NeighbourSizes<dim> all, some;
    all.update(mesh);
    for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
      const auto nodes = mesh.topology().cell_nodes(c);
      some.update(mesh, nodes);
      EXPECT_EQ(some.of(nodes), all.of(nodes)) << name << ' ' << c;
    }
  }
}
TEST(NeighbourSizes, OfSomeNodesAreBitwiseIdentical) {
  expect_same_of_some_nodes<2>();
  expect_same_of_some_nodes<3>();
}

TEST(NeighbourSizes, ElementsGetThePrescribedSize) {
  const std::vector<Vector2<double>> polygon{{0, 0}, {3, 0.5}, {2.5, 2}, {1, 3}, {-0.5, 1}};
  std::vector<Vector2<double>> result(polygon.size());
  const ElementRegularization<2> planar({.lambda = 0.4,
                                         .theta_degrees = 20.0,
                                         .rho = 1.0,
                                         .scaling = ElementParameters<2>::neighbour_mean_size});
  const std::span<const Vector2<double>> in(polygon), out(result);
  planar.regularize(in, std::span<Vector2<double>>(result), 7.0);
  EXPECT_NEAR(mean_node_triangle(out), 7.0, 1e-13);
  EXPECT_NEAR(length(centroid(out) - centroid(in)), 0.0, 1e-15);

  const std::array<Vector3<double>, 4> corners{{{0, 0, 0}, {2, 0, 0}, {0.5, 1, 0}, {0.3, 0.2, 1}}};
  std::array<Vector3<double>, 4> moved;
  const ElementRegularization<3> volume({.tetrahedron = {1.5, 1.5},
                                         .pyramid = {1.5, 1.5},
                                         .prism = {1.5, 1.5},
                                         .hexahedron = {1.5, 1.5},
                                         .rho = 1.0,
                                         .scaling = ElementParameters<3>::neighbour_mean_size});
  const std::span<const Vector3<double>, 4> before(corners), after(moved);
  volume.regularize(before, std::span<Vector3<double>, 4>(moved), 7.0);
  EXPECT_NEAR(determinant(moved[1] - moved[0], moved[2] - moved[0], moved[3] - moved[0]), 7.0,
              1e-13);
  EXPECT_NEAR(length(centroid(after) - centroid(before)), 0.0, 1e-15);
}

/// After some nodes have moved, the sums around them equal those of a pass over all elements.
template <int dim>
void expect_sums_around_as_of_all(const std::string& scaling) {
  for (const auto& [name, mesh] : distorted_meshes<dim>()) {
    auto parameters = [] {
      if constexpr (dim == 2)
        return ElementParameters<2>{.lambda = 0.35, .theta_degrees = 15.0, .rho = 1.0};
      else
        return ElementParameters<3>{.tetrahedron = {1, 2},
                                    .pyramid = {1, 2},
                                    .prism = {1, 2},
                                    .hexahedron = {1, 2},
                                    .rho = 1.0};
    }();
    for (auto& parameter : parameters.parameters())
      if (parameter.name == "scaling") set_value(parameter, scaling, "the element step");
    SmoothingState<dim> state{mesh, std::vector<double>(mesh.n_cells()), {}};
    ElementPass<dim> pass, other;
    pass.prepare(mesh, parameters);
    other.prepare(mesh, parameters);
    pass.transform_all(state, 0.5);
    const NodeIndex moved = mesh.topology().free_nodes()[0];
    state.mesh.coordinates()[moved] += Point<dim>::Constant(0.03);
    for (const CellIndex c : mesh.topology().node_cells(moved))
      state.cell_quality[c] = cell_mean_ratio(state.mesh, c);
    const auto around = pass.transform_around(state, {&moved, 1}, 0.5);
    const auto all = other.transform_all(state, 0.5);
    EXPECT_EQ(around.q_mean, all.q_mean);
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
      EXPECT_EQ(pass.has_mean(i), other.has_mean(i));
      if (other.has_mean(i)) {
        EXPECT_LT((pass.mean(i) - other.mean(i)).norm(), 1e-14 * other.mean(i).norm())
            << name << ' ' << scaling << " node " << i;
      }
    }
  }
}
TEST(ElementPass, SumsAroundMovedNodesAreThoseOfAllElements) {
  for (const std::string scaling : {"mean-edge-length", "neighbour-mean-size"}) {
    expect_sums_around_as_of_all<2>(scaling);
    expect_sums_around_as_of_all<3>(scaling);
  }
}

}  // namespace
}  // namespace smoothfem
