// SPDX-License-Identifier: GPL-3.0-or-later
#include <regex>
#include <set>

#include "smoothing/loop/smooth.h"
#include "studies/tests/command_line.h"

// What README.md shows has to work. Its smoother is compiled into this executable.

namespace smoothfem {
namespace {

namespace fs = std::filesystem;

const fs::path root = SMOOTHFEM_SOURCE_DIR;

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line.substr(0, line.find('#')));
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

class Readme : public CommandLine {
 protected:
  /// The words after `./run` of every line in a fenced block that begins with it.
  static std::vector<std::vector<std::string>> commands() {
    std::vector<std::vector<std::string>> found;
    std::ifstream readme(root / "README.md");
    bool fenced = false;
    for (std::string line; std::getline(readme, line);) {
      if (line.starts_with("```")) fenced = !fenced;
      if (fenced && line.starts_with("./run ")) found.push_back(words_of(line.substr(6)));
    }
    return found;
  }

  /// What `run` passes on to the program, and what it does by itself.
  static std::set<std::string> commands_of_run() {
    std::set<std::string> names;
    std::ifstream script(root / "run");
    std::smatch match;
    for (std::string line; std::getline(script, line);)
      if (std::regex_search(line, match, std::regex("^  ([a-z|]+)\\) "))) {
        std::istringstream labels(match[1]);
        for (std::string label; std::getline(labels, label, '|');) names.insert(label);
      }
    return names;
  }
};

TEST_F(Readme, ItsCommandsAndOptionsExist) {
  ASSERT_GE(commands().size(), 5u);
  for (const auto& command : commands()) {
    ASSERT_FALSE(command.empty());
    EXPECT_TRUE(commands_of_run().contains(command[0])) << "./run " << command[0];
    if (command[0] != "study") continue;
    const std::string help = smoothfem({"study", "--help"}).out;
    for (const auto& word : command) {
      if (word.starts_with("-")) {
        EXPECT_NE(help.find(word), std::string::npos) << word;
      }
    }
    ASSERT_GE(command.size(), 2u);
    if (command[1].ends_with(".prm") || command[1].starts_with("-")) continue;
    // A study, or a word that the script itself knows: `all`.
    EXPECT_TRUE(fs::exists(root / "studies" / (command[1] + ".prm")) ||
                content_of(root / "run").find(" " + command[1] + ") ") != std::string::npos)
        << command[1];
  }
}

TEST_F(Readme, ItsCommandsRun) {
  write_mesh(file("in.vtu"), mixed_mesh(true));
  write_mesh(file("in.msh"), mixed_mesh(false));
  for (const auto& command : commands()) {
    if (!std::set<std::string>{"smooth", "quality", "generate", "list"}.contains(command[0]))
      continue;
    const Outcome outcome = smoothfem(command);
    EXPECT_EQ(outcome.exit_code, 0) << command[0] << ": " << outcome.err;
    EXPECT_EQ(outcome.err, "") << command[0];
  }
}

TEST_F(Readme, OptionsInItsTextExist) {
  std::string help = content_of(root / "run");
  for (const std::string command : {"study", "smooth", "quality", "generate", "list"})
    help += smoothfem({command, "--help"}).out;
  const std::string text = content_of(root / "README.md") + content_of(root / "results/README.md");
  const std::regex option("[ `]--[a-z][a-z-]*");
  std::size_t n_found = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), option), end; at != end; ++at, ++n_found)
    EXPECT_NE(help.find(at->str().substr(1)), std::string::npos) << at->str();
  EXPECT_GT(n_found, 3u);
}

TEST_F(Readme, ItsSmootherIsAMethod) {
  Method<2> method = make_method<2>("half-laplace");
  PlanarMesh mesh = shaken_grid(8, 0.2);
  const double before = mesh_quality(mesh).q_mean;
  const SmoothingResult result = smooth(mesh, method);
  EXPECT_GT(result.quality.q_mean, before);
  EXPECT_EQ(result.quality.n_invalid, 0u);
}

}  // namespace
}  // namespace smoothfem
