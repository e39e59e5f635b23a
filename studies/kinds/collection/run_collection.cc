// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/collection/run_collection.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <set>

#include "meshes/doctor/finding.h"
#include "meshes/io/atomic_file.h"
#include "smoothing/base/interruption.h"
#include "studies/framework/results/folder_lock.h"
#include "studies/framework/results/method_files.h"
#include "studies/framework/results/provenance.h"
#include "studies/framework/results/results_folder.h"
#include "studies/framework/results/sha256.h"
#include "studies/framework/run/kept/kept_results.h"
#include "studies/framework/run/kept/result_names.h"
#include "studies/framework/run/phase_times.h"
#include "studies/framework/run/progress.h"
#include "studies/kinds/collection/definition/expand_members.h"
#include "studies/kinds/collection/member_row.h"
#include "studies/kinds/collection/member_worker.h"
#include "studies/kinds/collection/tasks/task_team.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

struct Phase {
  const char* name;
  RunUntil until;
  const char* needs;  ///< status of a member that the phase is for
  const char* makes;
};
constexpr Phase phases[] = {
    {"meshes", RunUntil::meshes, member_open, member_meshed},
    {"smoothing", RunUntil::smoothing, member_meshed, member_smoothed},
    {"finite_elements", RunUntil::results, member_smoothed, member_complete}};

const char* title_of(const Phase& phase) {
  return phase.until == RunUntil::meshes      ? "Meshes"
         : phase.until == RunUntil::smoothing ? "Smoothing"
                                              : "Finite elements";
}

/// Returns a process's task as text.
std::string task_text(const Phase& phase, const Member& member) {
  return std::string(phase.name) + " " + member.name;
}

/// Reads a task's text. Throws InputError if the member does not exist any more.
std::pair<const Phase&, const Member&> phase_and_member(const Collection& collection,
                                                        const std::string& task) {
  const auto blank = task.find(' ');
  const auto phase = std::find_if(std::begin(phases), std::end(phases), [&](const Phase& p) {
    return task.compare(0, blank, p.name) == 0;
  });
  const auto member = std::find_if(
      collection.members.begin(), collection.members.end(),
      [&](const Member& m) { return task.compare(blank + 1, std::string::npos, m.name) == 0; });
  if (phase == std::end(phases) || member == collection.members.end())
    throw InputError("the study's members have changed while it ran; start it again");
  return {*phase, *member};
}

/// Returns a number that a member's work grows with; 1 as long as it is not known.
double size_of(const MemberRow& row) {
  const auto n_cells = row.find("n_cells");
  return n_cells == row.end() || n_cells->second.empty() ? 1.0 : std::stod(n_cells->second);
}

std::map<std::string, std::string> meshes_of(const std::vector<Member>& members) {
  std::map<std::string, std::string> meshes;
  for (const auto& member : members) meshes[member.name] = member.mesh.name;
  return meshes;
}

class CollectionRun {
 public:
  CollectionRun(const Collection& collection, const StudyOptions& options)
      : collection_(collection),
        header_(collection.header),
        options_(options),
        n_processes_(options.ranks.size() > 1 ? static_cast<unsigned int>(options.ranks.size())
                                              : options.threads()),
        progress_(options.quiet) {
    const Shard shard = options.shard.empty() ? Shard{} : Shard::parse(options.shard);
    for (const auto& member : collection.members)
      if (shard.holds(member)) members_.push_back(&member);
  }

  void run() {
    team_.emplace(options_.ranks, n_processes_, collection_.time_limit);
    require_writable(options_.out);
    lock_.emplace(options_.out);
    if (!options_.force) earlier_ = read_provenance(options_.out / "provenance.json");
    note_contents_of_files();
    read_rows_of_members();
    const std::string changes = differences_from(earlier_, header_, {}, {});
    if (earlier_.status == "complete" && changes.empty() && is_complete() &&
        folders_of_others().empty()) {
      report_complete();
      remove_replaced();  // the earlier run may have been killed before it did so
      return;
    }
    begin_writing(changes);
    for (const auto& note : collection_.notes) progress_.say(note);
    write_provenance("running");
    try {
      for (const Phase& phase : phases) times_.measure(phase.name, [&] { run_phase(phase); });
    } catch (const Interrupted&) {
      end_interrupted();
    }
    times_.measure("writing", [&] { write_tables(); });
    write_provenance(is_complete() ? "complete" : "interrupted");
    if (is_complete()) remove_replaced();
    report();
  }

