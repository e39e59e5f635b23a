// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/peak_memory.h"

#include <malloc.h>

#include <fstream>
#include <string>

namespace smoothfem {

void return_freed_memory() {
  constexpr int max_maps = 65536;            // the C library's default
  constexpr int min_map = 16 * 1024 * 1024;  // smaller ones are reused, without page faults
  mallopt(M_MMAP_MAX, max_maps);
  mallopt(M_MMAP_THRESHOLD, min_map);
  mallopt(M_TRIM_THRESHOLD, 2 * min_map);
}

PeakMemory::PeakMemory() {
  malloc_trim(0);  // returns memory that earlier work has freed
  std::ofstream("/proc/self/clear_refs") << 5;
}

double PeakMemory::gib() const {
  std::ifstream status("/proc/self/status");
  const std::string key = "VmHWM:";
  for (std::string line; std::getline(status, line);)
    if (line.rfind(key, 0) == 0) return std::stod(line.substr(key.size())) / (1024.0 * 1024.0);
  return 0.0;
}

}  // namespace smoothfem
