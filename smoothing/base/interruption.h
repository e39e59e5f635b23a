// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <csignal>

namespace smoothfem {

/// Set when the user asks the process to end (Ctrl-C); never cleared. Long loops and waits check
/// it. Visible, so that a library that hides its symbols has the same one.
[[gnu::visibility("default")]] inline std::atomic<bool>& interruption() {
  static std::atomic<bool> asked{false};
  return asked;
}

/// Makes Ctrl-C and SIGTERM set interruption(). A second one ends the process at once.
inline void notice_signals() {
  const auto notice = [](int signal) {
    interruption() = true;
    std::signal(signal, SIG_DFL);
  };
  std::signal(SIGINT, notice);
  std::signal(SIGTERM, notice);
}

/// Function that long loops call often, on the thread that has called them; null: none. It may
/// throw to end the loop. Python's module looks for Ctrl-C there.
[[gnu::visibility("default")]] inline std::atomic<void (*)()>& interruption_hook() {
  static std::atomic<void (*)()> hook{nullptr};
  return hook;
}
inline void let_interrupt() {
  if (auto* const hook = interruption_hook().load(std::memory_order_relaxed)) hook();
}

/// Thrown after an interruption was seen. It is not an error: the work in progress is discarded.
struct Interrupted {};

}  // namespace smoothfem
