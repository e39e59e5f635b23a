// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "smoothing/base/find_named.h"

namespace smoothfem {

/// Named entries that users choose from: methods, domains, formats, solutions, kinds of studies.
/// Each registers itself when its file is loaded, by a namespace-scope object at the end of that
/// file. Entry: any type with a member `name`.
template <class Entry>
class Registry {
 public:
  /// what: the kind of an entry in error messages, for example "domain".
  explicit Registry(std::string what) : what_(std::move(what)) {}

  /// Adds an entry. A duplicate name becomes an InputError at the first look-up, since nothing can
  /// be thrown while a library is loaded.
  void add(Entry entry) {
    // Sorted, so that listings do not depend on the order in which files are linked or loaded.
    const auto next =
        std::lower_bound(entries_.begin(), entries_.end(), entry,
                         [](const Entry& a, const Entry& b) { return a.name < b.name; });
    if (next != entries_.end() && next->name == entry.name)
      error_ = "two entries of the kind " + what_ + " are registered as '" + entry.name +
               "'; give one of them another name";
    else
      entries_.insert(next, std::move(entry));
  }

  /// Returns all entries, sorted by name.
  const std::vector<Entry>& all() const {
    if (!error_.empty()) throw InputError(error_);
    return entries_;
  }

  /// Returns the entry of this name. Otherwise throws InputError that suggests the nearest name and
  /// lists all.
  const Entry& find(const std::string& name) const {
    return find_named(what_, name, all(), [](const Entry& entry) { return entry.name; });
  }

 private:
  std::string what_, error_;
  std::vector<Entry> entries_;
};

}  // namespace smoothfem
