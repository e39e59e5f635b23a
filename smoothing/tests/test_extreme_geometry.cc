// SPDX-License-Identifier: GPL-3.0-or-later
/// Tests geometry formulas at sizes near the limits of floating point, far from the origin, and on
/// thin cells.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "smoothing/geometry/cell_size.h"
#include "smoothing/geometry/extreme_size.h"
#include "smoothing/quality/dihedral_angles.h"
#include "smoothing/quality/hexahedron_mapping.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/quality/warpage.h"
#include "smoothing/surface/surface_constraints.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using test::box_mesh;
using test::BoxCells;
using test::distorted_meshes;

/// All numbers of a mesh; sizes as lengths.
template <int dim>
std::vector<double> numbers_of(const Mesh<dim>& mesh) {
  std::vector<double> numbers = cell_mean_ratios(mesh);
  const AngleRange angles = angle_range(mesh);
  numbers.insert(numbers.end(), {angles.min, angles.max});
  if constexpr (dim == 3) {
    const MeshWarpage warpage = mesh_warpage(mesh);
    numbers.insert(numbers.end(), {warpage.max, warpage.mean});
  }
  return numbers;
}

template <int dim>
void expect_same_numbers_at_every_size() {
  for (const auto& [name, mesh] : distorted_meshes<dim>())
    for (const int exponent : {-332, -200, -101, -99, 99, 101, 200, 332}) {  // 1e-100 to 1e100
      Mesh<dim> scaled = mesh;
      scale_by_power_of_two(scaled.coordinates(), exponent);
      const auto here = numbers_of(mesh), there = numbers_of(scaled);
      ASSERT_EQ(here.size(), there.size());
      for (std::size_t i = 0; i < here.size(); ++i)
        EXPECT_NEAR(there[i], here[i], 1e-13 * std::abs(here[i]))
            << name << ' ' << exponent << ' ' << i;
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        EXPECT_NEAR(std::ldexp(signed_cell_size(scaled, c), -dim * exponent),
                    signed_cell_size(mesh, c), 1e-14);
    }
}
TEST(ExtremeGeometry, PlanarNumbersDoNotDependOnTheSize) {
  expect_same_numbers_at_every_size<2>();
}
TEST(ExtremeGeometry, VolumeNumbersDoNotDependOnTheSize) {
  expect_same_numbers_at_every_size<3>();
}

TEST(ExtremeGeometry, SurfaceNumbersDoNotDependOnTheSize) {
  const std::vector<Point<3>> x = {{0, 0, 0}, {1, 0, 0.2}, {1, 1, 0}, {0, 1.2, 0.1}};
  const auto quality_and_size = [&](int exponent) {
    std::vector<Point<3>> scaled = x;
    scale_by_power_of_two(std::span(scaled), exponent);
    const SurfaceMesh mesh = make_surface_mesh(test::rows_of({{0, 1, 2, 3}}), scaled);
    return std::pair(cell_mean_ratios(mesh)[0],
                     std::ldexp(signed_cell_size(mesh, 0), -2 * exponent));
  };
  const auto [quality, size] = quality_and_size(0);
  EXPECT_GT(quality, 0.5);
  for (const int exponent : {-332, -200, 200, 332}) {
    const auto [scaled_quality, scaled_size] = quality_and_size(exponent);
    EXPECT_NEAR(scaled_quality, quality, 1e-14) << exponent;
    EXPECT_NEAR(scaled_size, size, 1e-14) << exponent;
  }
}

/// Coordinates that keep nine digits of a cell's size give results with about eight digits.
template <int dim>
void expect_same_numbers_far_from_the_origin() {
  const Point<dim> far = Point<dim>::LinSpaced(1e7, -2e7);
  for (auto& [name, mesh] : distorted_meshes<dim>()) {
    for (auto& p : mesh.coordinates()) p = (p + far) - far;  // rounded as at that distance
    Mesh<dim> moved = mesh;
    for (auto& p : moved.coordinates()) p += far;
    const auto here = numbers_of(mesh), there = numbers_of(moved);
    for (std::size_t i = 0; i < here.size(); ++i) EXPECT_NEAR(there[i], here[i], 1e-12) << i;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      EXPECT_NEAR(signed_cell_size(moved, c), signed_cell_size(mesh, c), 1e-14) << c;
  }
}
TEST(ExtremeGeometry, PlanarNumbersAreTheSameFarFromTheOrigin) {
  expect_same_numbers_far_from_the_origin<2>();
}
TEST(ExtremeGeometry, VolumeNumbersAreTheSameFarFromTheOrigin) {
  expect_same_numbers_far_from_the_origin<3>();
}

/// Tests a rectangle, a right triangle, a box and a tetrahedron, each thin by h, with hand-computed
/// qualities.
TEST(ExtremeGeometry, ThinCells) {
  for (const double h : {1e-3, 1e-6}) {
    const auto planar = [&](std::vector<Point<2>> x) {
      std::vector<NodeIndex> cell(x.size());
      std::iota(cell.begin(), cell.end(), 0U);
      return PlanarMesh(std::make_shared<const Topology>(2, x.size(), test::rows_of({cell})), x);
    };
    const auto relative = [](double number, double expected) {
      return std::abs(number / expected - 1.0);
    };
    const PlanarMesh rectangle = planar({{0, 0}, {1, 0}, {1, h}, {0, h}});
    EXPECT_LT(relative(cell_mean_ratios(rectangle)[0], 2.0 * h / (1.0 + h * h)), 1e-14);
    EXPECT_LT(relative(signed_cell_size(rectangle, 0), h), 1e-14);
    // q = 4 sqrt(3) area / (sum of squared sides).
    const PlanarMesh triangle = planar({{0, 0}, {1, 0}, {0, h}});
    EXPECT_LT(relative(cell_mean_ratios(triangle)[0], std::sqrt(3.0) * h / (1.0 + h * h)), 1e-14);
    EXPECT_LT(relative(angle_range(triangle).min, std::atan(h) * 180.0 / std::numbers::pi), 1e-14);
    VolumeMesh box = box_mesh(1, 1, 1, BoxCells::hexahedra);
    for (auto& p : box.coordinates()) p.z() *= h;
    EXPECT_LT(relative(cell_mean_ratios(box)[0], 3.0 * std::cbrt(h * h) / (2.0 + h * h)), 1e-14);
    EXPECT_LT(relative(signed_cell_size(box, 0), h), 1e-14);
    EXPECT_EQ(mesh_warpage(box).max, 0.0);
    EXPECT_NEAR(angle_range(box).min, 90.0, 1e-12);
  }
}

/// Beyond the limits of floating point a quality may be zero, but never NaN nor outside of [0, 1].
TEST(ExtremeGeometry, QualitiesStayInTheirRange) {
  for (const double size : {1e-320, 1e-200, 1e-160, 1e160, 1e200, 1e307}) {
    for (auto& [name, mesh] : distorted_meshes<2>()) {
      for (auto& p : mesh.coordinates()) p *= size;
      for (const double q : cell_mean_ratios(mesh)) EXPECT_TRUE(q >= 0.0 && q <= 1.0) << q;
    }
    for (auto& [name, mesh] : distorted_meshes<3>()) {
      for (auto& p : mesh.coordinates()) p *= size;
      for (const double q : cell_mean_ratios(mesh)) EXPECT_TRUE(q >= 0.0 && q <= 1.0) << q;
      const MeshQuality quality = mesh_quality(mesh);
      EXPECT_TRUE(quality.q_min >= 0.0 && quality.q_mean <= 1.0);
    }
  }
}

}  // namespace
}  // namespace smoothfem
