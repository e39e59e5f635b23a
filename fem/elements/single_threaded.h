// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/multithread_info.h>

// Includes deal.II's headers: for sources of this library only.

namespace smoothfem {

/// Keeps deal.II on this thread. For its tables, which take no time, it would start as many threads
/// as the machine has, whatever --threads sets. Parallel loops of this program use their own
/// threads.
inline void keep_deal_ii_single_threaded() {
  [[maybe_unused]] static const bool once = [] {
    dealii::MultithreadInfo::set_thread_limit(1);
    return true;
  }();
}

}  // namespace smoothfem
