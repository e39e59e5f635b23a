// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>
#include <mpi.h>

#include <iostream>

#include "fem/ranks/mpi_session.h"
#include "fem/ranks/ranks.h"

namespace smoothfem::test {

/// All processes that mpirun has started.
inline const Ranks& all_ranks() {
  static const Ranks ranks(MPI_COMM_WORLD);
  return ranks;
}

/// Runs every test on each rank; the root alone reports. Returns the exit code, the same on all.
inline int run_on_all_ranks(int argc, char** argv) {
  const MpiSession mpi;
  testing::InitGoogleTest(&argc, argv);
  auto& listeners = testing::UnitTest::GetInstance()->listeners();
  if (!all_ranks().is_root()) delete listeners.Release(listeners.default_result_printer());
  int failed = RUN_ALL_TESTS(), failed_anywhere = 0;
  MPI_Allreduce(&failed, &failed_anywhere, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  if (all_ranks().is_root() && failed_anywhere != failed)
    std::cout << "a test failed on another rank\n";
  return failed_anywhere;
}

}  // namespace smoothfem::test
