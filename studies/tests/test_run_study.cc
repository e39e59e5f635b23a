// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "meshes/distortion/distort.h"
#include "meshes/metrics/metric_statistics.h"
#include "smoothing/quality/cell_targets.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/tests/volume_meshes.h"
#include "studies/framework/results/sha256.h"
#include "studies/framework/run/run_study.h"
#include "studies/framework/run/study_meshes.h"
#include "studies/tests/documented_columns.h"
#include "studies/tests/study_tests.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;

/// Runs small studies into a temporary folder.
class RunStudy : public FileTest {
 protected:
  RunStudy() { write_mesh(file("grid.mesh"), shaken_grid(5, 0.2)); }

  Study study(const std::string& more = {}) const {
    const std::string few_cycles =
        "subsection method getme\n set sequential.max_cycles = 12\nend\n";
    return read_study(
        file_with("tiny.prm",
                  "set meshes = grid\n"
                  "set methods = laplace, getme\n"
                  "set timing runs = 1\n"
                  "subsection mesh grid\n set file = grid.mesh\nend\n" +
                      more + (more.find("set methods") == std::string::npos ? few_cycles : "")));
  }

  fs::path run(const Study& study, const std::string& folder = "out",
               unsigned int n_threads = 2) const {
    run_study(study, {.out = file(folder), .mesh_dir = {}, .quiet = true, .n_threads = n_threads});
    return file(folder);
  }

  static CsvTable table(const fs::path& folder, const std::string& name) {
    return CsvTable(content_of(folder / name));
  }
};

/// Returns the columns that an iteration and a finite element record share: all except the named
/// columns.
CsvTable::Row without(CsvTable::Row row, const std::vector<std::string>& columns) {
  for (const auto& column : columns) row.erase(column);
  return row;
}

TEST_F(RunStudy, LeavesTheseFiles) {
  auto files = files_in(run(study()));
  EXPECT_GT(std::erase_if(files, [](const auto& name) { return name.starts_with("kept/"); }), 0u);
  EXPECT_EQ(files, (std::set<std::string>{"iterations.csv", "summary.csv", "thresholds.csv",
                                          "provenance.json", "meshes/grid_initial.mesh",
                                          "meshes/grid_initial.vtu", "meshes/grid_laplace.vtu",
                                          "meshes/grid_getme.vtu"}));
}

TEST_F(RunStudy, EveryMethodBeginsWithTheInitialMesh) {
  const fs::path out = run(study());
  const CsvTable iterations = table(out, "iterations.csv");
  for (const std::string degree : {"1", "2"}) {
    const auto rows = iterations.select({{"stage", "initial"}, {"degree", degree}});
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].at("iteration"), "0");
    EXPECT_EQ(without(rows[0], {"method", "preparation_seconds"}),
              without(rows[1], {"method", "preparation_seconds"}));
    EXPECT_EQ(rows[0].at("smoothing_seconds"), "0");
    const auto initial =
        table(out, "summary.csv").select({{"method", "initial"}, {"degree", degree}});
    ASSERT_EQ(initial.size(), 1u);
    for (const std::string column : {"q_min", "q_mean", "condition_number", "cg_iterations",
                                     "e_max", "e_l2", "h1_error", "status"})
      EXPECT_EQ(initial[0].at(column), rows[0].at(column)) << column;
  }
}

TEST_F(RunStudy, MetricsAreThoseOfEveryRecordedMesh) {
  const std::string more =
      "set degrees = 1\nset record every = 2\nset metrics = mean_ratio, shape\n";
  const fs::path out = run(study(more));
  const CsvTable metrics = table(out, "metrics.csv"), iterations = table(out, "iterations.csv");
  expect_documented("metrics.csv", content_of(out / "metrics.csv"));
  ASSERT_GT(iterations.rows.size(), 4u);
  ASSERT_EQ(metrics.rows.size(), 2 * iterations.rows.size());
  for (const auto& row : iterations.rows) {
    const auto same = metrics.select({{"mesh", "grid"},
                                      {"method", row.at("method")},
                                      {"stage", row.at("stage")},
                                      {"iteration", row.at("iteration")},
                                      {"metric", "mean_ratio"}});
    ASSERT_EQ(same.size(), 1u);
    EXPECT_EQ(same[0].at("min"), row.at("q_min"));
    EXPECT_NEAR(std::stod(same[0].at("mean")), std::stod(row.at("q_mean")), 1e-14);
    EXPECT_EQ(same[0].at("better"), "larger");
    EXPECT_EQ(same[0].at("n_cells"), "25");
  }
  EXPECT_EQ(content_of(out / "metrics.csv"),
            content_of(run(study(more), "one", 1) / "metrics.csv"));
}

TEST_F(RunStudy, RefinedMeshesAreSolvedOnceMore) {
  write_mesh(file("grid.mesh"), shaken_grid(4, 0.0));
  const fs::path out = run(study("set degrees = 1, 2\nset refined degrees = 1\n"));
  expect_documented("refined.csv", content_of(out / "refined.csv"));
  const CsvTable refined = table(out, "refined.csv");
  ASSERT_EQ(refined.rows.size(), 3u);
  const CsvTable summary = table(out, "summary.csv");
  for (const auto& row : refined.rows) {
    EXPECT_EQ(row.at("n_dofs"), "81");
    EXPECT_EQ(row.at("degree"), "1");
    EXPECT_EQ(row.at("status"), "ok");
    const auto coarse = summary.select({{"method", row.at("method")}, {"degree", "1"}}).at(0);
    const double ratio = std::stod(coarse.at("h1_error")) / std::stod(row.at("h1_error"));
    EXPECT_GT(ratio, 1.5);  // the order is 1
    EXPECT_LT(ratio, 2.5);
  }
}

