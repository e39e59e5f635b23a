// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <numeric>
#include <set>
#include <thread>

#include "smoothing/getme/independent_cells.h"
#include "smoothing/getme/min_tree.h"
#include "smoothing/loop/best_mesh.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/invalid_node_reset.h"
#include "smoothing/loop/preset.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/tests/volume_meshes.h"

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

TEST(Catalogue, HasTheBuiltInMethodsAndListsThemInErrors) {
  for (const std::string name :
       {"curved-optimization", "getme", "getme-sequential", "getme-simultaneous",
        "global-optimization", "laplace", "smart-laplace", "weighted-laplace"})
    EXPECT_FALSE(make_method<2>(name).stages.empty()) << name;
  EXPECT_THAT(message_of([] { make_method<2>("getmee"); }),
              HasSubstr("there is no method 'getmee'; did you mean 'getme'? choose one of "
                        "curved-optimization, energy-descent, energy-lbfgs, getme, "));
}

template <int dim>
void expect_documented_defaults(const std::string& method_name) {
  if (!supports_mesh_kind<dim>(method_name)) {
    EXPECT_THAT(message_of([&] { make_method<dim>(method_name); }), HasSubstr("does not support"));
    return;
  }
  Method<dim> method = make_method<dim>(method_name);
  for (const auto& parameter : method.parameters()) {
    const std::string text = value_text(parameter);
    EXPECT_NO_THROW(set_value(parameter, text, method_name)) << parameter.name;
    EXPECT_EQ(value_text(parameter), text);
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
  }
}

TEST(Catalogue, DefaultsLieInTheirRangesAndAreDocumented) {
  for (const auto& info : method_catalogue()) {
    EXPECT_FALSE(info.title.empty() || info.description.empty() || info.source.empty());
    expect_documented_defaults<2>(info.name);
    expect_documented_defaults<3>(info.name);
  }
}

TEST(Parameters, TakeNamesAndLists) {
  int position = 0;
  std::vector<double> numbers{1.0, 0.25};
  const Parameter choice{"c", "", Choice{&position, {"one", "two"}}};
  const Parameter list{"l", "", &numbers, 0.0, 1.0};
  set_value(choice, "two", "method x");
  EXPECT_EQ(position, 1);
  EXPECT_EQ(value_text(choice), "two");
  EXPECT_THAT(message_of([&] { set_value(choice, "three", "method x"); }),
              HasSubstr("parameter c is given as 'three'; choose one of one, two"));
  EXPECT_EQ(value_text(list), "1, 0.25");
  set_value(list, "0.5, 0.125,0", "method x");
  EXPECT_EQ(numbers, (std::vector<double>{0.5, 0.125, 0.0}));
  for (const std::string bad : {"", "0.5,,1", "0.5, 2", "a"})
    EXPECT_THROW(set_value(list, bad, "method x"), InputError) << bad;
}

TEST(Presets, SetParametersThatExist) {
  for (const Preset& preset : presets()) {
    EXPECT_FALSE(preset.description.empty() || preset.source.empty());
    for (const auto& info : method_catalogue()) {
      const auto apply = [&]<int dim>() {
        if (!supports_mesh_kind<dim>(info.name)) return;
        Method<dim> method = make_method<dim>(info.name);
        const bool meant =
            std::any_of(method.stages.begin(), method.stages.end(), [&](const auto& stage) {
              return std::any_of(preset.settings.begin(), preset.settings.end(),
                                 [&](const auto& setting) {
                                   return setting.dim == dim && setting.stage == stage->name();
                                 });
            });
        const std::string message = message_of([&] { apply_preset(preset, method); });
        EXPECT_EQ(message == "nothing thrown", meant)
            << preset.name << ' ' << info.name << ": " << message;
      };
      apply.operator()<2>();
      apply.operator()<3>();
    }
  }
}

