#pragma once

namespace smoothfem {

/// The most memory that this process holds from now on, as the Linux kernel counts it.
class PeakMemory {
 public:
  /// Resets the kernel's mark; where it does not allow that, the mark is that of the whole run.
  PeakMemory();

  /// In GiB (2^30 bytes); 0 where the system does not tell.
  double gib() const;
};

}  // namespace smoothfem
