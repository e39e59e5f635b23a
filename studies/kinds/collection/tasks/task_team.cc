// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/collection/tasks/task_team.h"

#include <chrono>
#include <thread>

#include "smoothing/base/input_error.h"
#include "smoothing/base/interruption.h"

namespace smoothfem {

namespace {

/// Time between two checks for answers. Without it, waiting would take a processor from the
/// workers.
constexpr auto pause = std::chrono::milliseconds(2);

enum Tag : int { outcome_tag, failure_tag, failure_for_now_tag, task_tag, end_tag };

void send(const Ranks& ranks, int to, Tag tag, const std::string& text) {
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, to, tag, ranks.communicator());
}

struct RankMessage {
  Tag tag;
  std::string text;
};

/// Returns a rank's message, if it has sent one.
std::optional<RankMessage> receive(const Ranks& ranks, int from) {
  int is_there = 0, size = 0;
  MPI_Status status;
  MPI_Iprobe(from, MPI_ANY_TAG, ranks.communicator(), &is_there, &status);
  if (is_there == 0) return std::nullopt;
  MPI_Get_count(&status, MPI_CHAR, &size);
  std::string text(static_cast<std::size_t>(size), '\0');
  MPI_Recv(text.data(), size, MPI_CHAR, from, status.MPI_TAG, ranks.communicator(),
           MPI_STATUS_IGNORE);
  return RankMessage{static_cast<Tag>(status.MPI_TAG), std::move(text)};
}

/// Returns for each rank, on the root, if it is the first rank of its machine. Collective.
std::vector<char> first_of_machines(const Ranks& ranks) {
  if (ranks.size() == 1) return {1};
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(ranks.communicator(), MPI_COMM_TYPE_SHARED, ranks.rank(), MPI_INFO_NULL,
                      &machine);
  const bool is_first = Ranks(machine).is_root();
  MPI_Comm_free(&machine);
  return ranks.gather(std::vector<char>{is_first});
}

}  // namespace

class TaskTeam::Worker {
 public:
  virtual ~Worker() = default;
  virtual void give(const std::string& task) = 0;
  virtual std::optional<TaskAnswer> answer() = 0;

  std::optional<std::size_t> task;  ///< number of its present task
};

class TaskTeam::OwnWorker : public Worker {
 public:
  explicit OwnWorker(double limit_seconds) : process_(own_command(), limit_seconds) {}
  void give(const std::string& task) override { process_.give(task); }
  std::optional<TaskAnswer> answer() override { return process_.answer(); }

 private:
  TaskProcess process_;
};

class TaskTeam::RankWorker : public Worker {
 public:
  RankWorker(const Ranks& ranks, int rank) : ranks_(ranks), rank_(rank) {}
  ~RankWorker() override { send(ranks_, rank_, end_tag, ""); }

  void give(const std::string& task) override { send(ranks_, rank_, task_tag, task); }
  std::optional<TaskAnswer> answer() override {
    auto message = receive(ranks_, rank_);
    if (!message) return std::nullopt;
    return message->tag == outcome_tag
               ? TaskAnswer{message->text, ""}
               : TaskAnswer{"", message->text, message->tag == failure_for_now_tag};
  }

 private:
  Ranks ranks_;
  int rank_;
};

TaskTeam::TaskTeam(const Ranks& ranks, unsigned int n_processes, double limit_seconds) {
  for (const char is_first : first_of_machines(ranks))
    is_first_of_machine_.push_back(is_first != 0);
  workers_.push_back(std::make_unique<OwnWorker>(limit_seconds));
  for (int rank = 1; rank < ranks.size(); ++rank)
    workers_.push_back(std::make_unique<RankWorker>(ranks, rank));
  while (ranks.size() == 1 && workers_.size() < n_processes)
    workers_.push_back(std::make_unique<OwnWorker>(limit_seconds));
  is_first_of_machine_.resize(workers_.size(), false);
}

TaskTeam::~TaskTeam() = default;

void TaskTeam::run(const std::vector<std::string>& tasks, AtOnce at_once,
                   const std::function<void(std::size_t, const TaskAnswer&)>& on_end,
                   const std::function<void()>& on_wait) {
  constexpr auto between_waits = std::chrono::milliseconds(100);
  auto waited = std::chrono::steady_clock::now();
  std::size_t n_given = 0, n_ended = 0;
  while (n_ended < tasks.size()) {
    for (std::size_t w = 0; w < workers_.size(); ++w) {
      Worker& worker = *workers_[w];
      if (const auto answer = worker.task ? worker.answer() : std::nullopt) {
        const std::size_t task = *worker.task;
        worker.task.reset();
        ++n_ended;
        on_end(task, *answer);
      }
      const bool takes_part = at_once == AtOnce::all || is_first_of_machine_[w];
      if (takes_part && !worker.task && n_given < tasks.size()) {
        worker.give(tasks[n_given]);
        worker.task = n_given++;
      }
    }
    std::this_thread::sleep_for(pause);
    if (const auto now = std::chrono::steady_clock::now(); now - waited > between_waits) {
      waited = now;
      on_wait();
    }
    if (interruption()) throw Interrupted{};
  }
  on_wait();
}

void serve_task_team(const Ranks& ranks, double limit_seconds) {
  constexpr int root = 0;
  first_of_machines(ranks);
  TaskProcess process(own_command(), limit_seconds);
  while (true) {
    if (const auto message = receive(ranks, root)) {
      if (message->tag == end_tag) return;
      try {
        process.give(message->text);
      } catch (const InputError& error) {
        send(ranks, root, failure_tag, error.what());
      }
    }
    if (const auto answer = process.answer()) {
      const Tag tag = answer->failure.empty()     ? outcome_tag
                      : answer->may_succeed_later ? failure_for_now_tag
                                                  : failure_tag;
      send(ranks, root, tag, answer->failure.empty() ? answer->outcome : answer->failure);
    }
    std::this_thread::sleep_for(pause);
  }
}

}  // namespace smoothfem
