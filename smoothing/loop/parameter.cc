// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/parameter.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <system_error>
#include <type_traits>

#include "smoothing/base/find_named.h"
#include "smoothing/base/text.h"

namespace smoothfem {

namespace {

template <class T>
bool parse_all(const std::string& text, T& value) {
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc{} && result.ptr == end;
}

}  // namespace

std::string value_text(const Parameter& parameter) {
  if (const auto* choice = std::get_if<Choice>(&parameter.value))
    return choice->names[static_cast<std::size_t>(*choice->index)];
  if (const auto* list = std::get_if<std::vector<double>*>(&parameter.value)) {
    std::string text;
    for (const double number : **list) text += (text.empty() ? "" : ", ") + number_text(number);
    return text;
  }
  if (const auto* whole = std::get_if<int*>(&parameter.value)) return number_text(**whole);
  if (const auto* text = std::get_if<std::string*>(&parameter.value)) return **text;
  return number_text(*std::get<double*>(parameter.value));
}

std::string range_text(const Parameter& parameter) {
  if (const auto* choice = std::get_if<Choice>(&parameter.value)) {
    std::string text;
    for (std::size_t i = 0; i < choice->names.size(); ++i)
      text += (i == 0 ? "" : i + 1 < choice->names.size() ? ", " : " or ") + choice->names[i];
    return text;
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (parameter.lower == -infinity && parameter.upper == infinity) return "";
  return (parameter.excludes_lower || parameter.lower == -infinity ? "(" : "[") +
         number_text(parameter.lower) + ", " + number_text(parameter.upper) +
         (parameter.excludes_upper || parameter.upper == infinity ? ")" : "]");
}

namespace {

template <class Value>
Value number_in_range(const Parameter& parameter, const std::string& text,
                      const std::string& what) {
  Value value;
  if (!parse_all(text, value))
    throw InputError(what + " needs " +
                     (std::is_same_v<Value, int> ? "a whole number" : "a number") +
                     ", but is given as '" + text + "'");
  const bool above = parameter.excludes_lower ? value > parameter.lower : value >= parameter.lower;
  const bool below = parameter.excludes_upper ? value < parameter.upper : value <= parameter.upper;
  if (!(above && below))
    throw InputError(what + " = " + text + " is outside its range " + range_text(parameter));
  return value;
}

std::vector<double> numbers_in_range(const Parameter& parameter, const std::string& text,
                                     const std::string& what) {
  std::vector<double> numbers;
  std::istringstream stream(text);
  for (std::string entry; std::getline(stream, entry, ',');) {
    const auto first = entry.find_first_not_of(' ');
    const auto last = entry.find_last_not_of(' ');
    entry = first == std::string::npos ? "" : entry.substr(first, last - first + 1);
    numbers.push_back(number_in_range<double>(parameter, entry, what));
  }
  if (numbers.empty()) throw InputError(what + " needs at least one number");
  return numbers;
}

int position_of(const Choice& choice, const std::string& text, const std::string& what) {
  const auto found = std::find(choice.names.begin(), choice.names.end(), text);
  if (found != choice.names.end()) return static_cast<int>(found - choice.names.begin());
  throw InputError(what + " is given as '" + text + "'; " + choose_one_of(choice.names, text));
}

}  // namespace

void set_value(const Parameter& parameter, const std::string& text, const std::string& owner) {
  const std::string what = owner + ": parameter " + parameter.name;
  std::visit(
      [&](const auto& target) {
        using Target = std::decay_t<decltype(target)>;
        if constexpr (std::is_same_v<Target, Choice>)
          *target.index = position_of(target, text, what);
        else if constexpr (std::is_same_v<Target, std::vector<double>*>)
          *target = numbers_in_range(parameter, text, what);
        else if constexpr (std::is_same_v<Target, std::string*>)
          *target = text;
        else
          *target = number_in_range<std::remove_pointer_t<Target>>(parameter, text, what);
      },
      parameter.value);
}

const Parameter& find_parameter(const Parameters& parameters, const std::string& name,
                                const std::string& owner) {
  std::vector<std::string> known;
  for (const auto& parameter : parameters) {
    if (parameter.name == name) return parameter;
    known.push_back(parameter.name);
  }
  const std::string nearest = nearest_name(name, known);
  throw InputError(owner + " has no parameter '" + name + "'; " +
                   (nearest.empty() ? "" : "did you mean '" + nearest + "'? ") + "it has " +
                   (known.empty() ? "none" : joined(known)));
}

}  // namespace smoothfem
