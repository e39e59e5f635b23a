// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/atomic_file.h"
#include "meshes/tests/mesh_tests.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;
using AtomicFile = FileTest;

TEST_F(AtomicFile, CreatesFoldersAndReplacesTheFile) {
  const auto path = file("a/b/c.txt");
  write_atomically(path, "first, and longer");
  write_atomically(path, "second");
  EXPECT_EQ(content_of(path), "second");
  EXPECT_EQ(n_entries("a/b"), 1u);
}

TEST_F(AtomicFile, TheTemporaryIsNextToTheTargetWithItsExtension) {
  const auto path = file("mesh.vtu");
  std::filesystem::path temporary;
  write_atomically(path, [&](const std::filesystem::path& given) {
    temporary = given;
    EXPECT_FALSE(std::filesystem::exists(path));
    std::ofstream(given) << "x";
  });
  EXPECT_EQ(temporary.extension(), ".vtu");
  EXPECT_EQ(temporary.parent_path(), path.parent_path());
  EXPECT_FALSE(std::filesystem::exists(temporary));
}

TEST_F(AtomicFile, AFailedWriteKeepsTheOldFileAndLeavesNoTemporary) {
  const auto path = file_with("kept.txt", "old");
  const std::string message = input_error_of([&] {
    write_atomically(path, [](const std::filesystem::path& temporary) {
      std::ofstream(temporary) << "half of";
      throw std::runtime_error("the pen broke");
    });
  });
  EXPECT_EQ(message, "cannot write " + path.string() + ": the pen broke");
  EXPECT_EQ(content_of(path), "old");
  EXPECT_EQ(n_entries(), 1u);
}

TEST_F(AtomicFile, AWriterThatWritesNothingIsAnError) {
  EXPECT_THAT(input_error_of([&] { write_atomically(file("x"), [](const auto&) {}); }),
              HasSubstr("No such file"));
}

TEST_F(AtomicFile, NamesTargetAndReasonIfTheFolderCannotBeCreated) {
  EXPECT_EQ(input_error_of([] { write_atomically("/dev/null/x/y.csv", "text"); }),
            "cannot write /dev/null/x/y.csv: the folder /dev/null/x cannot be created (Not a "
            "directory)");
  const auto below_a_file = file_with("file", "text") / "y.csv";
  EXPECT_THAT(input_error_of([&] { write_atomically(below_a_file, "text"); }),
              HasSubstr("cannot be created"));
}

TEST_F(AtomicFile, RefusesFoldersAndDevices) {
  EXPECT_THAT(input_error_of([&] { write_atomically(file(""), "text"); }),
              HasSubstr("it is not a file name"));
  EXPECT_THAT(input_error_of([&] { write_atomically(file("").parent_path(), "text"); }),
              HasSubstr("is a folder"));
  EXPECT_THAT(input_error_of([] { write_atomically("/dev/full", "text"); }),
              HasSubstr("not a regular file"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST_F(AtomicFile, AShortWriteIsAnError) {
  const auto path = file_with("kept.txt", "old");
  const std::string message = [&] {
    const FullDisk disk(1000);
    return input_error_of([&] { write_atomically(path, std::string(5000, 'x')); });
  }();
  EXPECT_EQ(message, "cannot write " + path.string() + ": File too large");
  EXPECT_EQ(content_of(path), "old");
  EXPECT_EQ(n_entries(), 1u);
}

}  // namespace
}  // namespace smoothfem