  void print_plan() const {
    std::map<std::string, std::size_t> families;
    for (const Member* member : members_) ++families[member->family];
    std::printf("%s\n\n%s in %s\n", collection_.header.title.c_str(),
                count_of(members_.size(), "member").c_str(),
                families.size() == 1 ? "1 family"
                                     : (std::to_string(families.size()) + " families").c_str());
    for (const auto& [family, n] : families) std::printf("  %-24s %zu\n", family.c_str(), n);
    std::printf("\nMembers\n%s", origins_of(members_).c_str());
    for (const auto& note : collection_.notes) std::printf("\n%s\n", note.c_str());
    std::printf("\nMethods\n");
    for (const auto& method : collection_.common.begin()->second.methods)
      std::printf("  %s\n", method.name.c_str());
    std::printf("\n%u processes; results in %s. Nothing has been written.\n", n_processes_,
                options_.out.c_str());
  }

 private:
  /// Removes earlier results, and kept ones that no results are made of any more.
  void remove_replaced() {
    remove_earlier_results(options_.out, options_.keep);
    progress_.say(KeptResults(options_.out / kept_folder).keep_only(used_results(options_.out)));
  }

  fs::path folder_of(const Member& member) const {
    return member_folder(options_.out, member.name);
  }

  /// Reads the rows that earlier runs have left. Members are open whose study or mesh has changed
  /// since then, and failed ones that are to be tried again.
  void read_rows_of_members() {
    for (const Member* member : members_) {
      MemberRow row = options_.force ? MemberRow{} : read_row(folder_of(*member));
      const bool is_new = row.empty() || made_by(folder_of(*member)) != digest_of(*member);
      const bool again = options_.retry_failed && !is_new && row["status"] == member_failed;
      if (is_new || options_.retime) row = row_of(*member);
      if (again) row["status"] = member_open;
      rows_.push_back(std::move(row));
    }
  }

  /// Returns a digest of what makes the rows of a member.
  std::string digest_of(const Member& member) {
    std::string text = member.name + '\n' + member.mesh.name + '\n' + member.family + '\n';
    const auto content = contents_.find(content_setting(member));
    for (const auto& [dimension, common] : collection_.common) {
      text += kept_mesh_name(member.mesh, content == contents_.end() ? "" : content->second,
                             common.edge_scale);
      auto& digest = digests_[{dimension, member.solution}];
      if (digest.empty()) {
        Study study = common;
        if (!member.solution.empty()) study.solution = collection_.solutions.at(member.solution);
        note_files(study);
        digest = rows_digest(study, options_.smoothing_threads);
      }
      text += '\n' + digest;
    }
    return sha256(text);
  }

  /// Returns the folders of members that are gone.
  std::vector<fs::path> folders_of_others() const {
    std::set<std::string> names;
    for (const auto& member : collection_.members) names.insert(member.name);
    std::vector<fs::path> folders;
    if (fs::is_directory(options_.out / "members"))
      for (const auto& entry : fs::directory_iterator(options_.out / "members"))
        if (!names.contains(entry.path().filename())) folders.push_back(entry.path());
    return folders;
  }

  /// Sets aside the results that this run replaces, and removes members that are gone.
  void begin_writing(const std::string& changes) {
    if (options_.force) progress_.say(move_old_results(options_.out));
    if (earlier_.status.empty()) return make_results_folder(options_.out, lock_);
    if (earlier_.status == "complete") set_aside_results(options_.out, earlier_.written);
    for (const fs::path& folder : folders_of_others()) fs::remove_all(folder);
    for (const char* table : {"metrics.csv", "refined.csv"}) fs::remove(options_.out / table);
    const auto n_open = static_cast<std::size_t>(
        std::count_if(rows_.begin(), rows_.end(), [](const MemberRow& row) {
          return row.at("status") != member_complete && row.at("status") != member_failed;
        }));
    if (!changes.empty()) progress_.say("Since the last run, " + changes + ".");
    progress_.say("Kept: " + std::to_string(rows_.size() - n_open) + " of " +
                  std::to_string(rows_.size()) + " members.");
  }

