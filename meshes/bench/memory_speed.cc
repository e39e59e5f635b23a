// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/bench/memory_speed.h"

#include <benchmark/benchmark.h>

#include <cstdint>
#include <random>
#include <vector>

#include "meshes/bench/timing.h"
#include "smoothing/base/parallel.h"

namespace smoothfem::bench {

double triad_bandwidth() {
  constexpr std::size_t n = 1 << 25;
  constexpr int n_runs = 7;
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0), seconds;
  for (int run = 0; run < n_runs; ++run) {
    seconds.push_back(seconds_of([&] {
      parallel_for_ranges(n, n / 64, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) a[i] = b[i] + 3.0 * c[i];
      });
      benchmark::DoNotOptimize(a.data());
    }));
  }
  return 3.0 * sizeof(double) * n / median(seconds);
}

double random_line_seconds(double n_bytes) {
  constexpr std::size_t n_reads = 1 << 16, numbers_a_line = line_size / sizeof(std::uint64_t);
  constexpr int n_runs = 15;
  const auto n_lines = static_cast<std::size_t>(n_bytes / line_size) + 1;
  std::vector<std::uint64_t> numbers(numbers_a_line * n_lines, 1);
  std::vector<std::uint32_t> lines(n_reads);
  std::mt19937 random(1);
  std::vector<double> seconds;
  for (int run = 0; run < n_runs; ++run) {
    for (auto& line : lines) line = static_cast<std::uint32_t>(random() % n_lines);
    seconds.push_back(seconds_of([&] {
      std::uint64_t sum = 0;
      for (const std::uint32_t line : lines) sum += numbers[numbers_a_line * line];
      benchmark::DoNotOptimize(sum);
    }));
  }
  return median(seconds) / n_reads;
}

}  // namespace smoothfem::bench
