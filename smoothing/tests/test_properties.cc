// SPDX-License-Identifier: GPL-3.0-or-later
/// Requirements for every method and for untangling on random meshes. RapidCheck makes the meshes
/// and, if a property fails, looks for a smaller mesh that fails as well.
///
/// The seed is fixed, so that every run uses the same meshes. The long tests use five times as
/// many. For other meshes:
///   RC_PARAMS="seed=7 max_success=300" smoothing_unit_test --gtest_filter='*Properties*'
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <sstream>

#include "smoothing/base/parallel.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/optimization/untangle.h"
#include "smoothing/tests/methods.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using test::box_mesh;
using test::BoxCells;
using test::grid_mesh;
using test::GridCells;

/// RapidCheck reads the variable before its first property. A value set by the user is kept.
[[maybe_unused]] const int fixed_seed = ::setenv("RC_PARAMS", "seed=20 max_success=100", 0);

/// A grid or box with random cells, size, stretch, distortion and fixed nodes. Tenths are whole
/// numbers, which shrink better than others.
template <int dim>
struct RandomMesh {
  int kind = 0;
  std::vector<std::uint32_t> n_cells;  ///< per side; dim numbers
  std::vector<int> stretch;            ///< of each axis, 1 to 10
  int distortion_tenths = 5;           ///< of a cell: the radius within which nodes move
  int fixed_tenths = 0;                ///< of the inner nodes that are fixed in addition
  std::uint64_t seed = 1;
};

template <class Number>
void print_list(std::ostream& stream, const char* name, const std::vector<Number>& numbers) {
  stream << name << " (";
  for (const Number number : numbers) stream << ' ' << number;
  stream << " ) ";
}

template <int dim>
std::ostream& operator<<(std::ostream& stream, const RandomMesh<dim>& mesh) {
  stream << "kind " << mesh.kind << ' ';
  print_list(stream, "cells", mesh.n_cells);
  print_list(stream, "stretch", mesh.stretch);
  return stream << "distortion " << mesh.distortion_tenths << "/10 fixed " << mesh.fixed_tenths
                << "/10 seed " << mesh.seed;
}

template <int dim>
Mesh<dim> regular_mesh(const RandomMesh<dim>& random) {
  const auto& n = random.n_cells;
  if constexpr (dim == 2)
    return grid_mesh(n[0], static_cast<GridCells>(random.kind));
  else
    return box_mesh(n[0], n[1], n[2], static_cast<BoxCells>(random.kind));
}

template <int dim>
Mesh<dim> stretched(Mesh<dim> mesh, const std::vector<int>& factors) {
  for (auto& p : mesh.coordinates())
    for (int d = 0; d < dim; ++d) p[d] *= factors[d];
  return mesh;
}

/// Fixes this fraction of the mesh's free nodes at their positions.
template <int dim>
Mesh<dim> with_more_fixed_nodes(Mesh<dim> mesh, int tenths, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<bool> fixed(mesh.n_nodes(), true);
  for (const NodeIndex i : mesh.topology().free_nodes()) fixed[i] = 5.0 * random() + 5.0 < tenths;
  return with_fixed_nodes(std::move(mesh), std::move(fixed));
}

/// Nodes that a strong distortion leaves in place, because their cells would not be valid, move a
/// little. In a symmetric mesh, cells of equal quality would leave the choice between them to
/// rounding. Rounding in the stretch may make a barely valid cell invalid: such meshes are
/// discarded.
template <int dim>
Mesh<dim> valid_mesh(const RandomMesh<dim>& random) {
  auto mesh = regular_mesh(random);
  test::distort(mesh, 0.1 * random.distortion_tenths, random.seed);
  for (const std::uint64_t more : {2, 3}) test::distort(mesh, 0.05, random.seed + more);
  mesh = stretched(std::move(mesh), random.stretch);
  RC_PRE(mesh_quality(mesh).n_invalid == 0u);
  return with_more_fixed_nodes(std::move(mesh), random.fixed_tenths, random.seed + 1);
}

