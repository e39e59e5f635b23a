// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/simd/registers.h"

namespace smoothfem {

std::string_view registers() {
#if defined(__AVX2__)
  return "AVX2";
#elif defined(__AVX__)
  return "AVX";
#elif defined(__SSE2__)
  return "SSE2";
#else
  return "scalar";
#endif
}

}  // namespace smoothfem
