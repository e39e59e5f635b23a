#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/indexed_min_heap.h"
#include "smoothing/loop/invalid_node_reset.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem {
namespace {

using testing::HasSubstr;

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(Parameters, AreSetWithinTheirRanges) {
  double share = 0.25;
  int count = 3;
  const Parameters parameters{{"share", "", &share, 0.0, 1.0}, {"count", "", &count, 1.0, 10.0}};
  const auto set = [&](const std::string& name, const std::string& value) {
    set_value(find_parameter(parameters, name, "test"), value, "test");
  };
  set("share", "1e-3");
  set("count", "10");
  EXPECT_EQ(share, 1e-3);
  EXPECT_EQ(count, 10);
  EXPECT_THAT(message_of([&] { set("share", "1.5"); }), HasSubstr("outside its range [0, 1]"));
  EXPECT_THAT(message_of([&] { set("share", "nan"); }), HasSubstr("outside its range"));
  EXPECT_THAT(message_of([&] { set("share", "1x"); }), HasSubstr("needs a number"));
  EXPECT_THAT(message_of([&] { set("share", ""); }), HasSubstr("needs a number"));
  EXPECT_THAT(message_of([&] { set("count", "2.5"); }), HasSubstr("needs a whole number"));
  EXPECT_THAT(message_of([&] { set("shares", "1"); }), HasSubstr("it has share, count"));
  EXPECT_EQ(share, 1e-3) << "a refused value must not stick";
}

TEST(Parameters, TextReadsBackAsTheSameValue) {
  double value = 0.1 + 0.2;
  const Parameter parameter{"value", "", &value};
  const std::string text = value_text(parameter);
  value = 0.0;
  set_value(parameter, text, "test");
  EXPECT_EQ(value, 0.1 + 0.2);
}

TEST(Catalogue, HasTheBuiltInMethodsAndNamesThemInErrors) {
  for (const std::string name :
       {"getme", "getme-sequential", "getme-simultaneous", "global-optimization", "laplace",
        "smart-laplace", "weighted-laplace"})
    EXPECT_FALSE(make_method(name).stages.empty()) << name;
  EXPECT_THAT(message_of([] { make_method("getmee"); }),
              HasSubstr("there is no method 'getmee'; choose one of getme, "));
}

TEST(Catalogue, DefaultsLieInTheirRangesAndAreDocumented) {
  for (const auto& info : method_catalogue()) {
    Method method = make_method(info.name);
    for (const auto& parameter : method.parameters()) {
      EXPECT_FALSE(parameter.description.empty()) << info.name << ' ' << parameter.name;
      EXPECT_NO_THROW(method.set(parameter.name, value_text(parameter)))
          << info.name << ' ' << parameter.name;
    }
  }
}

TEST(Catalogue, StagesNameTheirParameters) {
  Method getme = make_method("getme");
  EXPECT_NO_THROW(getme.set("sequential.rho", "0.02"));
  EXPECT_THAT(message_of([&] { getme.set("rho", "0.02"); }), HasSubstr("simultaneous.rho"));
}

TEST(IndexedMinHeap, PicksLikeASortedSet) {
  constexpr std::uint32_t n = 200;
  test::Random random(1);
  std::vector<double> keys(n);
  std::vector<std::uint32_t> members;
  std::set<std::pair<double, std::uint32_t>> oracle;
  for (std::uint32_t i = 0; i < n; ++i) {
    keys[i] = std::floor(8.0 * random());  // many ties
    if (i % 3 == 0) continue;
    members.push_back(i);
    oracle.emplace(keys[i], i);
  }
  IndexedMinHeap heap;
  heap.build(keys, members);
  EXPECT_FALSE(heap.contains(0));
  for (int step = 0; step < 5000; ++step) {
    ASSERT_EQ(heap.top(), oracle.begin()->second) << step;
    // Now and then the top itself, as the sequential method does.
    const auto random_member = static_cast<std::size_t>(0.5 * (random() + 1.0) * members.size());
    const std::uint32_t number = step % 2 ? heap.top() : members[random_member];
    oracle.erase({keys[number], number});
    keys[number] = std::floor(8.0 * random());
    oracle.emplace(keys[number], number);
    heap.update(number, keys[number]);
  }
}

TEST(IndexedMinHeap, CanBeEmpty) {
  IndexedMinHeap heap;
  heap.build({1.0, 2.0}, {});
  EXPECT_TRUE(heap.empty());
}

TEST(InvalidNodeReset, PutsBackUntilAllIsValid) {
  const auto valid = test::grid_mesh(6, test::GridCells::triangles);
  auto mesh = valid;
  test::Random random(5);
  for (const NodeIndex i : mesh.topology().free_nodes()) {
    const double dx = random(), dy = random();
    mesh.coordinates()[i] += Point<2>(dx, dy);
  }
  auto quality = cell_mean_ratios(mesh);
  ASSERT_GT(mesh_quality(mesh).n_invalid, 0u);
  const auto n_reset = reset_nodes_of_invalid_cells(mesh, valid.coordinates(), quality);
  EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
  EXPECT_EQ(quality, cell_mean_ratios(mesh)) << "quality must be kept up to date";
  std::size_t n_back = 0;
  for (const NodeIndex i : mesh.topology().free_nodes())
    n_back += mesh.coordinates()[i] == valid.coordinates()[i];
  EXPECT_EQ(n_reset, n_back);
  EXPECT_LT(n_back, mesh.topology().free_nodes().size()) << "nodes of valid cells stay moved";
}

TEST(InvalidNodeReset, LeavesValidMeshesAlone) {
  auto mesh = test::grid_mesh(3, test::GridCells::quadrilaterals);
  const auto previous = mesh.coordinates();
  mesh.coordinates()[5] += Point<2>(0.1, 0.1);
  const auto moved = mesh.coordinates();
  auto quality = cell_mean_ratios(mesh);
  EXPECT_EQ(reset_nodes_of_invalid_cells(mesh, previous, quality), 0u);
  EXPECT_EQ(mesh.coordinates(), moved);
}

TEST(InvalidNodeReset, EndsWhenThePreviousMeshWasInvalidToo) {
  auto mesh = test::grid_mesh(2, test::GridCells::quadrilaterals);
  mesh.coordinates()[4] = {5.0, 5.0};
  const auto tangled = mesh.coordinates();
  auto quality = cell_mean_ratios(mesh);
  EXPECT_EQ(reset_nodes_of_invalid_cells(mesh, tangled, quality), 0u);
}

}  // namespace
}  // namespace smoothfem
