// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the target of every file of fuzz/corpus/ in the ordinary build, within limits of time and
// memory. Valid files, from which fuzzers start, have names that begin with "valid".
#include <chrono>

#include "fuzz/targets.h"
#include "meshes/tests/mesh_tests.h"

namespace smoothfem::fuzz {

void PrintTo(const Target& target, std::ostream* out) {
  *out << target.name;
}

namespace {

std::vector<Target> all_targets() {
  auto targets = mesh_targets();
  for (const auto& target : study_targets()) targets.push_back(target);
  return targets;
}

class Corpus : public ::testing::TestWithParam<Target> {
 protected:
  static std::filesystem::path folder() {
    return std::filesystem::path(SMOOTHFEM_SOURCE_DIR) / "fuzz" / "corpus" / GetParam().name;
  }
};

TEST_P(Corpus, KeepsAllRules) {
  std::size_t n_valid = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    SCOPED_TRACE(entry.path());
    const std::string content = content_of(entry.path());
    const LittleMemory memory(rlim_t{256} << 20);
    const auto start = std::chrono::steady_clock::now();
    bool is_read = false;
    EXPECT_NO_THROW(is_read = GetParam().run(
                        {reinterpret_cast<const std::uint8_t*>(content.data()), content.size()}));
    const bool is_valid = entry.path().filename().string().starts_with("valid");
    EXPECT_TRUE(is_read || !is_valid);
    n_valid += is_valid;
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  }
  EXPECT_GT(n_valid, 0u);
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, ::testing::ValuesIn(all_targets()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace smoothfem::fuzz
