// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace smoothfem {

/// Lets large arrays go back to the system when they are freed. SuperLU_DIST, which comes with
/// Trilinos, tells the C library otherwise when it is loaded: programs then need up to twice the
/// memory. To be called first of all.
void return_freed_memory();

/// The most memory that this process holds from now on, as the Linux kernel counts it.
class PeakMemory {
 public:
  /// Resets the kernel's mark; where it does not allow that, the mark is that of the whole run.
  PeakMemory();

  /// In GiB (2^30 bytes); 0 where the system does not tell.
  double gib() const;
};

}  // namespace smoothfem