/// Moves free nodes anywhere within some cells. Nodes are fixed before or after that; a mesh with
/// nodes fixed in a bad place may be impossible to untangle.
template <int dim>
Mesh<dim> tangled_mesh(const RandomMesh<dim>& random, bool fixed_in_place) {
  auto mesh = stretched(regular_mesh(random), random.stretch);
  const auto fix = [&] {
    mesh = with_more_fixed_nodes(std::move(mesh), random.fixed_tenths, random.seed + 1);
  };
  if (fixed_in_place) fix();
  test::Random shift(random.seed);
  for (const NodeIndex i : mesh.topology().free_nodes())
    for (int d = 0; d < dim; ++d)
      mesh.coordinates()[i][d] += 0.4 * random.distortion_tenths * random.stretch[d] * shift();
  if (!fixed_in_place) fix();
  return mesh;
}

template <int dim>
struct RandomSimilarity {
  int scale_index = 0;
  std::uint64_t seed = 1;

  double scale() const { return std::array{1e-9, 1.0, 1e9}[scale_index]; }
  /// Turns a mesh by any angle and moves it by up to 30 cells.
  Mesh<dim> operator()(Mesh<dim> mesh) const {
    test::Random random(seed);
    Eigen::Matrix<double, dim, dim> turned;
    const double angle = std::numbers::pi * random();
    if constexpr (dim == 2)
      turned = Eigen::Rotation2Dd(angle).toRotationMatrix();
    else
      turned = Eigen::AngleAxisd(angle, Point<3>(1.0, random(), random()).normalized());
    Point<dim> shift;
    for (int d = 0; d < dim; ++d) shift[d] = 30.0 * random();
    for (auto& p : mesh.coordinates()) p = scale() * (turned * p + shift);
    return mesh;
  }
};

template <int dim>
std::ostream& operator<<(std::ostream& stream, const RandomSimilarity<dim>& similarity) {
  return stream << "scale " << similarity.scale() << " seed " << similarity.seed;
}

}  // namespace
}  // namespace smoothfem

namespace rc {

template <int dim>
struct Arbitrary<smoothfem::RandomMesh<dim>> {
  static Gen<smoothfem::RandomMesh<dim>> arbitrary() {
    using Made = smoothfem::RandomMesh<dim>;
    // All sizes from the beginning: RapidCheck's growing sizes are meant for far more meshes.
    return gen::resize(
        kNominalSize,
        gen::build<Made>(
            gen::set(&Made::kind, gen::inRange(0, dim == 2 ? 3 : 5)),
            gen::set(&Made::n_cells,
                     gen::container<std::vector<std::uint32_t>>(dim, gen::inRange(2u, 7u))),
            gen::set(&Made::stretch, gen::container<std::vector<int>>(dim, gen::inRange(1, 11))),
            gen::set(&Made::distortion_tenths, gen::inRange(1, 11)),
            gen::set(&Made::fixed_tenths, gen::inRange(0, 6)),
            gen::set(&Made::seed, gen::inRange<std::uint64_t>(1, 1000000))));
  }
};

template <int dim>
struct Arbitrary<smoothfem::RandomSimilarity<dim>> {
  static Gen<smoothfem::RandomSimilarity<dim>> arbitrary() {
    using Made = smoothfem::RandomSimilarity<dim>;
    return gen::resize(
        kNominalSize,
        gen::build<Made>(gen::set(&Made::scale_index, gen::inRange(0, 3)),
                         gen::set(&Made::seed, gen::inRange<std::uint64_t>(1, 1000000))));
  }
};

}  // namespace rc

