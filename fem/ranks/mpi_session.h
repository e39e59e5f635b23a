// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace smoothfem {

/// True if this process is one of several that mpirun, or a batch system in its place, has started.
bool started_by_mpirun();

/// Starts MPI, unless somebody has, for calls from one thread at a time. A process without mpirun
/// gets no daemon of Open MPI, which costs .3 s, and no session directory: it starts no other
/// processes.
void begin_mpi();

/// Keeps MPI initialized during its lifetime. A process not started by mpirun needs it for Trilinos
/// only.
class MpiSession {
 public:
  MpiSession() { begin_mpi(); }
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;
};

}  // namespace smoothfem
