// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "smoothing/base/find_named.h"

namespace smoothfem {

/// What users choose from by name: methods, domains, formats, solutions, kinds of studies. Each
/// registers itself when its file is loaded, by a namespace-scope object at the end of that file.
/// Entry: any type with a member `name`.
template <class Entry>
class Registry {
 public:
  /// what: one of them in an error message, as "domain".
  explicit Registry(std::string what) : what_(std::move(what)) {}

  /// Nothing can be thrown while a library is loaded: a name that is taken is an InputError at the
  /// first look-up.
  void add(Entry entry) {
    // Sorted, so that listings do not depend on the order in which files are linked or loaded.
    const auto next =
        std::lower_bound(entries_.begin(), entries_.end(), entry,
                         [](const Entry& a, const Entry& b) { return a.name < b.name; });
    if (next != entries_.end() && next->name == entry.name)
      error_ = "two of the kind " + what_ + " are registered as '" + entry.name +
               "'; give one of them another name";
    else
      entries_.insert(next, std::move(entry));
  }

  /// Sorted by name.
  const std::vector<Entry>& all() const {
    if (!error_.empty()) throw InputError(error_);
    return entries_;
  }

  /// Throws InputError that asks for the nearest name and lists all.
  const Entry& find(const std::string& name) const {
    return find_named(what_, name, all(), [](const Entry& entry) { return entry.name; });
  }

 private:
  std::string what_, error_;
  std::vector<Entry> entries_;
};

}  // namespace smoothfem
