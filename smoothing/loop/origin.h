// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

namespace smoothfem {

/// Origin of a parameter's value.
struct Origin {
  std::string kind;   ///< one of printed (in the thesis), inferred (from it) and own choice
  std::string place;  ///< section of the thesis, or a file of this program; may be empty
};

/// Returns the origin as users read it: "printed, Section 5.4".
std::string text_of(const Origin& origin);

/// Makes an origin of these words. Throws InputError for another kind; `where` begins the message.
Origin make_origin(const std::string& kind, const std::string& place, const std::string& where);

/// Returns the origin of the default value of a stage's parameter (studies/origins.json). Returns
/// nothing for parameters that this file does not name, such as those of a plugin.
std::optional<Origin> default_origin(const std::string& stage, const std::string& parameter);

}  // namespace smoothfem
