// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace smoothfem {

/// Returns the widest vector registers that this library is compiled for: "AVX2", "AVX", "SSE2", or
/// "scalar". Results do not depend on them.
std::string_view registers();

}  // namespace smoothfem
