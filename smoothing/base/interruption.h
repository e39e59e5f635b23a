// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>

namespace smoothfem {

/// Set when the user asks the process to end (Ctrl-C); never cleared. Long loops and waits check
/// it.
inline std::atomic<bool>& interruption() {
  static std::atomic<bool> asked{false};
  return asked;
}

/// Thrown after an interruption was seen. It is not an error: the work in progress is discarded.
struct Interrupted {};

}  // namespace smoothfem