TEST(Presets, HaveTheParametersOfTheThesis) {
  const auto text = [](const std::string& preset, const std::string& method_name,
                       const std::string& parameter) {
    Method<3> method = make_method<3>(method_name);
    apply_preset(find_preset(preset), method);
    return value_text(find_parameter(method.parameters(), parameter, "test"));
  };
  EXPECT_EQ(text("thesis-5.2", "getme", "simultaneous.scaling"), "neighbour-mean-size");
  EXPECT_EQ(text("thesis-5.2", "getme", "sequential.max_mean_loss"), "0.01");
  for (const std::string section : {"5.2", "5.3", "5.4"})
    EXPECT_EQ(text("thesis-" + section, "global-optimization", "result"), "best-q-mean");
  EXPECT_EQ(text("thesis-5.5", "global-optimization", "result"), "last");
  EXPECT_EQ(text("thesis-5.5", "getme", "simultaneous.tolerance"), "1e-04");
  EXPECT_EQ(text("thesis-5.5", "getme", "simultaneous.patience"), "0");
  EXPECT_EQ(text("thesis-5.3", "getme", "simultaneous.sigma_hexahedron_max"), "0.6");
  EXPECT_EQ(text("thesis-5.4", "getme-qgamma", "qgamma.penalty_success"), "-0.01");
  EXPECT_EQ(text("thesis-5.5", "getme-adaptive", "min.relaxation"), "0.5, 0.25, 0.1, 0.01, 0");
  EXPECT_EQ(text("thesis-5.5", "smart-laplace", "tolerance"), "1e-04");
  EXPECT_EQ(text("thesis-6.3", "getme", "simultaneous.sigma_tetrahedron_max"), "50.7");
  EXPECT_EQ(text("tuned", "getme", "simultaneous.sigma_tetrahedron_max"), "5.7");
  EXPECT_EQ(text("tuned", "getme", "simultaneous.sigma_tetrahedron_min"), "0.7");
  EXPECT_THAT(message_of([] { find_preset("thesis-9"); }), HasSubstr("thesis-5.1, thesis-5.2"));
}

TEST(Presets, EachSettingHasItsOrigin) {
  for (const Preset& preset : presets())
    for (const auto& setting : preset.settings)
      EXPECT_FALSE(setting.origin.place.empty())
          << preset.name << ' ' << setting.stage << '.' << setting.parameter;
  EXPECT_THAT(message_of([] { make_origin("guessed", "", "preset x, mean.rho"); }),
              HasSubstr("preset x, mean.rho: there is no origin 'guessed'"));
}

TEST(Presets, ThoseOfTheThesisHaveNoRuleBelowTheStart) {
  for (const Preset& preset : presets()) {
    const std::string factor = preset.name == "tuned" ? "10" : "1";
    const auto find = [&](const auto& stage_of, const std::string& parameter) {
      return std::find_if(preset.settings.begin(), preset.settings.end(), [&](const auto& other) {
        return other.dim == stage_of.dim && other.stage == stage_of.stage &&
               other.parameter == parameter;
      });
    };
    for (const auto& setting : preset.settings) {
      if (setting.stage != "sequential" && setting.stage != "min" && setting.stage != "qgamma")
        continue;
      const auto rule = find(setting, "patience_below_start");
      ASSERT_NE(rule, preset.settings.end()) << preset.name << ' ' << setting.stage;
      EXPECT_EQ(rule->value, factor) << preset.name << ' ' << setting.stage;
    }
  }
}

TEST(Catalogue, DefaultsHaveTheirOrigins) {
  const auto expect_origins = []<int dim>(const std::string& method_name) {
    if (!supports_mesh_kind<dim>(method_name)) return;
    Method<dim> method = make_method<dim>(method_name);
    for (const auto& stage : method.stages)
      for (const auto& parameter : stage->parameters())
        EXPECT_TRUE(default_origin(std::string(stage->name()), parameter.name))
            << method_name << ", stage " << stage->name() << ", " << parameter.name
            << ": add it to studies/origins.json";
  };
  for (const auto& info : method_catalogue(true)) {
    expect_origins.operator()<2>(info.name);
    expect_origins.operator()<3>(info.name);
  }
  EXPECT_EQ(text_of(*default_origin("sequential", "floor")), "own choice");
  EXPECT_EQ(text_of(*default_origin("laplace", "tolerance")), "printed, Section 1.3.2");
  EXPECT_FALSE(default_origin("no-such-stage", "rho"));
}

TEST(Catalogue, StagesNameTheirParameters) {
  Method<2> getme = make_method<2>("getme");
  EXPECT_NO_THROW(getme.set("sequential.rho", "0.02"));
  EXPECT_THAT(message_of([&] { getme.set("rho", "0.02"); }), HasSubstr("simultaneous.rho"));
}

