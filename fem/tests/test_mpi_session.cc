// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/ranks/mpi_session.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace smoothfem {
namespace {

// Runs this program once more. Its MPI starts in the same way, without a possible session
// directory.
TEST(MpiSession, OfASingleProcessNeedsNoDirectory) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe");
  const std::string command =
      "OMPI_MCA_orte_tmpdir_base=/dev/null '" + program + "' --gtest_list_tests > /dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(MpiSession, KeepsTheEnvironmentOfLaterPrograms) {
  EXPECT_EQ(std::getenv("OMPI_MCA_orte_create_session_dirs"), nullptr);
  EXPECT_EQ(std::getenv("OMPI_MCA_ess_singleton_isolated"), nullptr);
}

TEST(MpiSession, KnowsWhetherMpirunStartedTheProcess) {
  EXPECT_FALSE(started_by_mpirun());
  ::setenv("OMPI_COMM_WORLD_SIZE", "2", 1);
  EXPECT_TRUE(started_by_mpirun());
  ::unsetenv("OMPI_COMM_WORLD_SIZE");
}

}  // namespace
}  // namespace smoothfem
