// SPDX-License-Identifier: GPL-3.0-or-later
// Kershaw's mesh: nodes computed manually, valid cells, and eps out of range.
#include <cmath>
#include <limits>

#include "meshes/domains/catalogue.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

template <int dim>
Mesh<dim> kershaw(const DomainParameters& parameters) {
  return std::get<Mesh<dim>>(
      find_domain(dim == 2 ? "kershaw" : "kershaw-cube").generate(parameters));
}

template <int dim>
double size_of(const Mesh<dim>& mesh) {
  double sum = 0.0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) sum += signed_cell_size(mesh, c);
  return sum;
}

/// With 6 cells on each side the nodes lie between layers; eps = 0.3.
TEST(Kershaw, HasNodesByItsFormula) {
  const auto mesh = kershaw<2>({.elements = "quadrilaterals", .edge_scale = 8.0, .eps = 0.3});
  ASSERT_EQ(mesh.n_nodes(), 49u);
  // The lower half is small at x = 0, 1/6, 2/3; the upper half at 1/3, 5/6, 1; both are equal in
  // the middle.
  const double sixth_below = 0.3 / 6.0, sixth_above = 1.7 / 6.0;
  const double two_thirds_below = 1.0 - 1.7 / 3.0, two_thirds_above = 1.0 - 0.3 / 3.0;
  const double lower[] = {sixth_below, sixth_below, sixth_above, 1.0 / 6.0,
                          sixth_below, sixth_above, sixth_above};
  const double upper[] = {two_thirds_below, two_thirds_below, two_thirds_above, 2.0 / 3.0,
                          two_thirds_below, two_thirds_above, two_thirds_above};
  for (std::size_t i = 0; i < 7; ++i) {
    const auto& low = mesh.coordinates()[i + 7];
    const auto& high = mesh.coordinates()[i + 4 * 7];
    EXPECT_NEAR(low.x(), static_cast<double>(i) / 6.0, 1e-15);
    EXPECT_NEAR(low.y(), lower[i], 1e-14) << i;
    EXPECT_NEAR(high.y(), upper[i], 1e-14) << i;
  }
  EXPECT_NEAR(size_of(mesh), 1.0, 1e-14);
}

/// With 12 cells there are nodes in the middle of layers.
TEST(Kershaw, GoesSmoothlyFromLayerToLayer) {
  const auto mesh = kershaw<2>({.elements = "triangles", .edge_scale = 4.0, .eps = 0.3});
  ASSERT_EQ(mesh.n_nodes(), 169u);
  EXPECT_EQ(mesh.n_cells(), 288u);
  const auto y_at = [&](std::size_t i) { return mesh.coordinates()[i + 13 * 2].y(); };
  const double low = 0.05, high = 1.7 / 6.0;
  constexpr double quarter = 0.103515625;  // the step at 1/4
  EXPECT_NEAR(y_at(1), low, 1e-14);
  EXPECT_NEAR(y_at(3), 0.5 * (low + high), 1e-14);
  EXPECT_NEAR(y_at(5), high + (low - high) * quarter, 1e-14);
  EXPECT_NEAR(y_at(7), low + (high - low) * quarter, 1e-14);
  EXPECT_NEAR(y_at(9), 0.5 * (low + high), 1e-14);
  EXPECT_NEAR(y_at(11), high, 1e-14);
}

TEST(Kershaw, MovesInSpaceInBothDirections) {
  for (const std::string elements : {"hexahedra", "tetrahedra"}) {
    const auto mesh = kershaw<3>({.elements = elements, .edge_scale = 4.0, .eps = 0.5});
    ASSERT_EQ(mesh.n_nodes(), 343u);
    EXPECT_EQ(mesh.n_cells(), elements == "hexahedra" ? 216u : 6u * 216u);
    const auto& at =
        mesh.coordinates()[2 + 7 * 1 + 49 * 4];  // x = 1/3, where the upper half is small
    EXPECT_NEAR(at.y(), 1.5 / 6.0, 1e-14);
    EXPECT_NEAR(at.z(), 1.0 - 0.5 / 3.0, 1e-14);
    EXPECT_NEAR(size_of(mesh), 1.0, 1e-13);
  }
}

TEST(Kershaw, IsUniformForEpsOne) {
  const auto planar = kershaw<2>({.elements = "quadrilaterals", .edge_scale = 8.0, .eps = 1.0});
  EXPECT_NEAR(mesh_quality(planar).q_min, 1.0, 1e-12);
  const auto volume = kershaw<3>({.elements = "hexahedra", .edge_scale = 4.0, .eps = 1.0});
  EXPECT_NEAR(mesh_quality(volume).q_min, 1.0, 1e-12);
}

TEST(Kershaw, IsValidAndWorseForSmallEps) {
  for (const std::string name : {"kershaw", "kershaw-cube"})
    for (const auto& elements : find_domain(name).elements) {
      double least = 1.0;
      for (const double eps : {1.0, 0.3, 0.1}) {
        const AnyMesh mesh = find_domain(name).generate({.elements = elements, .eps = eps});
        const double q_min = std::visit([](const auto& m) { return mesh_quality(m).q_min; }, mesh);
        EXPECT_GT(q_min, 0.0) << name << " " << elements << " " << eps;
        if (eps < 1.0) {
          EXPECT_LT(q_min, least);
        }
        least = q_min;
      }
    }
}

TEST(Kershaw, RefusesEpsOutOfRange) {
  for (const double eps : {0.0, -0.3, 1.01, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THAT([&] { find_domain("kershaw").generate({.eps = eps}); },
                ThrowsMessage<InputError>(HasSubstr("eps of the domain 'kershaw' is")));
  EXPECT_THAT([] { find_domain("square").generate({.eps = 0.3}); },
              ThrowsMessage<InputError>(HasSubstr("the domain 'square' has no eps")));
}

}  // namespace
}  // namespace smoothfem
