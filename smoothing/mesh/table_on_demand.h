// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>

#include "smoothing/mesh/compressed_rows.h"

namespace smoothfem {

/// A table that is made at its first use, so that large meshes without this use save the memory.
class TableOnDemand {
 public:
  /// Returns the table; make() builds it. May be called by several threads at a time.
  template <class Make>
  const CompressedRows<std::uint32_t>& get(const Make& make) {
    if (!is_known_) look_up(make);
    return rows_;
  }

 private:
  template <class Make>
  void look_up(const Make& make) {
    const std::lock_guard lock(lock_);
    if (is_known_) return;
    rows_ = make();
    is_known_ = true;
  }

  CompressedRows<std::uint32_t> rows_;
  std::atomic<bool> is_known_ = false;
  std::mutex lock_;
};

}  // namespace smoothfem
