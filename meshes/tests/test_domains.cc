// SPDX-License-Identifier: GPL-3.0-or-later
// The catalogue of domains, to which the files in meshes/domains/ register themselves.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <stdexcept>

#include "meshes/domains/catalogue.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/second_order/curved_quality.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Domains, AllAreRegisteredAndSortedByName) {
  std::vector<std::string> names;
  for (const Domain& domain : domains()) names.push_back(domain.name);
  EXPECT_THAT(
      names, ::testing::ElementsAre(
                 "aorta", "axle", "ball", "beam", "blade", "bracket", "bracket-plate", "bridge",
                 "car", "channel", "comb", "crack", "cube", "cube-halves", "disc", "drill", "elbow",
                 "fichera", "flange", "gear", "heat-sink", "holed-plate", "hook", "kershaw",
                 "kershaw-cube", "l-shape", "lake", "nonuniform-grid", "nonuniform-grid-sinh",
                 "nonuniform-grid-z", "piston", "plate", "prosthesis", "pump", "random-planar",
                 "ring", "roof", "sheet", "sphere", "square", "square-disc", "square-halves",
                 "star", "subdivision", "sweep", "washer", "wing"));
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

/// Area or volume by formula, and the number of nodes, which is about 100,000 at edge scale 1.
TEST(Domains, OfShapesHaveTheirSizes) {
  constexpr double pi = std::numbers::pi;
  const auto expect_size = [](const std::string& name, double edge_scale, double size) {
    for (const auto& elements : find_domain(name).elements) {
      SCOPED_TRACE(name + " of " + elements);
      std::visit(
          [&](const auto& mesh) {
            double sum = 0.0;
            for (CellIndex c = 0; c < mesh.n_cells(); ++c) sum += signed_cell_size(mesh, c);
            EXPECT_NEAR(sum, size, 0.04 * size);  // chords of coarse circles
            const int dimension = mesh.topology().dimension();
            const double n_nodes = 1e5 / std::pow(edge_scale, dimension);
            EXPECT_GT(static_cast<double>(mesh.n_nodes()), 0.7 * n_nodes);
            EXPECT_LT(static_cast<double>(mesh.n_nodes()), 3.0 * n_nodes);
          },
          find_domain(name).generate({.elements = elements, .edge_scale = edge_scale}));
    }
  };
  constexpr double planar = 10.0, solid = 4.0;
  expect_size("disc", planar, pi);
  expect_size("washer", planar, pi * (1.0 - 0.36));
  expect_size("crack", planar, pi * 345.0 / 360.0);
  expect_size("star", planar, 5.0 * 0.45 * std::sin(pi / 5.0));
  expect_size("comb", planar, 0.4 * (6 * 0.15 + 5 * 0.35) + 6 * 0.15 * 1.2);
  expect_size("channel", planar, 8.0 * 0.4);
  constexpr double l = 4.0 * 1.2 + 1.2 * 1.8 + 0.25 * (1.0 - pi / 4.0);
  constexpr double holes = pi * (0.35 * 0.35 + 0.3 * 0.3 + 0.25 * 0.25 + 0.15 * 0.15) + 0.3;
  expect_size("bracket", planar, l - holes);
  expect_size("bracket-plate", solid, 0.8 * (l - holes));
  expect_size("heat-sink", solid, 1.5 * (0.4 * (6 * 0.35 + 5 * 0.35) + 6 * 0.35 * 1.2));
  expect_size("sheet", solid, 3.0 * 8.0 * 0.8);
  expect_size("elbow", solid, pi * (1.0 - 0.36) * 3.0 * pi / 2.0);  // Pappus
  expect_size("hook", solid, pi * 0.25 * 1.5 * 4.0 / 3.0 * pi);
  expect_size("drill", solid, 3.0 * 5.0 * 0.45 * std::sin(pi / 5.0));
  // Sections shrink to 0.6 linearly: the mean of their squared scales is (1 + 0.6 + 0.36) / 3.
  expect_size("blade", solid, 2.0 * (1.0 + 0.6 + 0.36) / 3.0 * 0.6809 * 0.3);
}

/// The wing, the plate with a hole and the lake; a square less 0.6809 times the thickness for the
/// section of a wing (the integral of its formula).
TEST(Domains, OfGradedShapesHaveSmallEdgesInside) {
  for (const auto& [name, size] : {std::pair{"wing", 6.0 - 0.6809 * 0.12},
                                   std::pair{"holed-plate", 4.0 - 0.01 * std::numbers::pi}}) {
    const auto mesh = std::get<PlanarMesh>(find_domain(name).generate({.edge_scale = 12.0}));
    double sum = 0.0, least = 1.0, largest = 0.0;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
      const double area = signed_cell_size(mesh, c);
      sum += area;
      least = std::min(least, area);
      largest = std::max(largest, area);
    }
    EXPECT_NEAR(sum, size, 0.01 * size);
    EXPECT_GT(largest, 10.0 * least);
  }
}

