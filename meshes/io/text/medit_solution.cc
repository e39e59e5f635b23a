// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/text/medit_solution.h"

#include <array>
#include <cctype>

#include "meshes/io/atomic_file.h"
#include "meshes/io/line_reader.h"
#include "smoothing/base/text.h"

namespace smoothfem {

namespace {

constexpr std::string_view section_prefix = "SolAt";

/// Scalars, vectors and symmetric tensors have the types 1, 2 and 3.
std::array<std::size_t, 4> components_of_types(int dimension) {
  return {0, 1, dimension == 2 ? 2u : 3u, dimension == 2 ? 3u : 6u};
}

class SolutionReader {
 public:
  SolutionReader(const std::filesystem::path& path, std::string_view content)
      : reader_(path, content) {}

  MeditSolution solution() {
    if (word("the first word") != "MeshVersionFormatted")
      reader_.fail("the first word is not 'MeshVersionFormatted'");
    count("the version");
    while (reader_.find_word('#')) {
      const std::string keyword(reader_.word());
      if (keyword == "End") break;
      if (keyword == "Dimension") {
        solution_.dimension = static_cast<int>(count("the dimension"));
        if (solution_.dimension < 2 || solution_.dimension > 3)
          reader_.fail("the dimension must be 2 or 3");
      } else if (keyword.starts_with(section_prefix)) {
        read_section(keyword.substr(section_prefix.size()));
      } else {
        reader_.fail("the section " + in_quotes(keyword) + " is not known");
      }
    }
    return std::move(solution_);
  }

 private:
  std::string_view word(std::string_view what) {
    reader_.require_word(what, '#');
    return reader_.word();
  }
  std::size_t count(std::string_view what) {
    reader_.require_word(what, '#');
    return reader_.integer(what);
  }

  void read_section(std::string of) {
    MeditSolutionSection section{
        .of = std::move(of), .n_rows = count("the number of rows"), .fields = {}};
    const std::size_t n_fields = count("the number of fields");
    if (section.n_rows > reader_.rest().size() || n_fields > reader_.rest().size())
      reader_.fail("the section announces more numbers than the file has");
    const auto components = components_of_types(solution_.dimension);
    std::size_t n_numbers = 0;
    for (std::size_t f = 0; f < n_fields; ++f) {
      const std::size_t type = count("the type of a field");
      if (type < 1 || type > 3) reader_.fail("the type of a field must be 1, 2 or 3");
      section.fields.push_back(
          {.name = medit_solution_name(f), .n_components = components[type], .values = {}});
      n_numbers += components[type];
    }
    if (n_numbers > 0 && section.n_rows > reader_.rest().size() / n_numbers)
      reader_.fail("the section announces more numbers than the file has");
    for (std::size_t i = 0; i < section.n_rows; ++i)
      for (MeshField& field : section.fields)
        for (std::size_t k = 0; k < field.n_components; ++k) {
          reader_.require_word("a value", '#');
          std::get<std::vector<double>>(field.values).push_back(reader_.number("a value"));
        }
    solution_.sections.push_back(std::move(section));
  }

  LineReader reader_;
  MeditSolution solution_;
};

}  // namespace

std::string medit_solution_name(std::size_t i) {
  return std::string(medit_solution_field) + (i == 0 ? "" : "_" + std::to_string(i + 1));
}

bool is_medit_solution(const MeshField& field) {
  const std::size_t n = field.n_components;
  return field.name.starts_with(medit_solution_field) && (n <= 3 || n == 6);
}

std::filesystem::path medit_solution_path(const std::filesystem::path& mesh) {
  return std::filesystem::path(mesh).replace_extension(".sol");
}

MeditSolution read_medit_solution(const std::filesystem::path& path) {
  const std::string content = read_whole_file(path);
  return SolutionReader(path, content).solution();
}

void write_medit_solution(const std::filesystem::path& path, const MeditSolution& solution) {
  const auto components = components_of_types(solution.dimension);
  std::string text =
      "MeshVersionFormatted 2\nDimension " + std::to_string(solution.dimension) + "\n";
  for (const MeditSolutionSection& section : solution.sections) {
    text.append(section_prefix).append(section.of).append("\n");
    text += std::to_string(section.n_rows) + "\n" + std::to_string(section.fields.size());
    for (const MeshField& field : section.fields)
      text += field.n_components == 1 ? " 1" : field.n_components == components[2] ? " 2" : " 3";
    for (std::size_t i = 0; i < section.n_rows; ++i) {
      char before = '\n';
      for (const MeshField& field : section.fields)
        for (std::size_t k = 0; k < field.n_components; ++k) {
          append_number(text += before, field.number(i * field.n_components + k));
          before = ' ';
        }
    }
    text += "\n";
  }
  write_atomically(path, text + "End\n");
}

}  // namespace smoothfem
