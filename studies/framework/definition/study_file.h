// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <filesystem>
#include <string>
#include <vector>

#include "smoothing/base/input_error.h"
#include "smoothing/base/text.h"
#include "studies/framework/definition/included_files.h"
#include "studies/framework/definition/study_header.h"

/// What reading a study file takes, whatever the kind of study.
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

/// For calls whose errors do not know which file they are about.
template <class Call>
decltype(auto) in_file(const std::filesystem::path& file, const Call& call) {
  try {
    return call();
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

/// What stands in a study file, to the letter; throws InputError if it cannot be read.
std::string read_study_text(const std::filesystem::path& file);

/// Fills the keys declared. Throws InputError with file and line for bad values, and for keys that
/// are not declared unless they are to be skipped.
void parse_study(dealii::ParameterHandler& p, const StudyText& text, bool skip_undefined);

/// Throws InputError unless the label has letters, digits, '.', '_' and '-' only.
void check_label(const std::string& label, const std::string& what, const std::string& file);

/// Throws InputError unless the scale is empty or known.
void require_scale(const std::string& scale, const std::vector<std::string>& known,
                   const std::string& file);

/// All keys with the values they have now.
StudyParameters all_parameters(dealii::ParameterHandler& p);

/// Declares the list of a study's scales.
void declare_scales(dealii::ParameterHandler& p);

/// Gives keys the values that the scale, if not empty, has in their place: numbers if they are not
/// 0, lists if they are not empty. Throws InputError for values that these keys cannot have.
void apply_scale(dealii::ParameterHandler& p, const std::string& scale, const std::string& file,
                 const std::vector<std::string>& numbers,
                 const std::vector<std::string>& lists = {});

/// All keys declared, with what they mean and their defaults, as a study file.
std::string commented_keys(dealii::ParameterHandler& p);

/// Declares what files of studies whose results are tables have in common (table_study.h): kind,
/// title, scales.
void declare_table_study(dealii::ParameterHandler& p, const std::string& kind);

/// Declares the subsection of one of its scales, which may change these whole numbers.
void declare_table_scale(dealii::ParameterHandler& p, const std::string& scale,
                         const std::vector<std::string>& numbers);

/// Reads such a file into p, which has all keys but those of the scales' subsections; scales may
/// change these whole numbers. Afterwards p has the values that the scale chosen gives them. Throws
/// InputError as read_study does.
StudyHeader read_table_study(dealii::ParameterHandler& p, const std::filesystem::path& file,
                             const std::string& scale, const std::vector<std::string>& numbers);

}  // namespace smoothfem