TEST(MinTree, PicksLikeASortedSet) {
  for (const std::uint32_t n : {1u, 7u, 8u, 9u, 200u, 5000u}) {
    test::Random random(n);
    std::vector<double> keys(n);
    std::set<std::pair<double, std::uint32_t>> oracle;
    for (std::uint32_t i = 0; i < n; ++i) {
      keys[i] = i % 3 == 1 ? MinTree::never : std::floor(8.0 * random());  // many ties
      oracle.emplace(keys[i], i);
    }
    MinTree tree;
    tree.build(keys);
    for (int step = 0; step < 5000; ++step) {
      ASSERT_EQ(tree.top(), oracle.begin()->second) << n << ' ' << step;
      if (step % 50 == 0) {
        std::vector<std::uint32_t> lowest;
        for (const auto& [key, number] : oracle)
          if (lowest.size() < 20 && key != MinTree::never) lowest.push_back(number);
        ASSERT_EQ(tree.lowest(20), lowest) << n << ' ' << step;
      }
      // Sometimes changes the top itself, as the sequential method does.
      const auto at_random = static_cast<std::uint32_t>(0.5 * (random() + 1.0) * n);
      const std::uint32_t number = step % 2 ? tree.top() : at_random;
      oracle.erase({keys[number], number});
      keys[number] = std::floor(8.0 * random());
      oracle.emplace(keys[number], number);
      tree.update(number, keys[number]);
      ASSERT_EQ(tree.key(number), keys[number]);
    }
  }
}

TEST(MinTree, IsEmptyWithoutFiniteKeys) {
  MinTree tree;
  EXPECT_TRUE(tree.empty());
  tree.build({MinTree::never, MinTree::never});
  EXPECT_TRUE(tree.empty());
  tree.update(1, 3.0);
  EXPECT_FALSE(tree.empty());
}

/// A row of unit squares; square k has the nodes k and k + 1 below, and those above.
TEST(IndependentCells, HaveNoCellInCommon) {
  constexpr NodeIndex n = 9;
  CompressedRows<NodeIndex> cells;
  for (NodeIndex k = 0; k < n; ++k)
    cells.append(std::array<NodeIndex, 4>{k, k + 1, n + k + 2, n + k + 1});
  const Topology row(2, 2 * (n + 1), cells);
  const auto chosen = [&](std::vector<double> keys, std::size_t n_lowest) {
    MinTree tree;
    tree.build(std::move(keys));
    IndependentCells independent;
    independent.prepare(row);
    const auto candidates = lowest_cells(WholeMesh(row), tree, n_lowest);
    std::vector<CandidateNode> nodes;
    for (std::uint32_t place = 0; place < candidates.size(); ++place)
      for (const NodeIndex node : row.cell_nodes(candidates[place].cell))
        nodes.push_back({place, node, -static_cast<double>(place)});
    std::vector<GlobalIndex> result;
    for (const std::uint32_t place : independent.choose(candidates, nodes))
      result.push_back(candidates[place].cell);
    return result;
  };
  // Square k moves nodes of the squares k - 1 to k + 1: others must be three squares away.
  EXPECT_THAT(chosen({5, 6, 1, 7, 8, 3, 9, 2, 4}, 9), testing::ElementsAre(2, 7));
  EXPECT_THAT(chosen({5, 6, 1, 7, 8, 2, 9, 3, 4}, 9), testing::ElementsAre(2, 5, 8));
  EXPECT_THAT(chosen({5, 6, 1, 7, 8, 2, 9, 3, 4}, 2), testing::ElementsAre(2, 5));
  // Of equal keys, the one with the lower second key comes first: here that with the higher number.
  EXPECT_THAT(chosen({9, 9, 1, 1, 9, 9, 9, 9, 9}, 2), testing::ElementsAre(3));
  EXPECT_THAT(chosen({MinTree::never, 2, 9, 9, 9, 9, 9, 9, 9}, 1), testing::ElementsAre(1));
}

