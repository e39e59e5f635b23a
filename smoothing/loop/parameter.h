#pragma once

#include <limits>
#include <string>
#include <variant>
#include <vector>

namespace smoothfem {

/// A named parameter of a method: bound to the field that holds it, whose present value is the
/// default until it is set. Read from the command line and study files, written to the results.
struct Parameter {
  std::string name;         ///< as users write it, e.g. "lambda"
  std::string description;  ///< meaning, unit and source in one sentence
  std::variant<double*, int*> value;
  double lower = -std::numeric_limits<double>::infinity();  ///< smallest value allowed
  double upper = std::numeric_limits<double>::infinity();   ///< largest value allowed
};

using Parameters = std::vector<Parameter>;

/// Shortest text that reads back as the same value.
std::string value_text(const Parameter& parameter);

/// Sets a parameter from text. Throws InputError with `owner` in its sentence if the text is no
/// number (or no integer where one is needed) or outside the range.
void set_value(const Parameter& parameter, const std::string& text, const std::string& owner);

/// The parameter of this name; throws InputError listing the names there are.
const Parameter& find_parameter(const Parameters& parameters, const std::string& name,
                                const std::string& owner);

}  // namespace smoothfem
