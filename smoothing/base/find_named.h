// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "smoothing/base/input_error.h"

namespace smoothfem {

/// Returns the Damerau-Levenshtein distance of two words: the number of letters to insert, delete,
/// change or swap with their neighbour to make one word from the other. Swapped letters are not
/// edited again ("optimal string alignment").
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Distances of the first i and i - 1 letters of a from the first j letters of b; swapped letters
  // also need those of i - 2.
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before_last, last);
    std::swap(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

/// Returns the name that was probably meant: the first one with the smallest edit distance. Returns
/// an empty string if that distance exceeds a third of the letters of `wanted` (at least one).
inline std::string nearest_name(const std::string& wanted, const std::vector<std::string>& names) {
  const std::size_t most = std::max<std::size_t>(1, wanted.size() / 3);
  std::size_t least = std::numeric_limits<std::size_t>::max();
  std::string nearest;
  for (const auto& name : names) {
    if (std::max(name.size(), wanted.size()) > std::min(name.size(), wanted.size()) + most)
      continue;  // the distance is at least the difference in length
    const std::size_t distance = edit_distance(wanted, name);
    if (distance <= most && distance < least) {
      least = distance;
      nearest = name;
    }
  }
  return nearest;
}

/// Returns "did you mean 'gear'? choose one of axle, gear", the end of an error message about an
/// unknown name. The question appears only if there is a nearest_name.
inline std::string choose_one_of(const std::vector<std::string>& names, const std::string& wanted) {
  if (names.empty()) return "none is available";
  const std::string nearest = nearest_name(wanted, names);
  return (nearest.empty() ? "" : "did you mean '" + nearest + "'? ") + choose_one_of(names);
}

/// Returns "there is no domain 'gaer'; did you mean 'gear'? choose one of axle, gear".
inline std::string no_such_name(const std::string& what, const std::string& wanted,
                                const std::vector<std::string>& names) {
  return "there is no " + what + " '" + wanted + "'; " + choose_one_of(names, wanted);
}

/// Returns the first element of `all` whose name_of(element) is the wanted one. Otherwise throws
/// InputError; its message has the kind of thing (`what`) and the names in the order of `all`.
template <class Range, class NameOf>
auto& find_named(const std::string& what, const std::string& wanted, Range& all, NameOf name_of) {
  for (auto& candidate : all)
    if (name_of(candidate) == wanted) return candidate;
  std::vector<std::string> names;
  names.reserve(std::size(all));
  for (const auto& candidate : all) names.emplace_back(name_of(candidate));
  throw InputError(no_such_name(what, wanted, names));
}

/// Returns the wanted name if `names` has it. Otherwise throws InputError, as above.
inline const std::string& find_named(const std::string& what, const std::string& wanted,
                                     const std::vector<std::string>& names) {
  return find_named(what, wanted, names, [](const std::string& name) { return name; });
}

}  // namespace smoothfem
