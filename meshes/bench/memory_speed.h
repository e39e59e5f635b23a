// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace smoothfem::bench {

/// Bytes per second of a = b + s c on arrays too large for the cache, with the present threads.
double triad_bandwidth();

inline constexpr std::size_t line_size = 64;  ///< bytes that memory gives at a time
/// Seconds that one line takes of many that are read here and there in an array of so many bytes,
/// none of which waits for another one. On one thread.
double random_line_seconds(double n_bytes);

}  // namespace smoothfem::bench
