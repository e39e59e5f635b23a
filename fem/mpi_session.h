// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace smoothfem {

/// Starts MPI, for calls from one thread at a time. A process that mpirun did not start gets no
/// daemon of Open MPI beside it: it starts no other processes, and the daemon costs .3 s.
void begin_mpi();

/// MPI for as long as it lives. A process not started by mpirun needs it for Trilinos only.
class MpiSession {
 public:
  MpiSession() { begin_mpi(); }
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;
};

}  // namespace smoothfem