/// One mesh for two solutions. Both have errors, which fall below those of GETMe's mesh.
TEST_F(RunStudy, MeshesAreMadeForSeveralSolutions) {
  write_mesh(file("grid.mesh"), shaken_grid(12, 0.2));
  const std::string two =
      "set methods = getme, one, both\nset degrees = 1\nset solutions = left, low\n"
      "set record every = 1000000\nset record stages every = descent: 1\n"
      "subsection finite elements\n set load = quadrature\nend\n"
      "subsection solution left\n set u = exp(-x/3)\nend\n"
      "subsection solution low\n set u = 200*exp(-y/3)\n set diffusivity = 1 + y\nend\n"
      "subsection method one\n set type = energy-descent\n set descent.solves = 10\nend\n"
      "subsection method both\n set type = energy-descent\n set descent.solves = 20\n"
      " set smooth for = left, low\nend\n";
  const fs::path out = run(study(two));
  expect_documented("solutions.csv", content_of(out / "solutions.csv"));
  const CsvTable solutions = table(out, "solutions.csv"), summary = table(out, "summary.csv"),
                 iterations = table(out, "iterations.csv");
  ASSERT_EQ(solutions.rows.size(), 4u * 2u);
  const auto error = [&](const std::string& method, const std::string& solution) {
    const auto row = solutions.select({{"method", method}, {"solution", solution}}).at(0);
    EXPECT_EQ(row.at("status"), "ok");
    return std::stod(row.at("h1_error"));
  };
  for (const std::string method : {"initial", "getme", "one", "both"})
    EXPECT_EQ(solutions.select({{"method", method}, {"solution", "left"}}).at(0).at("h1_error"),
              summary.select({{"method", method}}).at(0).at("h1_error"));
  for (const std::string solution : {"left", "low"})
    EXPECT_LT(error("both", solution), error("getme", solution)) << solution;
  EXPECT_LT(error("one", "left"), error("both", "left"));
  EXPECT_LT(error("both", "low"), error("one", "low"));
  // The mesh needs one solve for each of the two solutions.
  for (const auto& row : iterations.select({{"method", "both"}}))
    EXPECT_EQ(std::stoi(row.at("n_solves")) % 2, 0);
  const auto provenance = nlohmann::json::parse(content_of(out / "provenance.json"));
  EXPECT_EQ(provenance.at("methods").at(2).at("smooth_for"),
            (std::vector<std::string>{"left", "low"}));
  const std::vector<std::string> timed_columns{"smoothing_seconds",    "preparation_seconds",
                                               "method_solve_seconds", "assembly_seconds",
                                               "cg_seconds",           "jacobi_cg_seconds"};
  EXPECT_EQ(
      without(iterations.select({{"method", "both"}}).back(), timed_columns),
      without(
          table(run(study(two), "one", 1), "iterations.csv").select({{"method", "both"}}).back(),
          timed_columns));
}

TEST_F(RunStudy, MetricsNeedNoSolution) {
  const fs::path out = run(study("set degrees =\nset metrics = max_angle\n"));
  const auto rows = table(out, "metrics.csv").rows;
  ASSERT_EQ(rows.size(), table(out, "iterations.csv").rows.size());
  EXPECT_EQ(rows[0].at("better"), "smaller");
}

TEST_F(RunStudy, MetricsCompareWithTheInitialMesh) {
  const fs::path out = run(study("set degrees =\nset metrics = initial_shape, initial_size\n"));
  const auto targets =
      targets_of(read_planar(out / "meshes/grid_initial.vtu").mesh, TargetKind::shape_and_size);
  const PlanarMesh result = with_targets(read_planar(out / "meshes/grid_getme.vtu").mesh, targets);
  for (const Metric* metric : metrics_named("initial_shape, initial_size")) {
    const auto rows =
        table(out, "metrics.csv").select({{"method", "getme"}, {"metric", metric->name}});
    ASSERT_GT(rows.size(), 1u);
    EXPECT_NEAR(std::stod(rows.back().at("mean")), metric_statistics(*metric, &result).mean, 1e-12);
    EXPECT_LT(std::stod(rows.back().at("min")), 0.99);
    if (metric->name == "initial_size") {  // shapes of quadrilaterals are approximated
      EXPECT_NEAR(std::stod(rows.front().at("min")), 1.0, 1e-13);
    }
  }
}

