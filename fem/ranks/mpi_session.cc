// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/ranks/mpi_session.h"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>
#include <vector>

namespace smoothfem {
namespace {

/// Settings of Open MPI for a single process. Its session directory would be shared by all such
/// processes of the user, and one that ends would remove it from one that begins.
constexpr std::array<std::pair<const char*, const char*>, 2> single_process_settings = {
    {{"OMPI_MCA_ess_singleton_isolated", "1"}, {"OMPI_MCA_orte_create_session_dirs", "0"}}};

}  // namespace

bool started_by_mpirun() {
  constexpr std::array names = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"};
  return std::ranges::any_of(names, [](const char* name) { return std::getenv(name) != nullptr; });
}

void begin_mpi() {
  int has_begun = 0;
  MPI_Initialized(&has_begun);
  if (has_begun) return;  // for example by a file in Python that imports mpi4py
  // Removed again after MPI has read them: a Python that uses this library may start programs by
  // mpirun.
  std::vector<const char*> added;
  if (!started_by_mpirun())
    for (const auto& [name, value] : single_process_settings)
      if (std::getenv(name) == nullptr && ::setenv(name, value, 1) == 0) added.push_back(name);
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  for (const char* name : added) ::unsetenv(name);
}

MpiSession::~MpiSession() {
  int is_over = 0;
  MPI_Finalized(&is_over);
  if (!is_over) MPI_Finalize();
}

}  // namespace smoothfem
