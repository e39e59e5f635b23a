// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace smoothfem {

/// Whether this process is one of several that mpirun, or a batch system in its place, started.
bool started_by_mpirun();

/// Starts MPI, for calls from one thread at a time. A process that mpirun did not start gets no
/// daemon of Open MPI beside it, which costs .3 s, and no directory for a session: it starts no
/// other processes.
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