TEST_F(RunStudy, TheSummaryHasTheRowOfTheResultingMesh) {
  const fs::path out = run(study());
  const CsvTable iterations = table(out, "iterations.csv"), summary = table(out, "summary.csv");
  ASSERT_EQ(summary.rows.size(), 2u * 3u);
  for (const std::string method : {"laplace", "getme"}) {
    const PlanarMesh result = read_planar(out / "meshes" / ("grid_" + method + ".vtu")).mesh;
    for (const std::string degree : {"1", "2"}) {
      const auto row = summary.select({{"method", method}, {"degree", degree}}).at(0);
      EXPECT_EQ(std::stod(row.at("q_mean")), mesh_quality(result).q_mean);
      const auto same = iterations.select({{"method", method},
                                           {"degree", degree},
                                           {"q_min", row.at("q_min")},
                                           {"q_mean", row.at("q_mean")},
                                           {"e_max", row.at("e_max")},
                                           {"e_h1", row.at("e_h1")},
                                           {"lambda_min", row.at("lambda_min")},
                                           {"cg_iterations", row.at("cg_iterations")}});
      EXPECT_GE(same.size(), 1u) << method << " " << degree;
      EXPECT_EQ(row.at("status"), "ok");
    }
  }
  // GETMe has two stages, Laplace smoothing one.
  EXPECT_NE(summary.select({{"method", "getme"}}).at(0).at("iterations").find('/'),
            std::string::npos);
  const auto laplace = iterations.select({{"method", "laplace"}, {"degree", "1"}});
  EXPECT_EQ(summary.select({{"method", "laplace"}}).at(0).at("iterations"),
            laplace.back().at("iteration"));
}

TEST_F(RunStudy, SmoothingTimeNeverGoesBack) {
  const CsvTable iterations = table(run(study("set timing runs = 3\n")), "iterations.csv");
  double last = 0.0;
  for (const auto& row : iterations.select({{"method", "getme"}, {"degree", "1"}})) {
    EXPECT_GE(std::stod(row.at("smoothing_seconds")), last);
    last = std::stod(row.at("smoothing_seconds"));
  }
  EXPECT_GT(last, 0.0);
}

TEST_F(RunStudy, NumbersDependNeitherOnTheThreadsNorOnTheRun) {
  const std::string thresholds = "subsection thresholds\n set reference = getme\nend\n";
  const fs::path two = run(study(thresholds), "two", 2);
  expect_same_but_for_times(run(study(thresholds), "one", 1), two);
  expect_same_but_for_times(run(study(thresholds), "again", 2), two);
  EXPECT_EQ(table(two, "thresholds.csv").rows.size(), 2u * 6u);
}

TEST_F(RunStudy, MethodsThatSolveSayHowOftenAndForHowLong) {
  const CsvTable iterations =
      table(run(study("set methods = getme, energy-descent\nset degrees = 1\n"
                      "subsection method energy-descent\n set descent.solves = 4\nend\n")),
            "iterations.csv");
  for (const auto& row : iterations.select({{"method", "getme"}})) {
    EXPECT_EQ(row.at("n_solves"), "");
    EXPECT_EQ(row.at("method_solve_seconds"), "");
  }
  const auto rows = iterations.select({{"method", "energy-descent"}});
  std::vector<std::string> n_solves;
  for (const auto& row : rows) {
    n_solves.push_back(row.at("n_solves"));
    EXPECT_LE(std::stod(row.at("method_solve_seconds")), std::stod(row.at("smoothing_seconds")));
  }
  EXPECT_EQ(n_solves, (std::vector<std::string>{"0", "0", "2", "3", "4"}));
  EXPECT_LT(std::stod(rows.back().at("h1_error")), std::stod(rows[1].at("h1_error")));
}

TEST_F(RunStudy, RecordsAreThoseDueTheBestAndTheLast) {
  const std::string only =
      "set degrees = 1\nset methods = laplace\nsubsection method laplace\n"
      " set tolerance = 0\n set max_iterations = 60\nend\n";
  const fs::path all = run(study(only), "all");
  const auto every = rows_without_times(all / "iterations.csv");
  const auto result = table(all, "summary.csv").select({{"method", "laplace"}}).at(0);
  std::size_t best = 0;
  for (std::size_t r = 0; r < every.size(); ++r)
    if (every[r].at("q_min") == result.at("q_min") && every[r].at("e_max") == result.at("e_max"))
      best = r;
  ASSERT_GT(best, 0u);
  const auto expect_records = [&](const std::string& key, const auto& is_due) {
    const fs::path some = run(study(only + key), "some" + std::to_string(key.size()));
    std::vector<CsvTable::Row> expected;
    for (std::size_t r = 0; r < every.size(); ++r)
      if (is_due(r) || r == best || r + 1 == every.size()) expected.push_back(every[r]);
    ASSERT_LT(expected.size(), every.size());
    EXPECT_EQ(rows_without_times(some / "iterations.csv"), expected);
    EXPECT_EQ(rows_without_times(all / "summary.csv"), rows_without_times(some / "summary.csv"));
  };
  expect_records("set record every = 7\n", [](std::size_t r) { return r % 7 == 0; });
  // 20 records, then after 1.2 times as many iterations: 24, 28.8, 34.8, 42, ...
  const std::set<std::size_t> rare{24, 29, 35, 42, 51, 62, 75, 90, 108};
  ASSERT_LT(every.size(), 109u);
  expect_records("set record growth = 1.2\n",
                 [&](std::size_t r) { return r <= 20 || rare.contains(r); });
}