TEST(InvalidNodeReset, ResetsNodesUntilAllCellsAreValid) {
  const auto valid = test::grid_mesh(6, test::GridCells::triangles);
  auto mesh = valid;
  test::Random random(5);
  for (const NodeIndex i : mesh.topology().free_nodes()) {
    const double dx = random(), dy = random();
    mesh.coordinates()[i] += Point<2>(dx, dy);
  }
  auto quality = cell_mean_ratios(mesh);
  ASSERT_GT(mesh_quality(mesh).n_invalid, 0u);
  const auto n_reset = reset_nodes_of_invalid_cells(mesh, valid.coordinates(), quality).size();
  EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
  EXPECT_EQ(quality, cell_mean_ratios(mesh)) << "quality must be kept up to date";
  std::size_t n_back = 0;
  for (const NodeIndex i : mesh.topology().free_nodes())
    n_back += mesh.coordinates()[i] == valid.coordinates()[i];
  EXPECT_EQ(n_reset, n_back);
  EXPECT_LT(n_back, mesh.topology().free_nodes().size()) << "nodes of valid cells stay moved";
}

TEST(InvalidNodeReset, KeepsValidMeshes) {
  auto mesh = test::grid_mesh(3, test::GridCells::quadrilaterals);
  const auto previous = mesh.copied_coordinates();
  mesh.coordinates()[5] += Point<2>(0.1, 0.1);
  const auto moved = mesh.copied_coordinates();
  auto quality = cell_mean_ratios(mesh);
  EXPECT_TRUE(reset_nodes_of_invalid_cells(mesh, previous, quality).empty());
  EXPECT_EQ(mesh.copied_coordinates(), moved);
}

TEST(InvalidNodeReset, EndsWhenThePreviousMeshWasInvalidToo) {
  auto mesh = test::grid_mesh(2, test::GridCells::quadrilaterals);
  mesh.coordinates()[4] = {5.0, 5.0};
  const auto tangled = mesh.copied_coordinates();
  auto quality = cell_mean_ratios(mesh);
  EXPECT_TRUE(reset_nodes_of_invalid_cells(mesh, tangled, quality).empty());
}

TEST(Loop, TheSequentialMethodStopsWhenTheMeanQualityHasFallen) {
  auto initial = test::box_mesh(5, 5, 5, test::BoxCells::tetrahedra);
  test::distort(initial, 0.2, 4);
  const auto q_means = [&](double max_mean_loss) {
    auto method = make_method<3>("getme-sequential");
    for (const auto& [name, value] : std::map<std::string, std::string>{
             {"rho", "1"}, {"cycle", "10"}, {"patience", "1000"}, {"max_cycles", "200"}})
      method.set(name, value);
    method.set("max_mean_loss", std::to_string(max_mean_loss));
    auto mesh = initial;
    std::vector<double> seen;
    smooth(mesh, method, [&](const IterationRecord& record, const VolumeMesh&) {
      seen.push_back(record.quality.q_mean);
    });
    return seen;
  };
  const std::vector<double> free = q_means(1.0);
  const double largest_loss = 1.0 - *std::min_element(free.begin(), free.end()) / free.front();
  ASSERT_GT(largest_loss, 1e-3) << "the mean quality has to fall for this test";
  const double loss = std::stod(std::to_string(0.5 * largest_loss));  // the value as it is set
  const auto first_below = std::find_if(free.begin(), free.end(), [&](double q_mean) {
    return q_mean < (1.0 - loss) * free.front();
  });
  EXPECT_EQ(q_means(loss), std::vector<double>(free.begin(), first_below + 1));
}

/// A box whose layers become much thinner upwards. On such grids the last steps of the optimization
/// lower the mean quality, as they improve the worst cells more than the others.
VolumeMesh graded_box() {
  auto mesh = test::box_mesh(6, 6, 6, test::BoxCells::hexahedra);
  for (auto& p : mesh.coordinates()) p.z() = 6.0 - 6.0 * std::pow(1.0 - p.z() / 6.0, 5.0);
  test::distort(mesh, 0.1, 3);
  return mesh;
}

TEST(Loop, GlobalOptimizationCanEndWithTheMeshOfTheBestMeanQuality) {
  for (const auto& [result, best] : {std::pair{"last", false}, std::pair{"best-q-mean", true}}) {
    auto method = make_method<3>("global-optimization");
    method.set("result", result);
    auto mesh = graded_box();
    std::vector<double> seen;
    const auto outcome =
        smooth(mesh, method, [&](const IterationRecord& record, const VolumeMesh&) {
          seen.push_back(record.quality.q_mean);
        });
    const auto highest = std::max_element(seen.begin(), seen.end());
    ASSERT_GT(highest, seen.begin()) << "the best mesh has to be one on the way for this test";
    ASSERT_LT(highest + 1, seen.end());
    EXPECT_EQ(mesh_quality(mesh).q_mean, best ? *highest : seen.back());
    EXPECT_EQ(outcome.result_record,
              best ? static_cast<std::size_t>(highest - seen.begin()) : seen.size() - 1);
  }
}

