// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace smoothfem {
namespace {

namespace fs = std::filesystem;

/// Folders of studies/. Each may include files of the folders before it.
const std::vector<std::string> rooms{"framework/solvers",
                                     "framework/definition",
                                     "framework/results",
                                     "framework/run",
                                     "kinds",
                                     "cli"};

/// Returns the index of the folder that contains a path below studies/; rooms.size() if none does.
std::size_t room_of(const std::string& path) {
  std::size_t room = 0;
  while (room < rooms.size() && !path.starts_with(rooms[room] + "/")) ++room;
  return room;
}

TEST(Rooms, IncludeThoseBeforeThemOnly) {
  const fs::path root = fs::path(SMOOTHFEM_SOURCE_DIR) / "studies";
  const std::regex include("#include \"studies/(.*)\"");
  std::vector<std::size_t> n_files(rooms.size() + 1);
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string path = fs::relative(entry.path(), root);
    if (!(path.ends_with(".h") || path.ends_with(".cc")) || path.starts_with("tests/") ||
        path.starts_with("bench/"))
      continue;
    const std::size_t room = room_of(path);
    ++n_files[room];
    std::ifstream lines(entry.path());
    std::smatch match;
    for (std::string line; std::getline(lines, line);)
      if (std::regex_match(line, match, include)) {
        EXPECT_LE(room_of(match[1]), room) << path << ": " << line;
      }
  }
  EXPECT_EQ(n_files.back(), 0u) << "sources in no room";
  n_files.pop_back();
  EXPECT_THAT(n_files, testing::Each(testing::Gt(0u)));
}

}  // namespace
}  // namespace smoothfem
