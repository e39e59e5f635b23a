// SPDX-License-Identifier: GPL-3.0-or-later
#include <fstream>

#include "studies/framework/run/kept/sealed_file.h"
#include "studies/tests/study_tests.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;

class SealedFile : public FileTest {
 protected:
  fs::path folder() const { return file("kept"); }

  void overwrite(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder() / name, std::ios::binary) << bytes;
  }

  void expect_refused(const std::string& name) const {
    EXPECT_THAT([&] { (void)read_sealed(folder(), name); },
                ::testing::ThrowsMessage<InputError>(::testing::HasSubstr(name + " is damaged")));
  }
};

TEST_F(SealedFile, ReadsBackTheWrittenContent) {
  const std::string bytes("numbers \0 and \n lines", 21);
  for (const std::string& content : {bytes, std::string(), std::string(100000, '\xff')}) {
    write_sealed(folder(), "a/7.numbers", content);
    EXPECT_EQ(read_sealed(folder(), "a/7.numbers"), content);
  }
  EXPECT_EQ(read_sealed(folder(), "a/8.numbers"), std::nullopt);
}

TEST_F(SealedFile, RefusesEveryFlippedBitAndEveryLength) {
  write_sealed(folder(), "a", "some content");
  const std::string intact = content_of(folder() / "a");
  for (std::size_t bit = 0; bit < 8 * intact.size(); ++bit) {
    std::string damaged = intact;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    overwrite("a", damaged);
    expect_refused("a");
  }
  for (std::size_t length = 0; length < intact.size(); ++length) {
    overwrite("a", intact.substr(0, length));
    expect_refused("a");
  }
  overwrite("a", intact + intact);
  expect_refused("a");
  overwrite("a", intact);
  EXPECT_EQ(read_sealed(folder(), "a"), "some content");
}

TEST_F(SealedFile, RefusesTheFileOfAnotherName) {
  write_sealed(folder(), "1.numbers", "of the first");
  write_sealed(folder(), "2.numbers", "of the other");
  fs::rename(folder() / "2.numbers", folder() / "1.numbers");
  expect_refused("1.numbers");
}

}  // namespace
}  // namespace smoothfem