/// Small meshes are smoothed in their original order, large ones are reordered.
TEST(Loop, AnObserverThatThrowsLeavesAMeshItHasSeen) {
  for (const std::uint32_t n : {10u, 150u}) {
    PlanarMesh mesh = test::grid_mesh(n, test::GridCells::quadrilaterals);
    test::distort(mesh, 0.3, 1);
    std::vector<std::vector<Point<2>>> seen;
    auto method = make_method<2>("getme");
    EXPECT_THROW(smooth(mesh, method,
                        [&](const IterationRecord& record, const PlanarMesh& now) {
                          seen.push_back(now.copied_coordinates());
                          if (record.record == 2) throw std::runtime_error("enough");
                        }),
                 std::runtime_error);
    ASSERT_EQ(seen.size(), 3u);
    EXPECT_THAT(seen, testing::Contains(mesh.copied_coordinates())) << n;
  }
}

TEST(Loop, AStageThatThrowsAtItsStartLeavesItsInitialMesh) {
  for (const std::uint32_t n : {10u, 150u}) {
    PlanarMesh mesh = test::grid_mesh(n, test::GridCells::quadrilaterals);
    test::distort(mesh, 0.3, 1);
    const auto given = mesh.copied_coordinates();
    auto method = make_method<2>("getme-adaptive");
    method.set("mean.relaxation", "1, 0.5");
    EXPECT_THROW(smooth(mesh, method), InputError);
    EXPECT_EQ(mesh.copied_coordinates(), given) << n;
  }
}

/// Returns the iteration that ends the second stage of GETMe adaptive, by the text of the thesis.
/// q_star_min: its values from the initial mesh of the stage on.
std::size_t end_of_second_stage(const std::vector<double>& q_star_min, int patience,
                                bool as_figure) {
  double best = q_star_min[0], best_at_start = best;
  int n_without_gain = 0;
  for (std::size_t i = 1; i < q_star_min.size(); ++i) {
    const bool gain = q_star_min[i] > (as_figure ? q_star_min[i - 1] : best);
    best = std::max(best, q_star_min[i]);
    n_without_gain = gain ? (as_figure ? n_without_gain : 0) : n_without_gain + 1;
    if (n_without_gain < patience + (as_figure ? 1 : 0)) continue;
    if (best == best_at_start) return i;
    best_at_start = best;
    n_without_gain = 0;
  }
  return 0;
}

TEST(Loop, CyclesOfGetmeAdaptiveEndBySection513OrFig44) {
  std::vector<std::size_t> ends;
  for (const std::string rule : {"in-a-row", "in-cycle"}) {
    PlanarMesh mesh = test::grid_mesh(20, test::GridCells::triangles);
    test::distort(mesh, 0.3, 1);
    auto method = make_method<2>("getme-adaptive");
    method.set("min.no_gain", rule);
    method.set("min.patience", "3");
    method.set("min.patience_below_start", "1");
    std::vector<double> q_star_min;
    double best_mean = -1;  // the second stage begins with the mesh of that quality
    smooth(mesh, method, [&](const auto& record, const auto&) {
      if (record.stage == "min") return q_star_min.push_back(record.quality.q_star_min);
      if (record.quality.q_mean <= best_mean) return;
      best_mean = record.quality.q_mean;
      q_star_min = {record.quality.q_star_min};
    });
    ASSERT_GT(q_star_min.size(), 2u);
    ends.push_back(q_star_min.size() - 1);
    EXPECT_EQ(end_of_second_stage(q_star_min, 3, rule == "in-cycle"), ends.back()) << rule;
  }
  EXPECT_NE(ends[0], ends[1]);
}

TEST(Loop, LaplaceEndsByMovementOrByTheMeanQuality) {
  for (const bool by_q_mean : {false, true}) {
    PlanarMesh mesh = test::grid_mesh(12, test::GridCells::triangles);
    test::distort(mesh, 0.9, 1);
    auto method = make_method<2>("laplace");
    method.set("tolerance", "1e-5");
    if (by_q_mean) method.set("stop_by", "q-mean");
    double best = 0.0, last = 0.0;
    const auto result = smooth(mesh, method, [&](const auto& record, const auto&) {
      last = record.quality.q_mean;
      best = std::max(best, last);
    });
    EXPECT_EQ(result.quality.q_mean, by_q_mean ? best : last);
    EXPECT_EQ(mesh_quality(mesh).q_mean, result.quality.q_mean);
    EXPECT_THAT(result.stages[0].why_stopped, HasSubstr(by_q_mean ? "q_mean" : "no node moved"));
  }
}

