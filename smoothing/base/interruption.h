// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>

namespace smoothfem {

/// Set, for good, when the user asks the process to end (Ctrl-C). Who waits for something that may
/// take long looks at it.
inline std::atomic<bool>& interruption() {
  static std::atomic<bool> asked{false};
  return asked;
}

/// Thrown by who has seen it: no error, and nothing of the work at hand counts.
struct Interrupted {};

}  // namespace smoothfem
