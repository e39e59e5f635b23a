// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <omp.h>

#include <cstddef>

namespace smoothfem {

/// Threads that parallel loops use from now on, at least 1. Without a call: as many as OpenMP finds
/// (OMP_NUM_THREADS, otherwise all cores). Results never depend on it.
inline void set_n_threads(int n) {
  omp_set_num_threads(n);
}
inline int n_threads() {
  return omp_get_max_threads();
}

/// Calls work(i) for i = 0 .. n-1, several at a time. Each call has to write to memory of its own,
/// and must not throw.
template <class Work>
void parallel_for(std::size_t n, const Work& work) {
#pragma omp parallel for schedule(dynamic, 1) if (n > 1)
  for (std::size_t i = 0; i < n; ++i) work(i);
}

/// Calls work(first, last) for parts of 0 .. n-1 of at most `grain` each.
template <class Work>
void parallel_for_ranges(std::size_t n, std::size_t grain, const Work& work) {
  parallel_for((n + grain - 1) / grain, [&](std::size_t part) {
    const std::size_t first = part * grain;
    work(first, first + grain < n ? first + grain : n);
  });
}

}  // namespace smoothfem
