// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/bench/triad_bandwidth.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "smoothing/base/parallel.h"

namespace smoothfem::bench {

double triad_bandwidth() {
  constexpr std::size_t n = 1 << 25;
  constexpr int n_runs = 7;
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0), seconds;
  for (int run = 0; run < n_runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    parallel_for_ranges(n, n / 64, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) a[i] = b[i] + 3.0 * c[i];
    });
    benchmark::DoNotOptimize(a.data());
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(seconds.begin(), seconds.begin() + n_runs / 2, seconds.end());
  return 3.0 * sizeof(double) * n / seconds[n_runs / 2];
}

}  // namespace smoothfem::bench