TEST(Loop, TheBestMeshMayBeInvalidOnlyWithoutQualityControl) {
  const std::vector<Point<2>> coordinates(1);
  MeshQuality bad{};
  for (const bool allowed : {false, true}) {
    BestMesh<2> best(ResultMesh::best_q_mean, coordinates, bad, 0.0, allowed);
    MeshQuality better = bad;
    better.q_mean = 0.5;
    better.n_invalid = 3;
    EXPECT_EQ(best.offer(coordinates, better, {}), allowed);
  }
}

/// Takes its time and reports how much.
class SlowSmoother final : public Smoother<2> {
 public:
  static constexpr std::chrono::milliseconds preparation{40}, iteration{10};
  std::string_view name() const override { return "slow"; }
  SmootherTraits traits() const override { return {.quality_use = QualityUse::none}; }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so, .max_iterations = 3};
  }
  void initialize(const SmoothingState<2>&) override { std::this_thread::sleep_for(preparation); }
  StepReport step(SmoothingState<2>&) override {
    std::this_thread::sleep_for(iteration);
    return {};
  }
};

TEST(Loop, PreparationsAreTimedSeparately) {
  PlanarMesh mesh = test::grid_mesh(10, test::GridCells::quadrilaterals);
  Method<2> method;
  method.stages.push_back(std::make_unique<SlowSmoother>());
  method.stages.push_back(std::make_unique<SlowSmoother>());
  const double preparation = 0.040, iteration = 0.010;
  std::vector<IterationRecord> records;
  const auto begin = std::chrono::steady_clock::now();
  const auto result =
      smooth(mesh, method, [&](const auto& record, const auto&) { records.push_back(record); });
  const std::chrono::duration<double> all = std::chrono::steady_clock::now() - begin;
  EXPECT_GE(result.preparation_seconds, 2 * preparation);
  EXPECT_GE(result.smoothing_seconds, 6 * iteration);
  EXPECT_LE(result.preparation_seconds + result.smoothing_seconds, all.count());
  ASSERT_EQ(records.size(), 7U);
  EXPECT_EQ(records[0].smoothing_seconds, 0.0);
  EXPECT_GE(records[1].preparation_seconds, preparation);
  EXPECT_EQ(records[3].preparation_seconds, records[1].preparation_seconds);
  EXPECT_GE(records[4].preparation_seconds, records[3].preparation_seconds + preparation);
  EXPECT_EQ(records.back().preparation_seconds, result.preparation_seconds);
  EXPECT_GE(result.smoothing_seconds, records.back().smoothing_seconds);
}

/// Moves a node a little and leaves it there.
class Spoiler final : public Smoother<2> {
 public:
  std::string_view name() const override { return "spoiler"; }
  SmootherTraits traits() const override {
    return {.quality_use = QualityUse::loop, .result = ResultMesh::last};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so, .max_iterations = 1};
  }
  StepReport step(SmoothingState<2>& state) override {
    state.mesh.coordinates()[state.mesh.topology().free_nodes()[0]].x() += 0.3;
    return {};
  }
};

/// Makes no better mesh until a given iteration, which undoes the spoiler's change.
class Idler final : public Smoother<2> {
 public:
  explicit Idler(int patience_below_start, int repairs_at = 0)
      : patience_below_start_(patience_below_start), repairs_at_(repairs_at) {}
  std::string_view name() const override { return "idler"; }
  SmootherTraits traits() const override {
    return {.quality_use = QualityUse::loop, .result = ResultMesh::best_q_star_min};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::result_stall,
            .patience = 3,
            .patience_below_start = patience_below_start_};
  }
  StepReport step(SmoothingState<2>& state) override {
    if (++n_ == repairs_at_)
      state.mesh.coordinates()[state.mesh.topology().free_nodes()[0]].x() -= 0.3;
    return {};
  }

 private:
  int patience_below_start_, repairs_at_, n_ = 0;
};

