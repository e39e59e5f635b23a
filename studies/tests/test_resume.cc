// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/tests/edited_studies.h"

namespace smoothfem {
namespace {

TEST_F(Resume, PlanarStudiesKilledAtRandomMomentsEndWithTheSameRows) {
  ASSERT_EQ(run(command("planar.prm", "unbroken")), 0);
  kill_and_go_on("planar.prm", "killed", 5, 0.4);
  expect_same_but_for_times(file("unbroken"), file("killed"));
}

TEST_F(Resume, VolumeStudiesKilledAtRandomMomentsEndWithTheSameRows) {
  const auto started = std::chrono::steady_clock::now();
  ASSERT_EQ(run(command("volume.prm", "unbroken")), 0);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  kill_and_go_on("volume.prm", "killed", 6, 0.5 * seconds);
  expect_same_but_for_times(file("unbroken"), file("killed"));
  const auto points = [&](const std::string& out) {
    const std::string text = content_of(file(out) / "provenance.json");
    const auto begin = text.find("most_hexahedron_points");
    return begin == std::string::npos ? "" : text.substr(begin, text.find('}', begin) - begin);
  };
  EXPECT_NE(points("unbroken"), "");
  EXPECT_EQ(points("unbroken"), points("killed"));
}

TEST_F(EditedStudies, EndWithTheRowsOfAFreshRun) {
  edit_and_compare(4, 1);
}

TEST_F(Resume, DamagedKeptResultsAreRefused) {
  for (const std::string name : {"planar.prm", "volume.prm"}) {
    const std::string out = fs::path(name).stem();
    kill_half_done(name, out);
    ASSERT_TRUE(is_half_done(out));
    for (const std::string extension : {".numbers", ".trajectory", ".solved"}) {
      fs::remove_all(file("damaged"));
      fs::copy(file(out), file("damaged"), fs::copy_options::recursive);
      int n_damaged = 0;
      for (const auto& entry : fs::recursive_directory_iterator(file("damaged") / "kept"))
        if (entry.path().extension() == extension) {
          fs::resize_file(entry.path(), n_damaged++ % 2 == 0 ? 0 : entry.file_size() / 2);
        }
      ASSERT_GT(n_damaged, 0) << extension;
      const Outcome outcome = smoothfem({"study", name, "--out", "damaged", "--quiet"});
      EXPECT_EQ(outcome.exit_code, 2) << extension;
      EXPECT_THAT(outcome.err, ::testing::HasSubstr(extension + " is damaged: "));
      EXPECT_TRUE(fs::exists(file("damaged") / "kept"));
    }
  }
}

TEST_F(Resume, OneRunAtATimeWritesIntoAFolder) {
  fs::create_directory(file("out"));
  {
    const FolderLock lock(file("out"));
    for (const std::string more : {"--quiet", "--force"}) {
      const Outcome outcome = smoothfem({"study", "planar.prm", "--out", "out", more});
      EXPECT_EQ(outcome.exit_code, 2);
      EXPECT_THAT(outcome.err, ::testing::HasSubstr("process " + std::to_string(::getpid()) +
                                                    " is writing its results into out;"));
      EXPECT_TRUE(fs::is_empty(file("out")));
    }
  }
  // The system releases the lock of a process that is killed.
  kill_half_done("planar.prm", "out");
  EXPECT_EQ(run(command("planar.prm", "out")), 0);
}

TEST_F(Resume, ACompleteStudyRemovesWhatAKilledRunHasLeft) {
  ASSERT_EQ(run(command("planar.prm", "out")), 0);
  const auto files = files_in(file("out"));
  fs::copy(file("out") / "provenance.json", file("earlier.json"));
  for (const std::string time : {"20260101T000000Z", "20260102T000000Z"}) {
    fs::create_directories(file("out") / "earlier" / time);
    fs::copy(file("earlier.json"), file("out") / "earlier" / time / "provenance.json");
  }
  fs::create_directories(file("out") / "kept" / "smoothed-0");
  auto words = command("planar.prm", "out");
  words.insert(words.end(), {"--keep", "0"});
  ASSERT_EQ(run(words), 0);
  EXPECT_EQ(files_in(file("out")), files);
  EXPECT_FALSE(fs::exists(file("out") / "kept" / "smoothed-0"));
}

TEST_F(Resume, PlanarStudiesAreNotForSeveralProcesses) {
  EXPECT_EQ(run(command("planar.prm", "out", 2)), 2);
  EXPECT_FALSE(fs::exists(file("out")));
}

}  // namespace
}  // namespace smoothfem