TEST_F(RunStudy, OtherDegreesThanRecordedOnesAreSolvedAtTheEnds) {
  const std::string common = "set degrees = 1, 2\nset methods = getme\n";
  const fs::path all = run(study(common), "all"),
                 ends = run(study(common + "set record degrees = 1\n"), "ends");
  EXPECT_EQ(rows_without_times(all / "summary.csv"), rows_without_times(ends / "summary.csv"));
  const auto of_degree = [&](const fs::path& out, const std::string& degree) {
    auto rows = rows_without_times(out / "iterations.csv");
    std::erase_if(rows, [&](const auto& row) { return row.at("degree") != degree; });
    return rows;
  };
  EXPECT_EQ(of_degree(ends, "1"), of_degree(all, "1"));
  const auto few = of_degree(ends, "2"), many = of_degree(all, "2");
  EXPECT_LE(few.size(), 3u);  // initial, resulting and last mesh
  EXPECT_GT(many.size(), 3u);
  EXPECT_EQ(few.front(), many.front());
  EXPECT_EQ(few.back(), many.back());
}

TEST_F(RunStudy, WithoutDegreesItOnlySmooths) {
  const fs::path out = run(study("set degrees =\n"));
  const CsvTable iterations = table(out, "iterations.csv");
  EXPECT_GT(iterations.rows.size(), 4u);
  for (const auto& row : iterations.rows) {
    EXPECT_EQ(row.at("degree") + row.at("e_max") + row.at("n_dofs"), "");
    EXPECT_EQ(row.at("status"), "not solved");
  }
  EXPECT_EQ(table(out, "summary.csv").rows.size(), 3u);
  EXPECT_GT(std::stod(table(out, "summary.csv").rows[2].at("q_mean")),
            std::stod(table(out, "summary.csv").rows[0].at("q_mean")));
}

TEST_F(RunStudy, WithoutDegreesCellsMayBePentagons) {
  write_mesh(file("grid.mesh"), mixed_mesh(true));
  EXPECT_EQ(table(run(study("set degrees =\n")), "summary.csv").rows.size(), 3u);
}

TEST_F(RunStudy, InvalidMeshesHaveRowsWithoutSolutions) {
  write_mesh(file("grid.mesh"), arrow_head());
  const fs::path out = run(study("set methods = weighted-laplace, smart-laplace\n"));
  for (const std::string name : {"iterations.csv", "summary.csv"}) {
    const auto rows = table(out, name).select({{"method", "weighted-laplace"}});
    EXPECT_GE(rows.size(), 2u) << name;
    for (const auto& row : rows) {
      if (row.at("n_invalid") == "0") continue;  // the initial mesh
      EXPECT_EQ(row.at("status"), "invalid mesh");
      for (const std::string column :
           {"n_dofs", "condition_number", "cg_iterations", "e_max", "l2_error"})
        EXPECT_EQ(row.at(column), "") << column;
    }
    EXPECT_GT(std::stoi(rows.back().at("n_invalid")), 0) << "else this test tests nothing";
  }
  for (const auto& row : table(out, "summary.csv").select({{"method", "smart-laplace"}}))
    EXPECT_EQ(row.at("status"), "ok");
}

TEST_F(RunStudy, TheSeriesHasAStepForEveryRecord) {
  const fs::path out =
      run(study("set write series = true\nset degrees = 1\nset record every = 10\n"));
  for (const std::string method : {"laplace", "getme"}) {
    const auto n = table(out, "iterations.csv").select({{"method", method}}).size();
    const std::string pvd = content_of(out / "meshes" / ("grid_" + method + ".pvd"));
    std::size_t n_steps = 0;
    for (std::size_t at = pvd.find("<DataSet"); at != std::string::npos;
         at = pvd.find("<DataSet", at + 1))
      ++n_steps;
    EXPECT_EQ(n_steps, n);
    std::size_t n_files = 0;
    for (const auto& entry : fs::directory_iterator(out / "meshes" / ("grid_" + method))) {
      EXPECT_NO_THROW(read_mesh(entry.path()));
      ++n_files;
    }
    EXPECT_EQ(n_files, n);
  }
}

TEST_F(RunStudy, ExpressionsGiveTheNumbersOfTheNamedSolution) {
  const std::string own = R"(
subsection solution
  set name     = expression
  set value    = 40*sin((x+1)*(y-1)/2) + 60
  set gradient = 20*(y-1)*cos((x+1)*(y-1)/2) ; 20*(x+1)*cos((x+1)*(y-1)/2)
  set load     = 10*((x+1)^2 + (y-1)^2)*sin((x+1)*(y-1)/2)
end
)";
  const auto named = table(run(study(), "named"), "summary.csv").rows;
  const auto parsed = table(run(study(own), "parsed"), "summary.csv").rows;
  ASSERT_EQ(named.size(), parsed.size());
  for (std::size_t r = 0; r < named.size(); ++r) {
    EXPECT_EQ(named[r].at("cg_iterations"), parsed[r].at("cg_iterations"));
    for (const std::string column : {"e_max", "e_mean", "e_l2", "e_h1", "l2_error", "h1_error"}) {
      const double expected = std::stod(named[r].at(column));
      EXPECT_NEAR(std::stod(parsed[r].at(column)), expected, 1e-9 * expected) << column;
    }
  }
}