TEST(Loop, ReportsWhenPatienceBelowTheStartApplied) {
  const auto last_stage = [](bool spoiled, auto... arguments) {
    PlanarMesh mesh = test::grid_mesh(6, test::GridCells::quadrilaterals);
    Method<2> method;
    if (spoiled) method.stages.push_back(std::make_unique<Spoiler>());
    method.stages.push_back(std::make_unique<Idler>(arguments...));
    return smooth(mesh, method).stages.back();
  };
  const StageResult above = last_stage(false, 10), rule_of_thesis = last_stage(true, 1),
                    below = last_stage(true, 10), recovered = last_stage(true, 10, 7);
  EXPECT_EQ(above.iterations, 3u);
  EXPECT_EQ(above.why_stopped, "no improvement in 3 iterations");
  EXPECT_EQ(rule_of_thesis.why_stopped, above.why_stopped);
  EXPECT_EQ(below.iterations, 30u);
  EXPECT_EQ(below.why_stopped,
            "no improvement in 30 iterations, 10 times the patience, as q*_min is below "
            "that of the start (patience_below_start; not in the thesis)");
  EXPECT_EQ(recovered.iterations, 10u);
  EXPECT_THAT(
      recovered.why_stopped,
      HasSubstr("no improvement in 3 iterations, after an extended patience while q*_min was below "
                "that of the start (patience_below_start"));
}

/// Moves one node beyond its neighbours in every iteration.
class Tangler final : public Smoother<2> {
 public:
  std::string_view name() const override { return "tangler"; }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so, .max_iterations = 2};
  }
  StepReport step(SmoothingState<2>& state) override {
    state.mesh.coordinates()[state.mesh.topology().free_nodes()[0]].x() += 2.0;
    return {};
  }
};

TEST(Loop, CellsMadeInvalidAreCountedBeforeNodesAreReset) {
  PlanarMesh mesh = test::grid_mesh(10, test::GridCells::quadrilaterals);
  PlanarMesh tangled = mesh;
  tangled.coordinates()[mesh.topology().free_nodes()[0]].x() += 2.0;
  Method<2> method;
  method.stages.push_back(std::make_unique<Tangler>());
  smooth(mesh, method, [&](const IterationRecord& record, const auto&) {
    EXPECT_EQ(record.quality.n_invalid, 0U);
    EXPECT_EQ(record.n_made_invalid.has_value(), record.record > 0);
    if (record.record > 0) {
      EXPECT_EQ(*record.n_made_invalid, mesh_quality(tangled).n_invalid);
      EXPECT_GT(record.n_reset, 0U);
    }
  });
}

/// A mesh that is large enough to be reordered, with randomly numbered nodes and cells.
VolumeMesh large_shuffled_mesh(test::BoxCells kind) {
  VolumeMesh mesh = test::box_mesh(26, 26, 25, kind);
  test::distort(mesh, 0.3, 1);
  const auto shuffled = [](std::size_t n, std::uint64_t seed) {
    std::vector<std::uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0U);
    test::Random random(seed);
    for (std::size_t i = n; i > 1; --i)
      std::swap(order[i - 1],
                order[static_cast<std::size_t>((0.5 + 0.499 * random()) * static_cast<double>(i))]);
    return order;
  };
  const auto nodes = shuffled(mesh.n_nodes(), 1);
  std::vector<Point<3>> coordinates;
  for (const NodeIndex i : nodes) coordinates.push_back(mesh.coordinates()[i]);
  return {mesh.topology().reordered(nodes, shuffled(mesh.n_cells(), 2)), std::move(coordinates)};
}

TEST(Loop, SweepsFollowTheMeshsOwnOrder) {
  for (const auto kind : {test::BoxCells::tetrahedra, test::BoxCells::hexahedra})
    for (const std::string name : {"laplace", "weighted-laplace"}) {
      SCOPED_TRACE(name);
      VolumeMesh mesh = large_shuffled_mesh(kind);
      SmoothingState<3> alone{mesh, {}};
      const auto stages = stages_of<3>(name);
      stages[0]->initialize(alone);
      for (int i = 0; i < 3; ++i) stages[0]->step(alone);
      auto method = make_method<3>(name);
      method.set("max_iterations", "3");
      method.set("tolerance", "0");
      smooth(mesh, method);
      EXPECT_EQ(mesh.copied_coordinates(), alone.mesh.copied_coordinates());
    }
}

}  // namespace
}  // namespace smoothfem
