// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace smoothfem::bench {

/// Bytes per second of a = b + s c on arrays too large for the cache, with the present threads.
double triad_bandwidth();

}  // namespace smoothfem::bench