TEST_F(RunStudy, ExpressionsInTheSpaceAreFoundToRoundOff) {
  const std::string own = R"(
set degrees = 2
subsection solution
  set name     = expression
  set value    = x*x - 2*x*y + 3*y
  set gradient = 2*x - 2*y ; 3 - 2*x
  set load     = -2
end
subsection finite elements
  set cg tolerance = 1e-13
end
)";
  for (const auto& row : table(run(study(own)), "summary.csv").rows) {
    EXPECT_EQ(row.at("status"), "ok");
    EXPECT_LT(std::stod(row.at("e_max")), 1e-10);
    EXPECT_LT(std::stod(row.at("h1_error")), 1e-10);
  }
}

/// Writes the other tests' grid to a file with groups: sides of x = 0 are "left", other sides
/// "rest".
void write_grid_with_groups(const fs::path& path) {
  const PlanarMesh grid = shaken_grid(5, 0.2);
  MeshLabels labels;
  labels.names = {{{1, 1}, "left"}, {{1, 2}, "rest"}};
  const Topology& topology = grid.topology();
  for (std::size_t f = 0; f < topology.boundary_facets().size(); ++f) {
    const auto side = topology.boundary_facets()[f];
    labels.facets.append(side);
    labels.facet_tags.push_back(
        grid.coordinates()[side[0]].x() == 0.0 && grid.coordinates()[side[1]].x() == 0.0 ? 1 : 2);
  }
  write_mesh(path, PlanarMesh(std::make_shared<const Topology>(2, grid.n_nodes(), topology.cells(),
                                                               std::nullopt, std::move(labels)),
                              grid.copied_coordinates()));
}

TEST_F(RunStudy, AFormulaWithDiffusivityAndNaturalConditionsIsFoundToRoundOff) {
  write_grid_with_groups(file("groups.msh"));
  const auto own = [&](const std::string& more) {
    return read_study(file_with("own.prm",
                                "set meshes = grid\nset methods = laplace, getme\n"
                                "set timing runs = 1\nset degrees = 2\n"
                                "subsection mesh grid\n set file = groups.msh\nend\n"
                                "subsection finite elements\n set cg tolerance = 1e-13\nend\n"
                                "subsection solution\n set u = x*x - 2*x*y + 3*y\n" +
                                    more + "end\n"));
  };
  const fs::path out = run(own("set diffusivity = 2, 1 ; 1, 3\nset natural = group rest\n"));
  const auto rows = table(out, "summary.csv").rows;
  EXPECT_EQ(rows.size(), 3u);
  for (const auto& row : rows) {
    EXPECT_EQ(row.at("status"), "ok");
    EXPECT_EQ(row.at("n_dofs"), "121");
    EXPECT_EQ(row.at("n_free"), "110") << "all but the 11 on the left side";
    EXPECT_LT(std::stod(row.at("e_max")), 1e-10);
    EXPECT_LT(std::stod(row.at("h1_error")), 1e-10);
  }
  const auto json = nlohmann::json::parse(content_of(out / "provenance.json"));
  EXPECT_THAT(json.dump(),
              testing::AllOf(testing::HasSubstr("x*x - 2*x*y + 3*y"),
                             testing::HasSubstr("2, 1 ; 1, 3"), testing::HasSubstr("group rest")));
  // Another problem has other results, in the same folder, too.
  run(own("set natural = group rest\n"));
  EXPECT_NE(table(out, "summary.csv").rows.at(0).at("cg_iterations"),
            rows.at(0).at("cg_iterations"));
  const auto refused = [&](const std::string& more) {
    return input_error_of([&] { run(own(more), "refused"); });
  };
  EXPECT_THAT(refused("set natural = nowhere\n"),
              testing::HasSubstr("the mesh has the groups 1 (left), 2 (rest)"));
  EXPECT_THAT(refused("set natural = left, rest\n"),
              testing::HasSubstr("remove a group from 'natural'"));
  EXPECT_THAT(refused("set diffusivity = if(x < 2.5, 1, 2)\n"), testing::HasSubstr("normal flux"));
  EXPECT_THAT(refused("set diffusivity = x - 2\n"), testing::HasSubstr("not positive definite"));
  EXPECT_EQ(files_in(file("refused")), std::set<std::string>{});
}

TEST_F(RunStudy, AFormulaGivesTheNumbersOfTheNamedSolution) {
  const std::string own = "subsection solution\n set u = 40*sin((x+1)*(y-1)/2) + 60\nend\n";
  const auto named = table(run(study(), "named"), "summary.csv").rows;
  const auto derived = table(run(study(own), "derived"), "summary.csv").rows;
  ASSERT_EQ(named.size(), derived.size());
  for (std::size_t r = 0; r < named.size(); ++r) {
    EXPECT_EQ(named[r].at("cg_iterations"), derived[r].at("cg_iterations"));
    for (const std::string column : {"e_max", "e_mean", "e_l2", "e_h1", "l2_error", "h1_error"}) {
      const double expected = std::stod(named[r].at(column));
      EXPECT_NEAR(std::stod(derived[r].at(column)), expected, 1e-9 * expected) << column;
    }
  }
}

