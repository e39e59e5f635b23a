// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/table_study.h"

#include <cstdio>
#include <cstdlib>

#include "meshes/io/atomic_file.h"
#include "studies/framework/results/folder_lock.h"
#include "studies/framework/results/provenance.h"
#include "studies/framework/results/results_folder.h"
#include "studies/framework/run/phase_times.h"
#include "studies/framework/run/progress.h"

namespace smoothfem {

void run_table_study(const StudyHeader& study, const StudyOptions& options,
                     const std::vector<StudyTable>& tables) {
  if (options.ranks.size() > 1)
    throw InputError("the study " + study.name +
                     " has no work for several processes: start it without mpirun");
  if (options.dry_run) {
    std::printf("%s\n\nTables (no meshes) in %s; nothing has been written:\n", study.title.c_str(),
                options.out.c_str());
    for (const auto& table : tables) std::printf("  %s\n", table.file.c_str());
    return;
  }
  require_writable(options.out);
  if (!options.mesh_dir.empty())
    throw InputError("--mesh-dir is given, but the study " + study.name +
                     " has no meshes; leave it out");
  std::optional<FolderLock> lock(options.out);
  const EarlierRun earlier =
      options.force ? EarlierRun{} : read_provenance(options.out / "provenance.json");
  const std::string changes = differences_from(earlier, study, {}, {});

  Progress progress(options.quiet);
  if (earlier.status == "complete" && changes.empty()) {
    progress.say("The results in " + options.out.string() +
                 " are complete: nothing to do. --force starts anew and keeps them under another "
                 "name.");
    remove_earlier_results(options.out, options.keep);  // a killed run may not have done so
    return;
  }
  if (options.force) progress.say(move_old_results(options.out));
  if (earlier.status.empty()) make_results_folder(options.out, lock);
  if (earlier.status == "complete") set_aside_results(options.out, earlier.written);
  if (!changes.empty()) progress.say("Since the last run, " + changes + ".");
  PhaseTimes times;
  const std::string started = now_utc();
  const auto write_provenance = [&](const std::string& status) {
    write_atomically(options.out / "provenance.json",
                     provenance_json({.study = study,
                                      .processors = {options.smoothing_threads, 1, 1},
                                      .status = status,
                                      .started = started,
                                      .seconds = times.seconds(),
                                      .earlier_sessions = earlier.sessions}));
  };
  write_provenance("running");
  for (const auto& table : tables) {
    progress.begin(table.file, 0);
    times.measure(table.file, [&] { write_atomically(options.out / table.file, table.compute()); });
    progress.end();
    if (options.interrupted != nullptr && *options.interrupted) {
      write_provenance("interrupted");
      progress.say("Interrupted; the same command starts anew.");
      std::_Exit(130);
    }
  }
  write_provenance("complete");
  remove_earlier_results(options.out, options.keep);
}

}  // namespace smoothfem
