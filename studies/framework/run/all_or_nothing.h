// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdio>
#include <exception>

#include "fem/ranks/ranks.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/interruption.h"

namespace smoothfem {

/// Runs the work that all ranks do alike. An InputError is the same on each rank and is thrown. Any
/// other exception is on one rank only, and the others would wait forever, so it ends all ranks.
template <class Work>
auto all_or_nothing(const Ranks& ranks, const Work& work) {
  try {
    return work();
  } catch (const InputError&) {
    throw;
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    if (ranks.size() == 1) throw;
    std::fprintf(
        stderr,
        "smoothfem: process %d of %d failed (%s); the study resumes if you start it again\n",
        ranks.rank(), ranks.size(), error.what());
    MPI_Abort(ranks.communicator(), 1);
    throw;
  }
}

}  // namespace smoothfem