  static std::string content_setting(const Member& member) {
    return "content of mesh " + member.mesh.name;
  }

  /// Notes the content of all mesh files, also those of other shards: shards whose files differ do
  /// not belong together.
  void note_contents_of_files() {
    std::map<fs::path, std::string> of_file;
    for (const auto& member : collection_.members)
      if (const auto setting = content_setting(member);
          !member.mesh.file.empty() && !contents_.contains(setting))
        contents_[setting] = of_file.contains(member.mesh.file)
                                 ? of_file[member.mesh.file]
                                 : of_file[member.mesh.file] = sha256_of_file(member.mesh.file);
    header_.file_parameters.insert(header_.file_parameters.end(), contents_.begin(),
                                   contents_.end());
  }

  bool is_complete() const {
    return fs::exists(options_.out / "members.csv") &&
           std::all_of(rows_.begin(), rows_.end(), [](const MemberRow& row) {
             return row.at("status") == member_complete || row.at("status") == member_failed;
           });
  }

  std::size_t count(const std::string& status) const {
    return static_cast<std::size_t>(std::count_if(
        rows_.begin(), rows_.end(), [&](const auto& row) { return row.at("status") == status; }));
  }

  /// Returns the members that the phase is for, the smaller ones first. When meshes are made, one
  /// member of each mesh comes first, and the others take its kept mesh.
  std::vector<std::size_t> members_for(const Phase& phase) const {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (rows_[i].at("status") == phase.needs) chosen.push_back(i);
    std::stable_sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) {
      return size_of(rows_[a]) < size_of(rows_[b]);
    });
    if (phase.until == RunUntil::meshes) {
      std::set<std::string> meshes;
      std::stable_partition(chosen.begin(), chosen.end(), [&](std::size_t i) {
        return meshes.insert(members_[i]->mesh.name).second;
      });
    }
    return chosen;
  }

  void run_phase(const Phase& phase) {
    const auto chosen = members_for(phase);
    const bool is_timed = phase.until == RunUntil::smoothing;
    double to_do = 0.0, done = 0.0;
    std::size_t n_done = 0;
    for (const std::size_t i : chosen) to_do += size_of(rows_[i]);
    progress_.begin(title_of(phase), chosen.size());
    const auto started = std::chrono::steady_clock::now();
    std::vector<std::string> tasks;
    for (const std::size_t i : chosen) tasks.push_back(task_text(phase, *members_[i]));
    team_->run(
        tasks, is_timed ? TaskTeam::AtOnce::one_on_each_machine : TaskTeam::AtOnce::all,
        [&](std::size_t task, const TaskAnswer& answer) {
          const std::size_t i = chosen[task];
          done += size_of(rows_[i]);
          ++n_done;
          note(i, phase, answer);
        },
        [&] {
          const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - started;
          const auto left =
              done > 0.0 ? std::optional(taken.count() * (to_do - done) / done) : std::nullopt;
          progress_.update(
              n_done, std::to_string(n_done) + " of " + std::to_string(chosen.size()) + " members",
              left);
        });
    progress_.end();
  }

  /// Writes a member's new status.
  void note(std::size_t i, const Phase& phase, const TaskAnswer& end) {
    MemberRow& row = rows_[i];
    row["status"] = end.failure.empty()     ? phase.makes
                    : end.may_succeed_later ? phase.needs
                                            : member_failed;
    row["reason"] = end.failure;
    if (!end.outcome.empty()) add_facts(end.outcome, row);
    write_row(folder_of(*members_[i]), row);
    write_made_by(folder_of(*members_[i]), digest_of(*members_[i]));
    if (!end.failure.empty()) progress_.say(members_[i]->name + " failed: " + end.failure + ".");
  }

  void write_tables() { write_collected_tables(options_.out, rows_); }

  void end_interrupted() {
    team_.reset();  // before its results are collected
    write_collected_tables(options_.out, rows_);
    write_provenance("interrupted");
    progress_.say("Interrupted: " + std::to_string(count(member_complete)) + " of " +
                  std::to_string(rows_.size()) +
                  " members are complete; the same command resumes from here.");
    std::_Exit(130);
  }

  void report() {
    const std::size_t n_complete = count(member_complete), n_failed = count(member_failed),
                      n_open = rows_.size() - n_complete - n_failed;
    progress_.say(
        count_of(n_complete, "member") + (n_complete == 1 ? " is" : " are") + " complete, " +
        std::to_string(n_failed) + (n_failed == 1 ? " has" : " have") + " failed" +
        (n_failed > 0 ? "; " + (options_.out / "members.csv").string() + " says why." : ".") +
        (n_failed > 0 ? " --retry-failed tries failed members again." : "") +
        (n_open > 0 ? " " + std::to_string(n_open) +
                          " did not reach their end, for example because their process "
                          "was killed; the same command tries them again."
                    : ""));
    require_results();
  }

  /// Throws InputError if there are members, but none is complete.
  void require_results() const {
    if (rows_.empty() || count(member_complete) > 0) return;
    throw InputError("no member of " + options_.out.string() + " is complete; the first, " +
                     rows_.front().at("member") + ", failed: " + rows_.front().at("reason"));
  }

  void report_complete() {
    progress_.say("The results in " + options_.out.string() +
                  " are complete: nothing to do. --force starts anew and keeps them under another "
                  "name." +
                  (count(member_failed) > 0
                       ? " --retry-failed tries the " + std::to_string(count(member_failed)) +
                             " failed members again."
                       : ""));
    require_results();
  }

  void write_provenance(const std::string& status) const {
    const auto& [dimension, common] = *collection_.common.begin();
    write_atomically(options_.out / "provenance.json",
                     provenance_json({.study = header_,
                                      .processors = {options_.smoothing_threads, n_processes_, 1},
                                      .status = status,
                                      .started = started_,
                                      .seconds = times_.seconds(),
                                      .earlier_sessions = earlier_.sessions,
                                      .dimensions = {dimension, dimension},
                                      .methods = common.methods,
                                      .solvers = common.solvers,
                                      .shard = options_.shard,
                                      .members = meshes_of(collection_.members)}));
  }

  const Collection& collection_;
  StudyHeader header_;                           ///< with the content of files
  std::map<std::string, std::string> contents_;  ///< SHA-256 of each mesh file, by its setting
  /// Of the settings that members share, by dimension and solution.
  std::map<std::pair<int, std::string>, std::string> digests_;
  const StudyOptions& options_;
  unsigned int n_processes_;
  Progress progress_;
  std::vector<const Member*> members_;
  std::vector<MemberRow> rows_;  ///< of the members
  EarlierRun earlier_;
  std::optional<FolderLock> lock_;
  const std::string started_ = now_utc();
  PhaseTimes times_;
  std::optional<TaskTeam> team_;
};

/// Does the tasks that CollectionRun gives to one of its processes.
void work_on_members(const Collection& collection, const StudyOptions& options) {
  std::optional<MpiSession> mpi;
  std::map<std::string, MemberWorker> workers;  // by phase
  answer_tasks(options.task_socket, [&](const std::string& task) {
    const auto [phase, member] = phase_and_member(collection, task);
    return workers.try_emplace(phase.name, collection, options, phase.until, mpi)
        .first->second.run(member);
  });
}

}  // namespace

void run_collection(const Collection& collection, const StudyOptions& options) {
  if (options.task_socket >= 0) return work_on_members(collection, options);
  if (!options.mesh_dir.empty() && collection.published.empty())
    throw InputError("--mesh-dir is given, but the meshes of the study " + collection.header.name +
                     " are named by the study; leave it out");
  CollectionRun run(collection, options);  // on all ranks, so that all find the same faults
  if (!options.ranks.is_root()) {
    if (!options.dry_run) serve_task_team(options.ranks, collection.time_limit);
  } else if (options.dry_run) {
    run.print_plan();
  } else {
    run.run();
  }
}

}  // namespace smoothfem
