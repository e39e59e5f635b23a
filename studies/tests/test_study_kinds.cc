// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>

#include "studies/tests/command_line.h"

// Studies of all kinds through the command line.

namespace smoothfem {
namespace {

const std::string polygons =
    "set kind = polygons\nset title = Mine\nset nodes = 3, 4\nset cases = 2\nset steps = 1500\n"
    "set theta points = 4\nset lambda points = 4\nset domain points = 4\n";

TEST_F(CommandLine, RunsAStudyOfPolygons) {
  file_with("my.prm", polygons);
  const Outcome outcome = smoothfem({"study", "my.prm"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const CsvTable theorems(content_of(file("results/my/theorems.csv")));
  EXPECT_GT(theorems.rows.size(), 30u);
  EXPECT_EQ(theorems.select({{"holds", "true"}}).size(), theorems.rows.size());
  const CsvTable classified(content_of(file("results/my/classification.csv")));
  EXPECT_EQ(classified.select({{"agree", "true"}}).size(), classified.rows.size());
  const auto json = nlohmann::json::parse(content_of(file("results/my/provenance.json")));
  EXPECT_EQ(json.at("status"), "complete");
  EXPECT_EQ(json.at("study_title"), "Mine");
  EXPECT_EQ(json.at("parameters").at("kind"), "polygons");
  EXPECT_EQ(json.at("built_in"), false);
  EXPECT_EQ(json.at("seconds").size(), files_in(file("results/my")).size() - 1);
}

TEST_F(CommandLine, PolygonStudiesAreRunAgainOnlyIfTheyChanged) {
  file_with("my.prm", polygons);
  ASSERT_EQ(smoothfem({"study", "my.prm", "--quiet"}).exit_code, 0);
  const std::string provenance = content_of(file("results/my/provenance.json"));
  const Outcome again = smoothfem({"study", "my.prm"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.err.find("nothing to do"), std::string::npos) << again.err;
  EXPECT_EQ(content_of(file("results/my/provenance.json")), provenance);

  ASSERT_EQ(smoothfem({"study", "my.prm", "--out", "other", "--quiet"}).exit_code, 0);
  for (const auto& name : files_in(file("other"))) {
    if (name.ends_with(".csv")) {
      EXPECT_EQ(content_of(file("other/" + name)), content_of(file("results/my/" + name))) << name;
    }
  }

  file_with("my.prm", polygons + "set seed = 2\n");
  const Outcome changed = smoothfem({"study", "my.prm"});
  EXPECT_EQ(changed.exit_code, 0);
  EXPECT_NE(changed.err.find("seed was '1' and is '2'"), std::string::npos) << changed.err;
  EXPECT_NE(content_of(file("results/my/sequences.csv")), content_of(file("other/sequences.csv")));
  // The replaced results are kept, and so are the results that --force replaces.
  const std::filesystem::path earlier =
      std::filesystem::directory_iterator(file("results/my/earlier"))->path();
  EXPECT_EQ(content_of(earlier / "provenance.json"), provenance);
  EXPECT_EQ(content_of(earlier / "sequences.csv"), content_of(file("other/sequences.csv")));
  const std::string second = content_of(file("results/my/provenance.json"));
  ASSERT_EQ(smoothfem({"study", "my.prm", "--force", "--quiet"}).exit_code, 0);
  EXPECT_EQ(content_of(file("results/my_1/provenance.json")), second);
}

TEST_F(CommandLine, TheQuickScaleOfTheBuiltInPolygonStudyHolds) {
  ASSERT_EQ(smoothfem({"study", "polygons", "--quick", "--quiet"}).exit_code, 0);
  EXPECT_EQ(content_of(file("results/polygons/theorems.csv")).find(",false"), std::string::npos);
  EXPECT_EQ(content_of(file("results/polygons/classification.csv")).find(",false"),
            std::string::npos);
  EXPECT_EQ(
      nlohmann::json::parse(content_of(file("results/polygons/provenance.json"))).at("built_in"),
      true);
}

TEST_F(CommandLine, RefusesUnknownKindsAndListsTheKnownOnes) {
  file_with("my.prm", "set kind = polygon\n");
  const Outcome outcome = smoothfem({"study", "my.prm"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find(
                "my.prm: there is no study kind 'polygon'; did you mean 'polygons'? choose one of "
                "collection, polygons, regularization, smoothing"),
            std::string::npos)
      << outcome.err;
}

TEST_F(CommandLine, RefusesUnknownStudiesAndNamesTheNearestOne) {
  const Outcome outcome = smoothfem({"study", "geer"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("there is no study 'geer'; did you mean 'gear'? choose one of "),
            std::string::npos)
      << outcome.err;
  const Outcome path = smoothfem({"study", "./geer.prm"});
  EXPECT_EQ(path.exit_code, 2);
  EXPECT_NE(path.err.find("./geer.prm: cannot read this study file"), std::string::npos)
      << path.err;
}

TEST_F(CommandLine, TheProvenanceOfAScaleHasItsParameters) {
  file_with("my.prm", polygons +
                          "set scales = small\nsubsection scale small\n"
                          " set cases = 1\nend\n");
  ASSERT_EQ(smoothfem({"study", "my.prm", "--scale", "small", "--quiet"}).exit_code, 0);
  const auto json = nlohmann::json::parse(content_of(file("results/my/provenance.json")));
  EXPECT_EQ(json.at("scale"), "small");
  EXPECT_EQ(json.at("parameters").at("cases"), "1");
  EXPECT_EQ(json.at("parameters").at("nodes"), "3, 4");
  // The same scale is the same run; another scale is not.
  EXPECT_NE(smoothfem({"study", "my.prm", "--scale", "small"}).err.find("nothing to do"),
            std::string::npos);
  const Outcome other = smoothfem({"study", "my.prm"});
  EXPECT_EQ(other.exit_code, 0);
  EXPECT_NE(other.err.find("--scale was 'small' and is ''"), std::string::npos) << other.err;
}

TEST_F(CommandLine, StudyKeysOfEveryKindAreListed) {
  const Outcome keys = smoothfem({"list", "--study-keys"});
  for (const std::string key : {"kind smoothing", "set meshes", "kind polygons", "set doublings"})
    EXPECT_NE(keys.out.find(key), std::string::npos) << key;
}

TEST_F(CommandLine, OptionsThatPolygonStudiesDoNotHaveAreRefused) {
  file_with("my.prm", polygons);
  const Outcome outcome = smoothfem({"study", "my.prm", "--mesh-dir", "."});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("--mesh-dir"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace smoothfem
