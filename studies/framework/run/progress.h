// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace smoothfem {

/// Returns "3.2 s" or "12 min 05 s".
std::string duration_text(double seconds);

/// Prints the progress of a run to standard error. A terminal gets a bar that is redrawn. Other
/// outputs get a plain line now and then. Nothing is printed when quiet.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;

  /// Begins a phase with n_steps steps.
  void begin(const std::string& phase, std::size_t n_steps);
  /// Notes that `done` steps of the phase are finished. what: the present work. seconds_left: time
  /// left in the phase, if known; the displayed share is then that of the time.
  void update(std::size_t done, const std::string& what, std::optional<double> seconds_left = {});
  /// Ends the phase and prints how long it took.
  void end();
  /// Prints a line; nothing for an empty text.
  void say(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;

  double seconds() const;
  void clear_line();

  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  std::string phase_;
  std::size_t n_steps_ = 0;
  Clock::time_point started_, last_shown_;
};

}  // namespace smoothfem
