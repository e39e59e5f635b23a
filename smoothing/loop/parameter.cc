#include "smoothing/loop/parameter.h"

#include <charconv>
#include <system_error>

#include "smoothing/mesh/input_error.h"

namespace smoothfem {

namespace {

template <class T>
std::string number_text(T value) {
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof(buffer), value).ptr;
  return {buffer, end};
}

template <class T>
bool parse_all(const std::string& text, T& value) {
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc{} && result.ptr == end;
}

}  // namespace

std::string value_text(const Parameter& parameter) {
  return std::visit([](const auto* value) { return number_text(*value); }, parameter.value);
}

void set_value(const Parameter& parameter, const std::string& text, const std::string& owner) {
  std::visit(
      [&](auto* target) {
        using Value = std::remove_pointer_t<decltype(target)>;
        Value value;
        const std::string what = owner + ": parameter " + parameter.name;
        if (!parse_all(text, value))
          throw InputError(what + " needs " +
                           (std::is_same_v<Value, int> ? "a whole number" : "a number") +
                           ", but is given as '" + text + "'");
        if (!(value >= parameter.lower && value <= parameter.upper))
          throw InputError(what + " = " + text + " is outside its range [" +
                           number_text(parameter.lower) + ", " + number_text(parameter.upper) +
                           "]");
        *target = value;
      },
      parameter.value);
}

const Parameter& find_parameter(const Parameters& parameters, const std::string& name,
                                const std::string& owner) {
  std::string known;
  for (const auto& parameter : parameters) {
    if (parameter.name == name) return parameter;
    known += (known.empty() ? "" : ", ") + parameter.name;
  }
  throw InputError(owner + " has no parameter '" + name + "'; it has " +
                   (known.empty() ? "none" : known));
}

}  // namespace smoothfem
