// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <string>
#include <variant>
#include <vector>

namespace smoothfem {

/// One of several names; the field holds its position.
struct Choice {
  int* index;
  std::vector<std::string> names;
};

/// A named parameter of a method: bound to the field that holds it, whose present value is the
/// default until it is set. Read from the command line and study files, written to the results.
struct Parameter {
  std::string name;         ///< as users write it, e.g. "lambda"
  std::string description;  ///< meaning, unit and source in one sentence
  /// Lists are written with commas: "1, 0.25, 0". Text is taken as it is.
  std::variant<double*, int*, Choice, std::vector<double>*, std::string*> value;
  double lower = -std::numeric_limits<double>::infinity();  ///< smallest number allowed
  double upper = std::numeric_limits<double>::infinity();   ///< largest number allowed
  bool excludes_lower = false;  ///< only larger numbers than `lower` are allowed
  bool excludes_upper = false;
};

using Parameters = std::vector<Parameter>;

/// Shortest text that reads back as the same value.
std::string value_text(const Parameter& parameter);

/// What a parameter may be set to: "a, b or c" of names; "(0, 1]" of numbers, or nothing where all
/// are allowed.
std::string range_text(const Parameter& parameter);

/// Sets a parameter from text. Throws InputError with `owner` in its sentence if the text is no
/// number (or no integer where one is needed, or none of the names) or outside the range.
void set_value(const Parameter& parameter, const std::string& text, const std::string& owner);

/// The parameter of this name; throws InputError listing the names there are.
const Parameter& find_parameter(const Parameters& parameters, const std::string& name,
                                const std::string& owner);

}  // namespace smoothfem
