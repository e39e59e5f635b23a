// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace smoothfem {

/// "3.2 s", "12 min 05 s".
std::string duration_text(double seconds);

/// Tells on standard error how far a run is: a bar that is drawn over on a terminal, a plain line
/// now and then elsewhere, nothing when quiet.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;

  /// A phase with n_steps steps begins.
  void begin(const std::string& phase, std::size_t n_steps);
  /// `done` steps of the phase are finished; `what`: what is being worked on. seconds_left: of the
  /// phase, if that is known; the share that is done is then that of the time.
  void update(std::size_t done, const std::string& what, std::optional<double> seconds_left = {});
  /// The phase is over: its line says how long it took.
  void end();
  /// A line of its own.
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
