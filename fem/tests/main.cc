// SPDX-License-Identifier: GPL-3.0-or-later
// Trilinos needs MPI, on one process too.
#include <gtest/gtest.h>

#include "fem/ranks/mpi_session.h"

int main(int argc, char** argv) {
  const smoothfem::MpiSession mpi;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
