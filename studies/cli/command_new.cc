// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/stat.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "meshes/io/atomic_file.h"
#include "smoothing/base/data_folder.h"
#include "smoothing/base/text.h"
#include "smoothing/loop/catalogue.h"
#include "studies/cli/commands.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

/// What a folder of templates is for.
struct Kind {
  const char* what;       ///< for example "smoother"
  const char* templates;  ///< folder below launcher/
};

constexpr Kind smoother{"smoother", "new_smoother"}, problem{"problem", "new_problem"};

struct NewArguments {
  std::string name;
  bool python = false, command = false;
};

/// "half-laplace" as HalfLaplace, half_laplace, and half laplace.
struct Spellings {
  std::string name, class_name, file_name, words;
};

Spellings spellings(const std::string& name) {
  Spellings made{name, "", "", ""};
  bool begins = true;
  for (const char c : name) {
    if (c != '-') made.class_name += begins ? static_cast<char>(std::toupper(c)) : c;
    made.file_name += c == '-' ? '_' : c;
    made.words += c == '-' ? ' ' : c;
    begins = c == '-';
  }
  return made;
}

/// The folder that the program is installed or built in; find_package finds it there.
fs::path prefix() {
  return fs::canonical("/proc/self/exe").parent_path().parent_path().parent_path();
}

std::string filled_in(std::string text, const Spellings& s) {
  for (const auto& [mark, value] : {std::pair<std::string, std::string>{"@name@", s.name},
                                    {"@Name@", s.class_name},
                                    {"@file@", s.file_name},
                                    {"@words@", s.words},
                                    {"@prefix@", prefix().string()}})
    for (auto at = text.find(mark); at != std::string::npos;
         at = text.find(mark, at + value.size()))
      text.replace(at, mark.size(), value);
  return text;
}

/// True for words of lower-case letters and digits with '-' between them, such as half-laplace.
bool is_name(const std::string& name) {
  constexpr std::size_t longest = 100;  // the name is part of names of files
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto is_allowed = [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '-';
  };
  return !name.empty() && name.size() <= longest && is_letter(name.front()) && name.back() != '-' &&
         name.find("--") == std::string::npos && std::all_of(name.begin(), name.end(), is_allowed);
}

void make_folder(const Kind& kind, const NewArguments& arguments) {
  if (!is_name(arguments.name))
    throw InputError("a " + std::string(kind.what) + " cannot be called '" +
                     shortened(arguments.name) +
                     "'; use at most 100 lower-case letters, digits and '-', as in half-laplace");
  if (fs::exists(arguments.name))
    throw InputError("a file or folder '" + arguments.name +
                     "' exists here; choose another name or another folder");
  if (arguments.name == "poisson")
    throw InputError("'poisson' is the program's own solver; choose another name");
  for (const auto& info : method_catalogue(true))
    if (info.name == arguments.name)
      throw InputError("a method '" + arguments.name + "' exists; choose another name");
  const char* language = arguments.python ? "python" : arguments.command ? "command" : "cpp";
  const fs::path templates = data_folder() / "launcher" / kind.templates / language;
  if (!fs::is_directory(templates))
    throw InputError("the folder " + templates.string() + " is missing; install the program anew");
  const Spellings names = spellings(arguments.name);
  for (const auto& entry : fs::directory_iterator(templates)) {
    const fs::path made = fs::path(arguments.name) /
                          filled_in(entry.path().stem().string(), names);  // without .template
    write_atomically(made, filled_in(file_content(entry.path()), names));
    if ((fs::status(entry.path()).permissions() & fs::perms::owner_exec) != fs::perms::none)
      fs::permissions(made, fs::perms::owner_exec, fs::perm_options::add);
  }
  std::printf("%s/README.md says what to do next:\n\n", arguments.name.c_str());
  std::fputs(file_content(fs::path(arguments.name) / "README.md").c_str(), stdout);
}

}  // namespace

void add_new_smoother_command(CLI::App& app) {
  auto arguments = std::make_shared<NewArguments>();
  auto* command = add_subcommand(app, "new-smoother");
  command->add_option("name", arguments->name, "name of the smoother, for example half-laplace")
      ->required();
  auto* python = command->add_flag("--python", arguments->python, "in Python (default: in C++)");
  command
      ->add_flag("--command", arguments->command,
                 "as an external program that reads a mesh file and writes another")
      ->excludes(python);
  add_examples(*command,
               {"smoothfem new-smoother half-laplace", "smoothfem new-smoother mine --python"});
  command->callback([arguments] { make_folder(smoother, *arguments); });
}

void add_new_problem_command(CLI::App& app) {
  auto arguments = std::make_shared<NewArguments>();
  auto* command = add_subcommand(app, "new-problem");
  command->add_option("name", arguments->name, "name of the problem, for example heat-flow")
      ->required();
  command->add_flag("--python", arguments->python,
                    "in Python with scipy (default: in C++ with deal.II)");
  add_examples(*command,
               {"smoothfem new-problem heat-flow", "smoothfem new-problem mine --python"});
  command->callback([arguments] { make_folder(problem, *arguments); });
}

}  // namespace smoothfem
