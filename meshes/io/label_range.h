// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace smoothfem {

/// Labels first, first + step, ... up to last.
struct LabelRange {
  std::size_t first, last, step;
};

/// Calls use(i) for those of some ascending labels that are in a range. Takes no more steps than
/// there are labels or numbers in the range, so that no file can make it slow.
template <class Use>
void for_each_in_range(const std::vector<std::size_t>& labels, const LabelRange& range,
                       const Use& use) {
  auto at = std::lower_bound(labels.begin(), labels.end(), range.first);
  const auto end = std::upper_bound(at, labels.end(), range.last);
  if ((range.last - range.first) / range.step < static_cast<std::size_t>(end - at)) {
    for (std::size_t label = range.first;; label += range.step) {
      at = std::lower_bound(at, end, label);
      if (at == end) return;
      if (*at == label) use(static_cast<std::size_t>(at - labels.begin()));
      if (range.last - label < range.step) return;
    }
  }
  for (; at != end; ++at)
    if ((*at - range.first) % range.step == 0) use(static_cast<std::size_t>(at - labels.begin()));
}

}  // namespace smoothfem
