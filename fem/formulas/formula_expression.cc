// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/formulas/formula_expression.h"

#include <cctype>
#include <cstdlib>

#include "fem/formulas/formula_functions.h"
#include "smoothing/base/find_named.h"

namespace smoothfem {

namespace {

using GiNaC::ex;
using GiNaC::exvector;

std::vector<std::string> names_of_functions() {
  std::vector<std::string> names;
  for (const auto& function : formula_functions()) names.push_back(function.name);
  return names;
}

/// GiNaC would compute huge powers of numbers digit by digit.
constexpr int largest_exponent = 300;

/// Recursive descent parser with one function for each precedence of operators.
class FormulaParser {
 public:
  FormulaParser(const std::string& text, int dim) : text_(text), dim_(dim) {}

  ex parse() {
    const ex result = conditional();
    if (!at_end()) fail_at(position_, "'" + text_.substr(position_, 1) + "'");
    return result;
  }

 private:
  [[noreturn]] static void fail(const std::string& reason) { throw InputError(reason); }
  [[noreturn]] void fail_at(std::size_t position, const std::string& what) const {
    fail(what + " at character " + std::to_string(position + 1) + " is not understood");
  }

  void skip_blanks() {
    while (position_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[position_])))
      ++position_;
  }
  bool at_end() {
    skip_blanks();
    return position_ == text_.size();
  }
  bool take(std::string_view token) {
    skip_blanks();
    if (text_.compare(position_, token.size(), token) != 0) return false;
    position_ += token.size();
    return true;
  }
  void expect(char token) {
    if (at_end()) fail("it ends too early");
    if (!take(std::string_view(&token, 1)))
      fail_at(position_, "'" + text_.substr(position_, 1) + "'");
  }

  ex conditional() {
    constexpr int deepest = 200;
    if (++depth_ > deepest) fail("its brackets are nested too deeply");
    ex result = any_of();
    if (take("?")) {
      const ex yes = conditional();
      expect(':');
      result = if_else(result, yes, conditional());
    }
    --depth_;
    return result;
  }
  ex any_of() {
    ex result = all_of();
    while (take("||")) result = if_else(result, 1, if_else(all_of(), 1, 0));
    return result;
  }
  ex all_of() {
    ex result = comparison();
    while (take("&&")) result = if_else(result, if_else(comparison(), 1, 0), 0);
    return result;
  }
  ex comparison() {
    const ex left = sum();
    if (take("<=")) return choice(at_most_zero, left - sum(), 1, 0);
    if (take(">=")) return choice(below_zero, left - sum(), 0, 1);
    if (take("==")) return choice(equal_to_zero, left - sum(), 1, 0);
    if (take("!=")) return choice(equal_to_zero, left - sum(), 0, 1);
    if (take("<")) return choice(below_zero, left - sum(), 1, 0);
    if (take(">")) return choice(at_most_zero, left - sum(), 0, 1);
    return left;
  }
  ex sum() {
    ex result = product();
    for (;;)
      if (take("+"))
        result += product();
      else if (take("-"))
        result -= product();
      else
        return result;
  }
  ex product() {
    ex result = signed_power();
    for (;;)
      if (take("*"))
        result *= signed_power();
      else if (take("/"))
        result /= signed_power();
      else
        return result;
  }
  ex signed_power() {
    if (take("-")) return -signed_power();
    if (take("+")) return signed_power();
    if (take("!")) return if_else(signed_power(), 0, 1);
    const ex base = operand();
    if (!take("^")) return base;
    return power(base, signed_power());  // from the right: 2^3^2 is 2^9
  }
  static ex power(const ex& base, const ex& exponent) {
    if (GiNaC::is_exactly_a<GiNaC::numeric>(exponent) &&
        GiNaC::abs(GiNaC::ex_to<GiNaC::numeric>(exponent)) > largest_exponent)
      fail("exponents are at most " + std::to_string(largest_exponent));
    return GiNaC::pow(base, exponent);
  }

  ex operand() {
    if (at_end()) fail("it ends too early");
    if (take("(")) {
      const ex inner = conditional();
      expect(')');
      return inner;
    }
    const char first = text_[position_];
    if (std::isdigit(static_cast<unsigned char>(first)) || first == '.') return number();
    if (std::isalpha(static_cast<unsigned char>(first)) || first == '_') return named();
    fail_at(position_, "'" + std::string(1, first) + "'");
  }

  /// Reads decimals as fractions, so that derivatives are exact.
  ex number() {
    const std::size_t begin = position_;
    const auto digits = [&] {
      std::string found;
      while (position_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[position_])))
        found += text_[position_++];
      return found;
    };
    std::string all = digits();
    long exponent = 0;
    if (position_ < text_.size() && text_[position_] == '.') {
      ++position_;
      const std::string decimals = digits();
      all += decimals;
      exponent -= static_cast<long>(decimals.size());
    }
    if (all.empty()) fail_at(begin, "'.'");
    if (position_ < text_.size() && (text_[position_] == 'e' || text_[position_] == 'E')) {
      char* end = nullptr;
      const long power = std::strtol(text_.c_str() + position_ + 1, &end, 10);
      const auto next = static_cast<std::size_t>(end - text_.c_str());
      if (next == position_ + 1) fail_at(position_, "'" + text_.substr(position_, 1) + "'");
      if (std::abs(power) > largest_exponent)
        fail("exponents are at most " + std::to_string(largest_exponent));
      exponent += power;
      position_ = next;
    }
    return ex(GiNaC::numeric(all.c_str())) * GiNaC::pow(ex(10), ex(exponent));
  }

  ex named() {
    const std::size_t begin = position_;
    while (position_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[position_])) || text_[position_] == '_'))
      ++position_;
    const std::string name = text_.substr(begin, position_ - begin);
    const std::string where = "'" + name + "' at character " + std::to_string(begin + 1);
    if (take("(")) {
      exvector arguments;
      if (!take(")")) {
        do arguments.push_back(conditional());
        while (take(","));
        expect(')');
      }
      for (const auto& function : formula_functions()) {
        if (function.name != name) continue;
        if (arguments.size() < function.fewest || arguments.size() > function.most)
          fail(where + " takes " + std::to_string(function.fewest) +
               (function.most > function.fewest ? " or more arguments"
                : function.most == 1            ? " argument"
                                                : " arguments") +
               ", not " + std::to_string(arguments.size()));
        return name == "pow" ? power(arguments[0], arguments[1]) : function.make(arguments);
      }
      fail(where + " is not a function; " + choose_one_of(names_of_functions(), name));
    }
    std::vector<std::string> names;
    for (int d = 0; d < dim_; ++d) {
      const auto& variable = formula_variables()[static_cast<std::size_t>(d)];
      if (variable.get_name() == name) return variable;
      names.push_back(variable.get_name());
    }
    if (name == "pi") return GiNaC::Pi;
    names.emplace_back("pi");
    fail(where + " is not a variable; " + choose_one_of(names, name));
  }

  const std::string& text_;
  const int dim_;
  std::size_t position_ = 0;
  int depth_ = 0;
};

}  // namespace

const std::vector<GiNaC::symbol>& formula_variables() {
  static const std::vector<GiNaC::symbol> variables{GiNaC::symbol("x"), GiNaC::symbol("y"),
                                                    GiNaC::symbol("z")};
  return variables;
}

ex parse_formula(const std::string& text, int dim) {
  try {
    return FormulaParser(text, dim).parse();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception&) {  // exceptions of GiNaC
    throw InputError("it divides by zero, or evaluates a function where it has no value");
  }
}

}  // namespace smoothfem
