// SPDX-License-Identifier: GPL-3.0-or-later
// The catalogue of domains, to which the files in meshes/domains/ register themselves.
#include <algorithm>
#include <stdexcept>

#include "meshes/domains/catalogue.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/geometry/cell_size.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;

TEST(Domains, AllAreRegisteredAndSortedByName) {
  std::vector<std::string> names;
  for (const Domain& domain : domains()) names.push_back(domain.name);
  EXPECT_THAT(
      names, ::testing::ElementsAre(
                 "aorta", "axle", "bridge", "car", "cube", "cube-halves", "fichera", "flange",
                 "gear", "l-shape", "nonuniform-grid", "nonuniform-grid-sinh", "nonuniform-grid-z",
                 "piston", "plate", "prosthesis", "pump", "random-planar", "ring", "roof", "sphere",
                 "square", "square-disc", "square-halves", "subdivision", "sweep"));
}

TEST(Domains, HaveDescriptions) {
  for (const Domain& domain : domains()) {
    SCOPED_TRACE(domain.name);
    EXPECT_FALSE(domain.description.empty());
    EXPECT_TRUE(domain.dimension == 2 || domain.dimension == 3);
    EXPECT_FALSE(domain.elements.empty());
    for (const auto& elements : domain.elements)
      EXPECT_THAT(element_names(), ::testing::Contains(elements));
    EXPECT_EQ(domain.elements_named(""), domain.elements.front());
    EXPECT_EQ(domain.elements_named(domain.elements.back()), domain.elements.back());
    EXPECT_EQ(&find_domain(domain.name), &domain);
  }
}

/// Domains of two materials: every node between groups stays and lies on the interface.
TEST(Domains, OfTwoMaterialsHaveGroupsUpToTheInterface) {
  const auto expect_interface = [](const std::string& name, const std::string& elements,
                                   double first_size, const auto& distance) {
    SCOPED_TRACE(name + " of " + elements);
    std::visit(
        [&]<int dim, int spacedim>(const Mesh<dim, spacedim>& mesh) {
          const Topology& topology = mesh.topology();
          const auto& tags = topology.labels().cell_tags;
          ASSERT_EQ(tags.size(), mesh.n_cells());
          double size_of_first = 0.0;
          for (CellIndex c = 0; c < mesh.n_cells(); ++c)
            if (tags[c] == 1) size_of_first += signed_cell_size(mesh, c);
          EXPECT_NEAR(size_of_first, first_size, 0.01);
          std::size_t n_between = 0;
          for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
            bool has_first = false, has_second = false;
            for (const CellIndex c : topology.node_cells(i))
              (tags[c] == 1 ? has_first : has_second) = true;
            const bool between = has_first && has_second;
            n_between += between;
            EXPECT_EQ(topology.is_fixed(i), between || topology.on_boundary()[i]);
            if (between) {
              EXPECT_LT(distance(mesh.coordinates()[i]), 1e-12);
            }
          }
          EXPECT_GT(n_between, 8U);
        },
        find_domain(name).generate({.elements = elements, .edge_scale = 4.0}));
  };
  const auto from_plane = [](const auto& p) { return std::abs(p.x() - 0.5); };
  expect_interface("square-halves", "triangles", 0.5, from_plane);
  expect_interface("square-halves", "quadrilaterals", 0.5, from_plane);
  expect_interface("cube-halves", "tetrahedra", 0.5, from_plane);
  expect_interface("cube-halves", "hexahedra", 0.5, from_plane);
  expect_interface("square-disc", "triangles", 0.28274, [](const auto& p) {
    return std::abs(std::hypot(p.x() - 0.5, p.y() - 0.5) - 0.3);
  });
}

/// Coordinates of all nodes.
std::vector<double> numbers_of(const AnyMesh& mesh) {
  std::vector<double> numbers;
  std::visit(
      [&](const auto& any) {
        for (const auto& point : any.coordinates())
          numbers.insert(numbers.end(), point.data(), point.data() + point.size());
      },
      mesh);
  return numbers;
}
std::vector<NodeIndex> cells_of_any(const AnyMesh& mesh) {
  return std::visit([](const auto& any) { return any.topology().cells().entries(); }, mesh);
}

/// Domains that take long to mesh are not random; they are left out.
TEST(Domains, KnowWhichElementsTheSeedChanges) {
  for (const std::string name : {"gear", "random-planar", "sphere", "prosthesis", "subdivision",
                                 "nonuniform-grid", "sweep", "ring"}) {
    const Domain& domain = find_domain(name);
    for (const auto& elements : domain.elements) {
      SCOPED_TRACE(name + " of " + elements);
      const AnyMesh one = domain.generate({.elements = elements, .seed = 1}),
                    other = domain.generate({.elements = elements, .seed = 2});
      EXPECT_EQ(numbers_of(one) != numbers_of(other) || cells_of_any(one) != cells_of_any(other),
                domain.is_random(elements));
    }
  }
}

TEST(Domains, UnknownNamesAreRefusedWithTheNearestName) {
  EXPECT_THAT(
      input_error_of([] { find_domain("gaer"); }),
      HasSubstr("there is no domain 'gaer'; did you mean 'gear'? choose one of aorta, axle"));
  EXPECT_THAT(input_error_of([] { find_domain("bolt"); }),
              HasSubstr("there is no domain 'bolt'; choose one of aorta, axle"));
  EXPECT_THAT(input_error_of([] { find_domain("gear").generate({.elements = "hexahedra"}); }),
              HasSubstr("the domain 'gear' has no mesh of 'hexahedra'; choose one of triangles, "
                        "quadrilaterals"));
  EXPECT_THAT(input_error_of([] { find_domain("flange").generate({.elements = "hex"}); }),
              HasSubstr("did you mean 'hexahedra'?"));
}

}  // namespace
}  // namespace smoothfem
