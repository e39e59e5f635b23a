// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/mpi_session.h"

#include <mpi.h>

#include <cstdlib>

namespace smoothfem {

void begin_mpi() {
  ::setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
}

MpiSession::~MpiSession() {
  MPI_Finalize();
}

}  // namespace smoothfem
