#include "studies/framework/peak_memory.h"

#include <malloc.h>

#include <fstream>
#include <string>

namespace smoothfem {

PeakMemory::PeakMemory() {
  malloc_trim(0);  // what earlier work has freed is not ours
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