namespace smoothfem {
namespace {

class MethodProperties : public testing::TestWithParam<std::string> {
 protected:
  /// Checks property.operator()<dim>(...) for the dimensions that the method supports.
  template <class... Arguments2, class... Arguments3>
  static void check(void (*planar)(const std::string&, Arguments2...),
                    void (*volume)(const std::string&, Arguments3...)) {
    const std::string name = GetParam();
    if (supports_mesh_kind<2>(name))
      rc::detail::checkGTest([=](std::decay_t<Arguments2>... made) { planar(name, made...); });
    if (supports_mesh_kind<3>(name))
      rc::detail::checkGTest([=](std::decay_t<Arguments3>... made) { volume(name, made...); });
  }
};

template <int dim>
void stays_valid_and_fixed(const std::string& name, const RandomMesh<dim>& random) {
  const auto mesh = valid_mesh(random);
  auto result = mesh;
  auto method = test::short_method<dim>(name, "5");
  const bool stays_valid = test::claims_validity(method);
  smooth(result, method, [&](const auto&, const Mesh<dim>& seen) {
    RC_ASSERT(test::n_moved_fixed_nodes(mesh, seen) == 0u);
    if (stays_valid) RC_ASSERT(mesh_quality(seen).n_invalid == 0u);
  });
  RC_ASSERT(test::n_moved_fixed_nodes(mesh, result) == 0u);
  if (stays_valid) RC_ASSERT(mesh_quality(result).n_invalid == 0u);
}

TEST_P(MethodProperties, StaysValidAndMovesOnlyFreeNodes) {
  check(stays_valid_and_fixed<2>, stays_valid_and_fixed<3>);
}

/// Bounds the effect of rounding. A coordinate is rounded by eps times the extent L of the mesh, at
/// every scale. In a cell of quality q and size h this is an error of eps L / (q h) in its quality,
/// on which transformations build. Every iteration may multiply the error by 1/q. With q above
/// 0.01, two iterations and L / h below 100 the error is at most 1e-16 * 1e2 * 1e4 h; 1e-8 is on
/// the safe side. Below that quality rounding decides whether a cell counts as valid; either
/// decision gives a different, correct mesh.
///
/// Newton steps are solved in single precision and no further than they need, so that they differ
/// in their seventh digit; only the minimum is the same. The method ends when a step gains less
/// than 1e-8 of the objective, 1e-4 h away from the minimum; that step leaves the square. The
/// factor of one hundred covers directions in which the objective hardly rises.
template <int dim>
void commutes_with_similarities(const std::string& name, const RandomMesh<dim>& random,
                                const RandomSimilarity<dim>& similarity) {
  const auto mesh = valid_mesh(random);
  RC_PRE(mesh_quality(mesh).q_min > 0.01);
  auto here = mesh, there = similarity(mesh);
  const bool to_the_end = name == "global-optimization" || name == "curved-optimization";
  const auto method = [&] {
    return to_the_end ? make_method<dim>(name) : test::short_method<dim>(name, "2");
  };
  auto first = method(), second = method();
  smooth(here, first);
  smooth(there, second);
  const auto expected = similarity(here);
  double farthest = 0.0;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    farthest = std::max(farthest, (expected.coordinates()[i] - there.coordinates()[i]).norm());
  RC_ASSERT(farthest / similarity.scale() < (to_the_end ? 1e-6 : 1e-8));
}

TEST_P(MethodProperties, CommutesWithSimilarities) {
  check(commutes_with_similarities<2>, commutes_with_similarities<3>);
}

/// Runs each stage separately, from the mesh of the previous one.
template <int dim>
void never_lowers_what_it_keeps(const std::string& name, const RandomMesh<dim>& random) {
  auto mesh = valid_mesh(random);
  auto method = test::short_method<dim>(name, "4");
  for (auto& stage : method.stages) {
    const ResultMesh kept = stage->traits().result;
    Method<dim> alone{method.info, {}};
    alone.stages.push_back(std::move(stage));
    const MeshQuality before = mesh_quality(mesh);
    smooth(mesh, alone);
    const MeshQuality after = mesh_quality(mesh);
    if (kept == ResultMesh::best_q_mean) RC_ASSERT(after.q_mean >= before.q_mean);
    if (kept == ResultMesh::best_q_star_min) RC_ASSERT(after.q_star_min >= before.q_star_min);
  }
}

TEST_P(MethodProperties, NeverLowersTheQualityThatSelectsItsResult) {
  check(never_lowers_what_it_keeps<2>, never_lowers_what_it_keeps<3>);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, MethodProperties, testing::ValuesIn(test::method_names()),
                         test::test_name);

/// Runs call() with each number of threads. Restores the default number, also after a failure.
template <class Call>
void with_each_number_of_threads(const Call& call) {
  const struct Restore {
    int default_threads = n_threads();
    ~Restore() { set_n_threads(default_threads); }
  } restore;
  for (const int threads : {1, 2, 3, 8}) {
    set_n_threads(threads);
    call();
  }
}

/// Cells in several blocks; otherwise a second thread would have nothing to do.
template <int dim>
RandomMesh<dim> enlarged(RandomMesh<dim> random) {
  for (auto& n : random.n_cells) n += dim == 2 ? 128 : 25;
  return random;
}

/// Runs the property on as few meshes as these large ones allow, each with one of the methods.
template <int dim>
void check_numbers_of_threads() {
  auto parameters = rc::detail::configuration().testParams;
  parameters.maxSuccess = std::max(1, parameters.maxSuccess / 100);
  parameters.disableShrinking = true;
  const auto property = [](const RandomMesh<dim>& random) {
    const auto name = *rc::gen::elementOf(test::method_names()).as("method");
    RC_PRE(supports_mesh_kind<dim>(name));
    const auto mesh = valid_mesh(enlarged(random));
    RC_ASSERT(mesh.topology().blocks().size() > 1u);
    std::optional<Mesh<dim>> expected;
    with_each_number_of_threads([&] {
      auto result = mesh;
      auto method = test::short_method<dim>(name, "3");
      smooth(result, method);
      if (!expected) expected = result;
      RC_ASSERT((result.copied_coordinates() == expected->copied_coordinates()));
    });
  };
  std::ostringstream text;
  const auto result = rc::detail::checkTestable(property, rc::detail::TestMetadata(), parameters);
  rc::detail::printResultMessage(result, text);
  EXPECT_TRUE(result.template is<rc::detail::SuccessResult>()) << text.str();
}

TEST(ThreadProperties, PlanarMeshesAreBitwiseIdentical) {
  check_numbers_of_threads<2>();
}
TEST(ThreadProperties, VolumeMeshesAreBitwiseIdentical) {
  check_numbers_of_threads<3>();
}

struct UntangleCounts {
  int untangled = 0, given_up = 0;
};

template <int dim>
void check_untangling(const RandomMesh<dim>& random, bool fixed_in_place, UntangleCounts& counts) {
  const auto tangled = tangled_mesh(random, fixed_in_place);
  const std::size_t n_invalid = mesh_quality(tangled).n_invalid;
  auto mesh = tangled;
  const auto result = untangle(mesh);
  RC_ASSERT(result.n_invalid_before == n_invalid);
  RC_ASSERT(result.n_invalid_after == result.invalid_cells.size());
  RC_ASSERT(result.valid == (result.n_invalid_after == 0u));
  RC_ASSERT(test::n_moved_fixed_nodes(tangled, mesh) == 0u);
  if (result.valid) RC_ASSERT(mesh_quality(mesh).n_invalid == 0u);
  if (!result.valid || n_invalid == 0)
    RC_ASSERT((mesh.copied_coordinates() == tangled.copied_coordinates()));
  if (n_invalid > 0) ++(result.valid ? counts.untangled : counts.given_up);
}

/// Both outcomes must occur; otherwise half of the property would not be tested.
template <int dim>
void check_all_untangling() {
  UntangleCounts counts;
  rc::detail::checkGTest([&](const RandomMesh<dim>& random, bool fixed_in_place) {
    check_untangling(random, fixed_in_place, counts);
  });
  EXPECT_GT(counts.untangled, 0);
  EXPECT_GT(counts.given_up, 0);
}

TEST(UntangleProperties, MakesPlanarMeshesValidOrKeepsThem) {
  check_all_untangling<2>();
}
TEST(UntangleProperties, MakesVolumeMeshesValidOrKeepsThem) {
  check_all_untangling<3>();
}

template <int dim>
void check_valid_meshes_stay() {
  rc::detail::checkGTest([](const RandomMesh<dim>& random) {
    const auto valid = valid_mesh(random);
    auto mesh = valid;
    const auto result = untangle(mesh);
    RC_ASSERT(result.valid);
    RC_ASSERT(result.n_sweeps == 0);
    RC_ASSERT((mesh.copied_coordinates() == valid.copied_coordinates()));
  });
}

TEST(UntangleProperties, KeepsValidMeshes) {
  check_valid_meshes_stay<2>();
  check_valid_meshes_stay<3>();
}

}  // namespace
}  // namespace smoothfem
