// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace smoothfem {

/// The seconds that the phases of a run have taken.
class PhaseTimes {
 public:
  template <class Work>
  void measure(const std::string& phase, const Work& work) {
    phase_ = phase;
    started_ = Clock::now();
    work();
    seconds_ = seconds();
    phase_.clear();
  }

  /// Returns the seconds of each phase; of the present phase, the seconds up to now.
  std::map<std::string, double> seconds() const {
    auto result = seconds_;
    if (!phase_.empty())
      result[phase_] = std::chrono::duration<double>(Clock::now() - started_).count();
    return result;
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::map<std::string, double> seconds_;
  std::string phase_;  ///< the present one; empty: none
  Clock::time_point started_;
};

}  // namespace smoothfem
