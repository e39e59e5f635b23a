// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <string>
#include <variant>
#include <vector>

namespace smoothfem {

/// A choice among several names; the field holds the position of the chosen one.
struct Choice {
  int* index;
  std::vector<std::string> names;
};

/// A named parameter of a method, bound to the field that holds its value. The field's initial
/// value is the default. Parameters are read from the command line and study files and are written
/// to the results.
struct Parameter {
  std::string name;         ///< as users write it, e.g. "lambda"
  std::string description;  ///< meaning, unit and source in one sentence
  /// Lists are written with commas: "1, 0.25, 0". Text is used unchanged.
  std::variant<double*, int*, Choice, std::vector<double>*, std::string*> value;
  double lower = -std::numeric_limits<double>::infinity();  ///< smallest number allowed
  double upper = std::numeric_limits<double>::infinity();   ///< largest number allowed
  bool excludes_lower = false;  ///< true: only numbers above `lower` are allowed
  bool excludes_upper = false;
};

using Parameters = std::vector<Parameter>;

/// Returns the shortest text that reads back as the same value.
std::string value_text(const Parameter& parameter);

/// Returns the allowed values: "a, b or c" for names, "(0, 1]" for numbers, or nothing if all
/// numbers are allowed.
std::string range_text(const Parameter& parameter);

/// Sets a parameter from text. The text must be a number, an integer where one is needed, or one of
/// the names, within the range. Otherwise throws InputError with `owner` in its message.
void set_value(const Parameter& parameter, const std::string& text, const std::string& owner);

/// Returns the parameter of this name. Otherwise throws InputError that lists the available names.
const Parameter& find_parameter(const Parameters& parameters, const std::string& name,
                                const std::string& owner);

}  // namespace smoothfem
