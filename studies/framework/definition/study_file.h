// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "smoothing/base/input_error.h"
#include "smoothing/base/text.h"
#include "studies/framework/definition/included_files.h"
#include "studies/framework/definition/study_header.h"

/// Functions for reading study files of all kinds.
namespace smoothfem {

/// Enters a subsection for as long as it lives.
class Subsection {
 public:
  Subsection(dealii::ParameterHandler& parameters, const std::string& name)
      : parameters_(parameters) {
    parameters_.enter_subsection(name);
  }
  ~Subsection() { parameters_.leave_subsection(); }
  Subsection(const Subsection&) = delete;

 private:
  dealii::ParameterHandler& parameters_;
};

/// Calls a function, and adds the file to its InputError messages.
template <class Call>
decltype(auto) in_file(const std::filesystem::path& file, const Call& call) {
  try {
    return call();
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

/// Returns the unchanged text of a study file. Throws InputError if it cannot be read.
std::string read_study_text(const std::filesystem::path& file);

/// Reads the values of declared keys. Throws InputError with file and line for bad values, and for
/// undeclared keys unless skip_undefined is set.
void parse_study(dealii::ParameterHandler& p, const StudyText& text, bool skip_undefined);

/// Throws InputError if the label has other characters than letters, digits, '.', '_' and '-'.
void check_label(const std::string& label, const std::string& what, const std::string& file);

/// Returns the scales that a study file lists. Throws InputError unless the scale is empty or one
/// of them.
std::vector<std::string> known_scales(const dealii::ParameterHandler& lists,
                                      const std::string& scale, const std::string& file);

/// A line of a study file, without its comment and without blanks around its parts.
struct StudyLine {
  enum class Kind { subsection, end, set, other } kind = Kind::other;
  std::string name{};   ///< of the subsection, with single blanks, or of the key
  std::string value{};  ///< of the key
};

/// Reads a line of any length, as deal.II does.
StudyLine study_line(std::string_view line);

/// Returns the keys that a text sets in subsections of its top level: subsection and key.
std::vector<std::pair<std::string, std::string>> keys_of_sections(const StudyText& text);

/// Returns the lines of the keys that a text sets in a subsection of its top level, or in the top
/// level itself for an empty name; the last one of each key.
std::map<std::string, std::string> lines_of_section(const StudyText& text,
                                                    const std::string& section);

/// Returns a message with the line of the key or group that it names in quotes, or else of 'u' or
/// 'value'; unchanged if none is known.
std::string with_line(const std::map<std::string, std::string>& lines, const std::string& message);

/// Calls a function, and adds file and line to its InputError messages, as with_line.
template <class Call>
decltype(auto) at_line(const std::map<std::string, std::string>& lines, const Call& call) {
  try {
    return call();
  } catch (const InputError& error) {
    throw InputError(with_line(lines, error.what()));
  }
}

/// Returns all keys with their present values.
StudyParameters all_parameters(dealii::ParameterHandler& p);

/// Declares the list of a study's scales.
void declare_scales(dealii::ParameterHandler& p);

/// Sets keys to the scale's values, if the scale is not empty: numbers that are not 0, and lists
/// that are not empty. A list may be the key of a subsection: "SUBSECTION/KEY". Throws InputError
/// for values that these keys cannot have.
void apply_scale(dealii::ParameterHandler& p, const std::string& scale, const std::string& file,
                 const std::vector<std::string>& numbers,
                 const std::vector<std::string>& lists = {});

/// Returns all declared keys as a study file, with their meanings and defaults.
std::string commented_keys(dealii::ParameterHandler& p);

/// Declares the common keys of studies whose results are tables (table_study.h): kind, title,
/// scales.
void declare_table_study(dealii::ParameterHandler& p, const std::string& kind);

/// Declares the subsection of a scale, which may change these whole numbers.
void declare_table_scale(dealii::ParameterHandler& p, const std::string& scale,
                         const std::vector<std::string>& numbers);

/// Reads a study file into p, in which all keys except those of the scales' subsections are
/// declared. numbers: whole numbers that scales may change. Afterwards p has the values of the
/// chosen scale. Throws InputError as read_study does.
StudyHeader read_table_study(dealii::ParameterHandler& p, const std::filesystem::path& file,
                             const std::string& scale, const std::vector<std::string>& numbers);

}  // namespace smoothfem
