// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace smoothfem {

/// Returns large arrays to the system when they are freed. SuperLU_DIST, which comes with Trilinos,
/// changes this setting of the C library when it is loaded. Programs then need up to twice the
/// memory. Call this function first of all.
void return_freed_memory();

/// The peak memory of this process from now on, as the Linux kernel counts it.
class PeakMemory {
 public:
  /// Resets the kernel's peak. If the kernel does not allow that, the peak is that of the whole
  /// run.
  PeakMemory();

  /// Returns the peak in GiB (2^30 bytes); 0 if the system does not report it.
  double gib() const;
};

}  // namespace smoothfem
