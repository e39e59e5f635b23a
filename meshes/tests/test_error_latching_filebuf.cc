// SPDX-License-Identifier: GPL-3.0-or-later
#include <ostream>

#include "meshes/io/error_latching_filebuf.h"
#include "meshes/tests/mesh_tests.h"

namespace smoothfem {
namespace {

using ErrorLatching = FileTest;

std::string reason_of_finish(ErrorLatchingFilebuf& file) {
  try {
    file.finish();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

constexpr int many = 100'000;  // bytes; the buffer of a file has a few thousand

TEST_F(ErrorLatching, WritesAllData) {
  ErrorLatchingFilebuf file(ErrorLatching::file("a"));
  std::ostream stream(&file);
  std::string expected;
  for (int i = 0; i < many; ++i) {
    stream << i << ' ';
    stream.put('x');
    expected += std::to_string(i) + " x";
  }
  EXPECT_EQ(reason_of_finish(file), "");
  EXPECT_EQ(content_of(ErrorLatching::file("a")), expected);
}

/// All writes fail: single characters, blocks larger than the buffer, and the rest at the end. The
/// stream reports no error, so that no writer stops early.
TEST_F(ErrorLatching, AcceptsMoreBytesThanItsBufferHoldsOnAFullDevice) {
  for (const std::streamsize block : {0, 10, 5000, 20'000}) {
    SCOPED_TRACE(block);
    ErrorLatchingFilebuf file("/dev/full");
    std::ostream stream(&file);
    const std::string bytes(static_cast<std::size_t>(block), 'b');
    for (int i = 0; i < many; ++i) {
      stream.put('c');
      if (i % 1000 == 0) stream.write(bytes.data(), block).flush();
    }
    EXPECT_TRUE(stream.good());
    EXPECT_EQ(reason_of_finish(file), "No space left on device");
  }
}

TEST_F(ErrorLatching, DropsDataThatDoNotFitOnTheDisk) {
  const auto path = file("a");
  {
    ErrorLatchingFilebuf file(path);
    std::ostream stream(&file);
    {
      const FullDisk disk(10'000);
      for (int i = 0; i < many; ++i) stream.put('c');
      stream.flush();
    }
    for (int i = 0; i < many; ++i)
      stream.put('d');  // there is room again, but some data are missing
    EXPECT_TRUE(stream.good());
    EXPECT_EQ(reason_of_finish(file), "File too large");
  }
  EXPECT_EQ(content_of(path), std::string(10'000, 'c'));
}

TEST_F(ErrorLatching, NeedsNoFinish) {
  ErrorLatchingFilebuf file("/dev/full");
  std::ostream(&file) << std::string(many, 'x') << "and some left";
}

TEST_F(ErrorLatching, ReportsWhyAFileCannotBeOpened) {
  ErrorLatchingFilebuf file("/dev/null/x");
  std::ostream(&file) << "text";
  EXPECT_EQ(reason_of_finish(file), "Not a directory");
}

}  // namespace
}  // namespace smoothfem