TEST(Domains, HaveAlgorithmsThatMakeOtherMeshes) {
  for (const auto& [name, scale] : {std::pair{"disc", 16.0}, std::pair{"hook", 8.0}}) {
    const Domain& domain = find_domain(name);
    const auto& [elements, algorithms] = *domain.algorithms.begin();
    std::set<std::vector<double>> meshes;
    for (const auto& algorithm : algorithms)
      std::visit(
          [&](const auto& mesh) {
            auto& last = mesh.coordinates().back();
            meshes.insert({static_cast<double>(mesh.n_nodes()), last[0], last[1]});
          },
          domain.generate({.elements = elements, .edge_scale = scale, .algorithm = algorithm}));
    EXPECT_EQ(meshes.size(), algorithms.size());
    EXPECT_GT(algorithms.size(), 1u);
    EXPECT_THAT([&] { domain.generate({.elements = elements, .algorithm = "fronta"}); },
                ThrowsMessage<InputError>(HasSubstr("has no algorithm 'fronta'")));
    EXPECT_THAT([&] { domain.generate({.elements = domain.elements.back(), .algorithm = "hxt"}); },
                ThrowsMessage<InputError>(HasSubstr("have no choice of algorithms")));
  }
  EXPECT_EQ(find_domain("hook").offers(), "tetrahedra by delaunay, hxt, netgen; hexahedra");
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
  using Case = std::pair<std::string, double>;  // with the edge scale
  for (const auto& [name, edge_scale] :
       {Case("gear", 3.0), Case("random-planar", 2.0), Case("sphere", 1.0), Case("prosthesis", 1.0),
        Case("subdivision", 1.0), Case("nonuniform-grid", 1.0), Case("sweep", 1.0),
        Case("ring", 1.0)}) {
    const Domain& domain = find_domain(name);
    for (const auto& elements : domain.elements) {
      SCOPED_TRACE(name + " of " + elements);
      const AnyMesh one = domain.generate(
                        {.elements = elements, .edge_scale = edge_scale, .seed = 1}),
                    other = domain.generate(
                        {.elements = elements, .edge_scale = edge_scale, .seed = 2});
      EXPECT_EQ(numbers_of(one) != numbers_of(other) || cells_of_any(one) != cells_of_any(other),
                domain.is_random(elements));
    }
  }
}

/// Areas and volumes by formulas. Midside nodes on the true boundary leave an error of order 4.
TEST(Domains, OfSecondOrderHaveNodesOnTheTrueBoundary) {
  constexpr double pi = std::numbers::pi;
  const auto expect_size = [](const std::string& name, double edge_scale, double size,
                              double accuracy) {
    const Domain& domain = find_domain(name);
    for (const auto& elements : domain.elements) {
      SCOPED_TRACE(name + " of " + elements);
      const DomainParameters parameters{.elements = elements, .edge_scale = edge_scale};
      const auto linear = domain.generate(parameters);
      std::visit(
          [&]<int dim, int spacedim>(const Mesh<dim, spacedim>& mesh) {
            if constexpr (dim == spacedim) {
              EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
              const auto sizes = curved_cell_sizes(mesh);
              EXPECT_NEAR(std::accumulate(sizes.begin(), sizes.end(), 0.0) / size, 1.0, accuracy);
            }
          },
          domain.of_second_order(linear, parameters).mesh);
    }
  };
  expect_size("square", 24.0, 1.0, 1e-14);
  expect_size("disc", 10.0, pi, 1e-6);
  expect_size("washer", 10.0, 0.64 * pi, 1e-6);
  expect_size("ball", 8.0, 4.0 / 3.0 * pi, 2e-3);
  const double bolts = 8.0 * 0.8 * 0.8, flange = 4.0 * (64.0 - bolts) + 5.0 * 16.0 - 9.0 * 2.25;
  expect_size("flange", 4.0, pi * flange, 1e-3);
}

TEST(Domains, OfSecondOrderSayWhatTheyRepair) {
  const Domain& gear = find_domain("gear");
  const DomainParameters parameters{.elements = "triangles", .edge_scale = 3.0};
  EXPECT_GT(gear.of_second_order(gear.generate(parameters), parameters).report.n_repaired, 0u);
  EXPECT_THAT(input_error_of([] { find_domain("roof").require_second_order(); }),
              HasSubstr("the domain 'roof' has no meshes of second order; these have: ball, "));
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
