// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>

#include "smoothing/polygons/limit_polygons.h"
#include "studies/kinds/polygons/classification.h"
#include "studies/kinds/polygons/theorem_check.h"
#include "studies/kinds/study_kinds.h"
#include "studies/tests/documented_columns.h"

namespace smoothfem {
namespace {

class PolygonStudies : public FileTest {
 protected:
  PolygonStudy read(const std::string& text, const std::string& scale = {}) const {
    return read_polygon_study(file_with("my.prm", "set kind = polygons\n" + text), scale);
  }
  /// Returns a small study of everything.
  PolygonStudy tiny() const {
    return read(
        "set nodes = 3, 4, 5, 6\nset cases = 2\nset theta points = 5\nset lambda points = 5\n"
        "set domain points = 6\n");
  }
};

CsvTable table(const PolygonStudy& study, const std::string& file) {
  for (const auto& entry : polygon_tables(study))
    if (entry.file == file) return CsvTable(entry.compute());
  ADD_FAILURE() << file;
  return CsvTable("\n");
}

/// Returns a field as a number, also if it is too small for std::stod.
double number(const CsvTable::Row& row, const std::string& column) {
  return std::strtod(row.at(column).c_str(), nullptr);
}

TEST_F(PolygonStudies, ColumnsAreTheDocumentedOnes) {
  for (const auto& entry : polygon_tables(tiny())) {
    ASSERT_FALSE(documented_columns(entry.file).empty()) << entry.file;
    expect_documented(entry.file, entry.compute());
  }
}

TEST_F(PolygonStudies, AllTheoremsHold) {
  const CsvTable theorems = table(tiny(), "theorems.csv");
  std::set<std::string> names;
  for (const auto& row : theorems.rows) {
    EXPECT_EQ(row.at("holds"), "true") << row.at("theorem") << ": " << row.at("quantity");
    EXPECT_GT(std::stoul(row.at("cases")), 0u) << row.at("theorem");
    names.insert(row.at("theorem"));
  }
  for (const std::string name : {"Proposition 2.1", "Theorem 2.2", "Theorem 2.4", "Theorem 2.5",
                                 "Theorem 2.9", "Theorem 2.10", "Theorem 2.11", "Theorem 2.12",
                                 "Theorem 2.13", "Napoleon", "Petr-Douglas-Neumann"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST_F(PolygonStudies, LimitsThatAreNotReachedDoNotHold) {
  PolygonStudy study = tiny();
  study.steps = 3;
  std::set<std::string> broken;
  for (const auto& row : combined_theorems(study))
    if (!row.holds) broken.insert(row.theorem);
  EXPECT_EQ(broken, std::set<std::string>{"Theorem 2.13"});
}

TEST_F(PolygonStudies, ClassificationAgreesWithIteration) {
  const CsvTable rows = table(tiny(), "classification.csv");
  std::set<std::string> domains;
  for (const auto& row : rows.rows) {
    EXPECT_EQ(row.at("agree"), "true") << row.at("n") << ' ' << row.at("theta");
    EXPECT_EQ(row.at("predicted"), row.at("iterated"));
    domains.insert(row.at("predicted"));
  }
  EXPECT_EQ(domains, (std::set<std::string>{"D_0", "D_1", "D_2", "D_3", "S_0", "S_1", "S_2"}));
}

TEST(Classification, TooFewIterationsNearALineDisagree) {
  const double theta = 0.6, lambda = intersection_line(5, 3, theta) + 1e-7;
  EXPECT_EQ(classify_by_iteration(5, theta, lambda, 30, 1).iterated, "D_1");
  const auto early = classify_by_iteration(5, theta, lambda, 10, 1);
  EXPECT_EQ(early.predicted, "D_1");
  EXPECT_EQ(early.iterated, "S_1");
  EXPECT_FALSE(early.agree());
}

TEST(TheoremChecks, KeepTheWorstCaseAndFail) {
  TheoremCheck equal("", "", "", 0.1);
  equal.equal(1.0, 1.0);
  equal.equal(2.05, 2.0);
  equal.equal(3.01, 3.0);
  EXPECT_TRUE(equal.row().holds);
  EXPECT_EQ(equal.row().measured, 2.05);
  EXPECT_EQ(equal.row().cases, 3u);
  equal.equal(4.2, 4.0);
  equal.equal(5.0, 5.0);
  EXPECT_FALSE(equal.row().holds);
  EXPECT_NEAR(equal.row().max_deviation, 0.2, 1e-15);

  TheoremCheck bound("", "", "", 0.0);
  bound.at_most(0.5, 1.0);
  EXPECT_EQ(bound.row().max_deviation, 0.0);
  EXPECT_TRUE(bound.row().holds);
  bound.at_most(1.5, 1.0);
  EXPECT_FALSE(bound.row().holds);
  EXPECT_EQ(bound.row().max_deviation, 0.5);

  TheoremCheck above("", "", "", 0.0);
  above.above(1e-300, 0.0);
  EXPECT_TRUE(above.row().holds);
  above.above(0.0, 0.0);
  EXPECT_FALSE(above.row().holds);

  TheoremCheck no_number("", "", "", 1.0);
  no_number.equal(std::numeric_limits<double>::quiet_NaN(), 0.0);
  EXPECT_FALSE(no_number.row().holds);
}

TEST_F(PolygonStudies, PicturesShowWhatTheyShould) {
  const PolygonStudy study = tiny();
  // The sum of the eigenpolygons is the polygon.
  const CsvTable parts = table(study, "decomposition.csv");
  for (const auto& node : parts.select({{"n", "6"}, {"eigenpolygon", ""}})) {
    double x = 0.0;
    for (const auto& row : parts.select({{"n", "6"}, {"node", node.at("node")}}))
      if (!row.at("eigenpolygon").empty()) x += number(row, "x");
    EXPECT_NEAR(x, number(node, "x"), 1e-14);
  }
  // Fig. 2.12 has one pair of parameters of every domain and line.
  const CsvTable sequences = table(study, "sequences.csv");
  for (const std::string domain : {"D_0", "S_0", "D_1", "S_1", "D_2", "S_2", "D_3"})
    EXPECT_EQ(
        sequences.select({{"transformation", "combined"}, {"domain", domain}, {"step", "100"}})
            .size(),
        6u)
        << domain;
  for (const auto& row : table(study, "side_ratios.csv").rows)
    if (std::stoi(row.at("step")) > 1) {
      EXPECT_LE(number(row, "defect"), number(row, "bound") + 1e-14);
    }
}

TEST_F(PolygonStudies, ScalesChangeSizesOnly) {
  const std::string text =
      "set cases = 7\nset scales = small\nsubsection scale small\n  set theta points = 3\nend\n";
  EXPECT_EQ(read(text).cases, 7u);
  EXPECT_EQ(read(text, "small").cases, 7u);
  EXPECT_EQ(read(text, "small").theta_points, 3u);
  EXPECT_NE(read(text).theta_points, 3u);
  EXPECT_THROW(read(text, "huge"), InputError);
  const auto in_force = [&](const std::string& scale) {
    const auto parameters = read(text, scale).header.parameters;
    return std::map<std::string, std::string>(parameters.begin(), parameters.end());
  };
  auto expected = in_force("");
  expected["theta points"] = "3";
  EXPECT_EQ(in_force("small"), expected);
  EXPECT_EQ(read(text, "small").header.file_parameters, read(text).header.parameters);
}

TEST_F(PolygonStudies, BadFilesAreRefusedInOneSentence) {
  for (const auto& [text, said] : std::vector<std::pair<std::string, std::string>>{
           {"set nodes = 2\n", "my.prm:2"},
           {"set meshes = a\n", "my.prm:2"},
           {"set sequences = 1/16\n", "'1/16' cannot be read"},
           {"set sequences = 1/16: S3\n", "S0 to S2"},
           {"set sequences = 1/16: 0.5 x\n", "cannot be read"},
           {"set sequences = 1/16: S2\n", "out of range"},  // as printed in Fig. 2.12
           {"set sequences = 9/16: 0.5\n", "theta"}}) {
    const std::string content = text;
    const std::string message = input_error_of([&] { read(content); });
    EXPECT_NE(message.find(said), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace smoothfem
