// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/solve_queue.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace smoothfem {
namespace {

TEST(SolveQueue, RunsEveryTaskOnce) {
  std::vector<std::atomic<int>> n_runs(100);
  const SolveQueue::Worker worker = [&](std::size_t task) { ++n_runs[task]; };
  SolveQueue queue(n_runs.size(), {worker, worker, worker});
  while (!queue.finished()) std::this_thread::yield();
  EXPECT_EQ(queue.n_done(), n_runs.size());
  EXPECT_NO_THROW(queue.rethrow());
  for (const auto& n : n_runs) EXPECT_EQ(n, 1);
}

TEST(SolveQueue, RethrowsTheErrorOfATask) {
  // It is random which thread is first, so the test is repeated many times.
  const SolveQueue::Worker failing = [](std::size_t) { throw std::runtime_error("failure"); };
  for (int i = 0; i < 200; ++i) {
    SolveQueue queue(4, {failing, failing});
    while (!queue.finished()) std::this_thread::yield();
    EXPECT_THROW(queue.rethrow(), std::runtime_error);
  }
}

}  // namespace
}  // namespace smoothfem
