// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "studies/tests/resume_tests.h"

namespace smoothfem {

/// Edits a study at random, kills its run at a random moment, runs it to its end, and compares the
/// results with those of a run from nothing.
class EditedStudies : public Resume {
 protected:
  EditedStudies() {
    write_mesh(file("a.mesh"), shaken_grid(5, 0.2));
    write_mesh(file("b.mesh"), shaken_grid(4, 0.15));
  }

  /// Makes n edits. The first ones are of all kinds, in random order.
  void edit_and_compare(int n, unsigned int seed) {
    random_.seed(seed);
    const std::vector<std::function<void()>> edits = {
        [&] {
          toggle(methods_, {"laplace", "smart-laplace", "weighted-laplace", "getme"});
        },
        [&] {
          toggle(meshes_, {"a", "b", "made"});
        },
        [&] {
          toggle(degrees_, {"1", "2"});
        },
        [&] {
          toggle(solutions_, {"ramp", "wave"});
        },
        [&] {
          toggle(refined_, {"1", "2"});
        },
        [&] {
          toggle(metrics_, {"shape", "aspect_ratio"});
        },
        [&] {
          choose(settings_["set title"], {"One", "Two", "Three"});
        },
        [&] {
          choose(settings_["set record every"], {"1", "2", "5"});
        },
        [&] {
          choose(settings_["set seeds"], {"1", "2", "1, 2"});
        },
        [&] {
          choose(settings_["set write series"], {"true", "false"});
        },
        [&] {
          choose(u_, {"x*y + exp(x/5)", "sin(x)", "sin(x)*y"});
        },
        [&] {
          choose(diffusivity_, {"1 + x/5", "2, 0 ; 0, 1"});
        },
        [&] {
          choose(tolerance_, {"1e-8", "1e-10"});
        },
        [&] {
          choose(stop_at_, {"0.1", "0.03", "0.01"});
        },
        [&] {
          choose(reference_, {"", "first"});
        },
        [&] { write_mesh(file("a.mesh"), shaken_grid(5, below(2) == 0 ? 0.2 : 0.1)); }};
    std::vector<std::size_t> order(edits.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), random_);
    for (int i = 0; i < n; ++i) {
      const auto kind = static_cast<std::size_t>(i) < order.size()
                            ? order[static_cast<std::size_t>(i)]
                            : below(edits.size());
      edits[kind]();
      SCOPED_TRACE("edit " + std::to_string(i) + ":\n" + text());
      file_with("edited.prm", text());
      auto words = command("edited.prm", "edited");
      words.insert(words.end(), {"--keep", "0"});
      const pid_t child = start(words);
      std::this_thread::sleep_for(std::chrono::milliseconds(below(500)));
      kill_and_wait(child);
      ASSERT_EQ(run(words), 0);
      fs::remove_all(file("fresh"));
      ASSERT_EQ(run(command("edited.prm", "fresh")), 0);
      expect_same_but_for_times(file("edited"), file("fresh"));
      for (const std::string name : {"refined.csv", "metrics.csv", "solutions.csv"})
        if (fs::exists(file("fresh") / name)) {
          EXPECT_EQ(rows_without_times(file("edited") / name),
                    rows_without_times(file("fresh") / name));
        }
      if (HasFailure()) return;
    }
  }

 private:
  std::size_t below(std::size_t n) { return random_() % n; }

  void choose(std::string& value, const std::vector<std::string>& values) {
    value = values[below(values.size())];
  }

  /// Adds or removes one of the values. The set does not become empty, where that is not allowed.
  void toggle(std::set<std::string>& chosen, const std::vector<std::string>& values) {
    const std::string& value = values[below(values.size())];
    if (chosen.erase(value) == 0) chosen.insert(value);
    if (chosen.empty() && (&chosen == &methods_ || &chosen == &meshes_)) chosen.insert(value);
  }

  static std::string list(const std::set<std::string>& names) {
    std::string text;
    for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
  }

  std::string text() const {
    std::string text = "set timing runs = 1\nset meshes = " + list(meshes_) +
                       "\nset methods = " + list(methods_) + "\nset degrees = " + list(degrees_) +
                       "\nset metrics = " + list(metrics_) + "\n";
    std::set<std::string> refined, solutions;
    if (!degrees_.empty()) {
      std::set_intersection(refined_.begin(), refined_.end(), degrees_.begin(), degrees_.end(),
                            std::inserter(refined, refined.end()));
      solutions = solutions_;
    }
    text += "set refined degrees = " + list(refined) + "\n";
    if (!solutions.empty()) text += "set solutions = " + list(solutions) + "\n";
    for (const auto& [key, value] : settings_) text += key + " = " + value + "\n";
    for (const std::string mesh : {"a", "b"})
      if (meshes_.contains(mesh))
        text += "subsection mesh " + mesh + "\n set file = " + mesh + ".mesh\nend\n";
    if (meshes_.contains("made"))
      text +=
          "subsection mesh made\n set domain = square\n set edge scale = 10\n"
          " set distort to = 0.7\nend\n";
    if (methods_.contains("weighted-laplace"))
      text += "subsection method weighted-laplace\n set tolerance = " + stop_at_ + "\nend\n";
    const std::string solution =
        " set u = " + u_ + "\n set diffusivity = " + diffusivity_ + "\nend\n";
    if (solutions.empty()) text += "subsection solution\n" + solution;
    for (const auto& label : solutions)
      text += "subsection solution " + label + "\n" +
              (label == "ramp" ? solution : " set u = x + y*y\nend\n");
    text += "subsection finite elements\n set cg tolerance = " + tolerance_ + "\nend\n";
    if (!reference_.empty() && !degrees_.empty())
      text += "subsection thresholds\n set reference = " + *methods_.begin() + "\nend\n";
    return text;
  }

  std::mt19937 random_;
  std::set<std::string> methods_{"laplace", "getme"}, meshes_{"a"}, degrees_{"1"}, solutions_,
      refined_, metrics_;
  std::map<std::string, std::string> settings_;
  std::string u_ = "x*y + exp(x/5)", diffusivity_ = "1 + x/5", tolerance_ = "1e-8",
              stop_at_ = "0.01", reference_;
};

}  // namespace smoothfem
