// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace smoothfem::bench {

/// Returns the bytes per second of a = b + s c on arrays too large for the cache, with the present
/// number of threads.
double triad_bandwidth();

inline constexpr std::size_t line_size = 64;  ///< bytes that memory transfers at a time
/// Returns the seconds for one cache line when many are read at random positions in an array of
/// n_bytes. No read waits for another one. On one thread.
double random_line_seconds(double n_bytes);

}  // namespace smoothfem::bench
