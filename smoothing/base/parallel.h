// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <omp.h>

#include <cstddef>

namespace smoothfem {

/// Sets the number of threads of all later parallel loops, at least 1. Default: the number that
/// OpenMP finds (OMP_NUM_THREADS, otherwise all cores). Results never depend on it.
inline void set_n_threads(int n) {
  omp_set_num_threads(n);
}
inline int n_threads() {
  return omp_get_max_threads();
}

/// Calls work(i) for i = 0 .. n-1, several at a time. Each call must write to its own memory and
/// must not throw.
template <class Work>
void parallel_for(std::size_t n, const Work& work) {
#pragma omp parallel for schedule(dynamic, 1) if (n > 1)
  for (std::size_t i = 0; i < n; ++i) work(i);
}

/// Calls work(first, last) for parts of 0 .. n-1 with at most `grain` elements each.
template <class Work>
void parallel_for_ranges(std::size_t n, std::size_t grain, const Work& work) {
  parallel_for((n + grain - 1) / grain, [&](std::size_t part) {
    const std::size_t first = part * grain;
    work(first, first + grain < n ? first + grain : n);
  });
}

}  // namespace smoothfem
