// SPDX-License-Identifier: GPL-3.0-or-later
// The catalogue of domains, to which the files in meshes/domains/ register themselves.
#include <algorithm>
#include <stdexcept>

#include "meshes/domains/catalogue.h"
#include "meshes/tests/mesh_tests.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;

TEST(Domains, AllAreRegisteredAndSortedByName) {
  std::vector<std::string> names;
  for (const Domain& domain : domains()) names.push_back(domain.name);
  EXPECT_THAT(names, ::testing::ElementsAre("aorta", "axle", "bridge", "car", "cube", "fichera",
                                            "flange", "gear", "l-shape", "nonuniform-grid",
                                            "nonuniform-grid-sinh", "nonuniform-grid-z", "piston",
                                            "plate", "prosthesis", "pump", "random-planar", "ring",
                                            "roof", "sphere", "square", "subdivision", "sweep"));
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
}

}  // namespace
}  // namespace smoothfem