TEST_F(RunStudy, AMeshOfAllTypesOfVolumeCellsIsSolvedOn) {
  write_mesh(file("box.vtu"), test::box_mesh(3, 3, 6, test::BoxCells::mixed));
  const auto own = read_study(
      file_with("box.prm",
                "set dimension = 3\nset meshes = box\nset methods = laplace\nset timing runs = 1\n"
                "set degrees = 1\nsubsection mesh box\n set file = box.vtu\nend\n"
                "subsection solution\n set u = 1 + 2*x - 3*y + z/2\n set diffusivity = 2\nend\n"
                "subsection finite elements\n set cg tolerance = 1e-13\nend\n"));
  const auto rows = table(run(own), "summary.csv").rows;
  EXPECT_EQ(rows.size(), 2u);
  for (const auto& row : rows) {
    EXPECT_EQ(row.at("status"), "ok");
    EXPECT_LT(std::stod(row.at("e_max")), 1e-10);
  }
}

TEST_F(RunStudy, WrongExpressionsAreRefusedBeforeAnythingIsWritten) {
  const auto wrong = study(
      "subsection solution\n set name = expression\n set value = x*x\n set gradient = x ; 0\n"
      " set load = -2\nend\n");
  EXPECT_NE(input_error_of([&] { run(wrong); }), "");
  EXPECT_EQ(files_in(file("out")), std::set<std::string>{});
}

