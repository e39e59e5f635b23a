// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

namespace smoothfem {

/// Searches for the edge length that gives a number of cells. The number falls with the length,
/// follows no known law near the boundary, and scatters.
class EdgeLengthSearch {
 public:
  EdgeLengthSearch(double first, double aim) : length_(first), aim_(aim) {}

  double length() const { return length_; }

  void found(double n_cells) {
    Try& side = n_cells > aim_ ? finer_ : coarser_;
    side = {true, std::log(length_), std::log(n_cells / aim_)};
    if (!finer_.known || !coarser_.known) {
      length_ *= n_cells / aim_;
      return;
    }
    // Interpolates linearly in logarithms, but stays away from the ends.
    const double fraction = finer_.excess / (finer_.excess - coarser_.excess);
    length_ =
        std::exp(std::lerp(finer_.log_length, coarser_.log_length, std::clamp(fraction, 0.1, 0.9)));
  }

 private:
  struct Try {
    bool known = false;
    double log_length = 0.0, excess = 0.0;
  };

  double length_, aim_;
  Try finer_, coarser_;
};

}  // namespace smoothfem
