// SPDX-License-Identifier: GPL-3.0-or-later
// What libFuzzer calls. SMOOTHFEM_FUZZ_TARGETS() and SMOOTHFEM_FUZZ_TARGET choose the target.
#include <cstdlib>

#include "fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const smoothfem::fuzz::Target target = [] {
    for (const auto& known : smoothfem::fuzz::SMOOTHFEM_FUZZ_TARGETS())
      if (known.name == SMOOTHFEM_FUZZ_TARGET) return known;
    std::abort();
  }();
  target.run({data, size});
  return 0;
}
