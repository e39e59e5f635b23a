// SPDX-License-Identifier: GPL-3.0-or-later
// The tests of this folder, each on all ranks that mpirun starts.
#include "fem/tests/all_ranks.h"

int main(int argc, char** argv) {
  return smoothfem::test::run_on_all_ranks(argc, argv);
}
