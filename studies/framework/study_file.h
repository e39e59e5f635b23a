#pragma once

#include <deal.II/base/parameter_handler.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "smoothing/mesh/input_error.h"

/// What reading a study file takes, whatever the kind of study.
namespace smoothfem {

/// The items of "a, b, c", without the blanks around them; empty items do not count.
std::vector<std::string> split_list(const std::string& text);

/// For calls whose errors do not know which file they are about.
template <class Call>
auto in_file(const std::filesystem::path& file, const Call& call) {
  try {
    return call();
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

/// The text of a study file; throws InputError if it cannot be read.
std::string read_study_text(const std::filesystem::path& file);

/// Fills the keys declared. Throws InputError with file and line for bad values, and for keys that
/// are not declared unless they are to be skipped.
void parse_study(dealii::ParameterHandler& p, const std::string& text,
                 const std::filesystem::path& file, bool skip_undefined);

/// Throws InputError unless the label has letters, digits, '.', '_' and '-' only.
void check_label(const std::string& label, const std::string& what, const std::string& file);

/// Throws InputError unless the scale is empty or known.
void require_scale(const std::string& scale, const std::vector<std::string>& known,
                   const std::string& file);

/// "key = value" lines in force, subsections as prefix.
std::vector<std::pair<std::string, std::string>> effective_parameters(dealii::ParameterHandler& p);

}  // namespace smoothfem