TEST_F(RunStudy, ProvenanceSaysWhereEverythingComesFrom) {
  const fs::path out = run(study("subsection method getme\n set simultaneous.lambda = 0.4\nend\n"));
  const auto json = nlohmann::json::parse(content_of(out / "provenance.json"));
  EXPECT_EQ(json.at("status"), "complete");
  EXPECT_EQ(json.at("study"), "tiny");
  EXPECT_EQ(json.at("scale"), "default");
  EXPECT_EQ(json.at("built_in"), false);
  for (const std::string key : {"version", "commit", "compiler", "flags"})
    EXPECT_FALSE(json.at("program").at(key).get<std::string>().empty()) << key;
  EXPECT_TRUE(json.at("program").at("uncommitted_changes").is_boolean());
  for (const std::string library : {"deal.II", "Eigen", "Gmsh", "Spectra", "Trilinos", "VTK"})
    EXPECT_FALSE(json.at("program").at("libraries").at(library).get<std::string>().empty());
  EXPECT_FALSE(json.at("machine").at("cpu").get<std::string>().empty());
  EXPECT_EQ(json.at("machine").at("finite_element_threads"), 2);
  for (const std::string phase : {"meshes", "smoothing", "finite_elements", "writing"})
    EXPECT_GE(json.at("seconds").at(phase).get<double>(), 0.0) << phase;

  const auto& mesh = json.at("meshes").at(0);
  EXPECT_EQ(mesh.at("seed"), 1);
  EXPECT_EQ(mesh.at("n_cells"), 25);
  EXPECT_EQ(mesh.at("published"), false);
  EXPECT_EQ(mesh.at("origin"), file("grid.mesh").string());
  EXPECT_EQ(json.at("methods").at(0).at("name"), "laplace");
  EXPECT_EQ(json.at("methods").at(1).at("parameters").at("simultaneous.lambda"), 0.4);

  // The checksum must be that of coreutils.
  const fs::path initial = out / mesh.at("file").get<std::string>();
  FILE* pipe = ::popen(("sha256sum '" + initial.string() + "'").c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  char digits[65] = {};
  EXPECT_EQ(std::fread(digits, 1, 64, pipe), 64u);
  ::pclose(pipe);
  EXPECT_EQ(mesh.at("sha256"), std::string(digits));
  EXPECT_EQ(read_planar(initial).mesh.copied_coordinates(),
            shaken_grid(5, 0.2).copied_coordinates());
}

TEST_F(RunStudy, ProvenanceNamesTheInitialMeshesOfSurfacesToo) {
  const Study roof = read_study(file_with("roof.prm", R"(
set surface = true
set meshes = roof
set methods = smart-laplace
set degrees =
set timing runs = 1
subsection mesh roof
  set domain = roof
  set edge scale = 3
end
)"));
  const fs::path out = run(roof);
  const auto json = nlohmann::json::parse(content_of(out / "provenance.json"));
  const auto& mesh = json.at("meshes").at(0);
  const std::string name = mesh.at("file");
  ASSERT_TRUE(fs::exists(out / name)) << name;
  EXPECT_NO_THROW(read_mesh(out / name));
  EXPECT_EQ(mesh.at("sha256"), sha256_of_file(out / name));
}

TEST_F(RunStudy, ProvenanceHasTheParametersOfTheScale) {
  const Study quick =
      read_study(file_with("tiny.prm",
                           "set meshes = grid\nset methods = laplace\nset degrees =\n"
                           "set scales = quick\nset timing runs = 3\n"
                           "subsection mesh grid\n set file = grid.mesh\nend\n"
                           "subsection scale quick\n set timing runs = 1\nend\n"),
                 "quick");
  const auto json = nlohmann::json::parse(content_of(run(quick) / "provenance.json"));
  EXPECT_EQ(json.at("scale"), "quick");
  EXPECT_EQ(json.at("parameters").at("timing runs"), "1");
}

TEST_F(RunStudy, PublishedMeshesAreTakenAsTheyAre) {
  fs::create_directory(file("published"));
  write_mesh(file("published") / "p.mesh", shaken_grid(4, 0.1));
  const auto with_published = study(
      "set degrees =\nsubsection mesh grid\n set published file = p.mesh\n set distort to = 0.5\n"
      "end\n");
  run_study(with_published, {.out = file("out"), .mesh_dir = file("published"), .quiet = true});
  const auto json = nlohmann::json::parse(content_of(file("out") / "provenance.json"));
  EXPECT_EQ(json.at("meshes").at(0).at("published"), true);
  EXPECT_EQ(json.at("meshes").at(0).at("origin"), "p.mesh");
  EXPECT_EQ(json.at("meshes").at(0).at("n_cells"), 16);
  EXPECT_EQ(json.at("meshes").at(0).at("q_mean"), mesh_quality(shaken_grid(4, 0.1)).q_mean);
}

TEST_F(RunStudy, DistortsAsTheStudySays) {
  const fs::path out = run(read_study(file_with("distorted.prm", R"(
set meshes = steps, within
set methods = laplace
set degrees =
set timing runs = 1
subsection mesh steps
  set file = grid.mesh
  set distort to = 0.6
  set distortion = random-steps
  set distortion sweeps = 3
  set distortion least quality = 0.2
  set seed = 4
end
subsection mesh within
  set file = grid.mesh
  set distort within = 0.5
  set distortion candidates = 3
  set distortion least quality = 0.3
end
)")));
  PlanarMesh steps = shaken_grid(5, 0.2), within = steps;
  distort(steps, {.target_q_mean = 0.6,
                  .seed = 4,
                  .kind = DistortionKind::random_steps,
                  .n_sweeps = 3,
                  .min_quality = 0.2});
  distort_within(within, 0.5, {.n_candidates = 3, .min_quality = 0.3});
  const auto written = [&](const char* name) {
    return std::get<PlanarMesh>(
        read_mesh(out / "meshes" / (std::string(name) + "_initial.mesh")).mesh);
  };
  EXPECT_EQ(written("steps").copied_coordinates(), steps.copied_coordinates());
  EXPECT_EQ(written("within").copied_coordinates(), within.copied_coordinates());
}

TEST_F(RunStudy, GeneratesDistortsAndSmoothsAGear) {
  const Study gear = read_study(file_with("gear.prm", R"(
set meshes = tri, quad
set methods = smart-laplace, getme
set degrees = 1
set edge scale = 3
set timing runs = 1
set record every = 1000
subsection mesh tri
  set domain = gear
  set distort to = 0.45
end
subsection mesh quad
  set domain = gear
  set elements = quadrilaterals
  set distort to = 0.45
end
)"));
  const CsvTable summary = table(run(gear), "summary.csv");
  ASSERT_EQ(summary.rows.size(), 6u);
  for (const auto& row : summary.rows) {
    EXPECT_EQ(row.at("status"), "ok");
    EXPECT_EQ(row.at("n_invalid"), "0");
    if (row.at("method") == "initial")
      EXPECT_NEAR(std::stod(row.at("q_mean")), 0.45, 1e-4);
    else
      EXPECT_GT(std::stod(row.at("q_mean")), 0.8) << row.at("mesh") << row.at("method");
  }
}

TEST_F(RunStudy, RefusesInvalidMeshesBeforeAnythingIsWritten) {
  PlanarMesh inverted = shaken_grid(5, 0.0);
  inverted.coordinates()[7] = {4.5, 4.5};  // an inner node, far outside of its cells
  write_mesh(file("inverted.mesh"), inverted);
  const auto bad = study(
      "set meshes = grid, bad\nsubsection mesh bad\n set file = inverted.mesh\n"
      "end\n");
  const std::string message = input_error_of([&] { run(bad); });
  EXPECT_NE(message.find(file("inverted.mesh").string()), std::string::npos) << message;
  EXPECT_EQ(files_in(file("out")), std::set<std::string>{});
  EXPECT_NE(input_error_of([&] { run(study("subsection mesh grid\n set file = no.mesh\nend\n")); }),
            "");
  EXPECT_EQ(files_in(file("out")), std::set<std::string>{});
}

TEST_F(RunStudy, RefusesPentagonsBeforeAnythingIsWritten) {
  write_mesh(file("grid.mesh"), mixed_mesh(true));
  EXPECT_NE(input_error_of([&] { run(study()); }), "");
  EXPECT_EQ(files_in(file("out")), std::set<std::string>{});
}

TEST_F(RunStudy, AFailedStartLeavesOlderResultsAlone) {
  const fs::path out = run(study("set degrees =\n"));
  const std::string before = content_of(out / "provenance.json");
  fs::remove(file("grid.mesh"));
  EXPECT_NE(input_error_of([&] { run(study()); }), "");
  EXPECT_EQ(content_of(out / "provenance.json"), before);
}

TEST_F(RunStudy, ACompleteRunIsLeftAsItIs) {
  const fs::path out = run(study());
  const std::string provenance = content_of(out / "provenance.json");
  const auto written = fs::last_write_time(out / "iterations.csv");
  EXPECT_EQ(run(study()), out);
  EXPECT_EQ(content_of(out / "provenance.json"), provenance);
  EXPECT_EQ(fs::last_write_time(out / "iterations.csv"), written);
}

TEST_F(RunStudy, RemovesUnfinishedFilesOfAKilledRun) {
  const fs::path out = run(study("set degrees =\n"));
  const auto files = files_in(out);
  std::string provenance = content_of(out / "provenance.json");
  const std::string complete = R"("status": "complete")";
  provenance.replace(provenance.find(complete), complete.size(), R"("status": "running")");
  file_with("out/provenance.json", provenance);
  for (const std::string name : {".provenance.4711.12.json", "meshes/.grid_getme.4711.13.vtu"})
    file_with("out/" + name, "half");
  run(study("set degrees =\n"));
  EXPECT_EQ(files_in(out), files);
}

TEST_F(RunStudy, ComputesWhatIsNewAndSetsTheOldAside) {
  const fs::path out = run(study());
  const std::string before = content_of(out / "iterations.csv");
  const auto sessions = [&] {
    std::map<std::string, std::set<std::string>> all;  // by method, with its degrees
    const auto json = nlohmann::json::parse(content_of(out / "provenance.json"));
    for (const auto& result : json.at("results")) all[result.at("method")].insert(result.dump());
    return all;
  };
  const auto first = sessions();
  std::this_thread::sleep_for(std::chrono::seconds(1));  // sessions are named by their second
  run(study("subsection method getme\n set sequential.rho = 0.5\nend\n"));
  const auto second = sessions();
  EXPECT_EQ(first.at("laplace"), second.at("laplace"));
  EXPECT_EQ(first.at("initial"), second.at("initial"));
  EXPECT_NE(first.at("getme"), second.at("getme"));
  std::vector<fs::path> earlier;
  for (const auto& entry : fs::directory_iterator(out / "earlier")) earlier.push_back(entry.path());
  ASSERT_EQ(earlier.size(), 1u);
  EXPECT_EQ(content_of(earlier[0] / "iterations.csv"), before);
  // Kept results are those of these and the earlier results, so going back computes nothing.
  run(study());
  EXPECT_EQ(sessions(), first);
  EXPECT_EQ(content_of(out / "iterations.csv"), before);
}

TEST_F(RunStudy, RetimesAllMethodsAndSolvesNothing) {
  const fs::path out = run(study());
  const auto rows = rows_without_times(out / "iterations.csv");
  const auto session = [&](const std::string& what) {
    std::set<std::string> all;
    const auto json = nlohmann::json::parse(content_of(out / "provenance.json"));
    for (const auto& result : json.at("results"))
      if (result.contains(what)) all.insert(result.at(what).dump());
    return all;
  };
  const auto smoothed = session("smoothed"), solved = session("solved");
  std::this_thread::sleep_for(std::chrono::seconds(1));
  run_study(study(), {.out = out, .mesh_dir = {}, .quiet = true, .retime = true});
  EXPECT_NE(session("smoothed"), smoothed);
  EXPECT_EQ(session("smoothed").size(), 1u);
  EXPECT_EQ(session("solved"), solved);
  EXPECT_EQ(rows_without_times(out / "iterations.csv"), rows);
}

TEST_F(RunStudy, ForceStartsAnewAndKeepsTheOldFolder) {
  const fs::path out = run(study());
  const std::string old = content_of(out / "iterations.csv");
  const auto forced = [&] {
    run_study(study("set record every = 3\n"),
              {.out = out, .mesh_dir = {}, .force = true, .quiet = true});
  };
  forced();
  EXPECT_EQ(content_of(file("out_1") / "iterations.csv"), old);
  EXPECT_NE(content_of(out / "iterations.csv"), old);
  forced();
  EXPECT_TRUE(fs::exists(file("out_2") / "summary.csv"));
}

TEST_F(RunStudy, ForceChecksEverythingBeforeItRenamesAFolder) {
  const fs::path out = run(study());
  const std::string old = content_of(out / "iterations.csv");
  const auto refused = [&](const std::string& more) {
    return input_error_of([&] {
      run_study(study(more), {.out = out, .mesh_dir = {}, .force = true, .quiet = true});
    });
  };
  EXPECT_NE(refused("subsection solution\n set name = sine\n set natural = group none\nend\n"), "");
  EXPECT_NE(refused("subsection solution\n set u = 1/(x - x)\nend\n"), "");
  EXPECT_EQ(content_of(out / "iterations.csv"), old);
  EXPECT_FALSE(fs::exists(file("out_1")));
}

TEST_F(RunStudy, NumbersThatOverflowAreRefused) {
  const auto refused = [&](const std::string& solution) {
    return input_error_of([&] { run(study("subsection solution\n" + solution + "end\n")); });
  };
  EXPECT_THAT(refused(" set u = 1e300*x^3\n"), ::testing::HasSubstr("is above 1e100"));
  EXPECT_THAT(refused(" set u = x\n set diffusivity = 1e-300\n"),
              ::testing::HasSubstr("'diffusivity'"));
}

TEST_F(RunStudy, RefusesFoldersItCannotMake) {
  file_with("regular", "content");
  const std::string message = input_error_of([&] { run(study("set degrees =\n"), "regular/out"); });
  EXPECT_NE(message.find("regular"), std::string::npos) << message;
  EXPECT_EQ(content_of(file("regular")), "content");
}

}  // namespace
}  // namespace smoothfem
