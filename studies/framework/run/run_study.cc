// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/run_study.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "fem/adaptivity/poisson_problem.h"
#include "fem/adaptivity/solver_problem.h"
#include "fem/elements/adaptive_quadrature.h"
#include "fem/materials/materials_of_mesh.h"
#include "fem/solutions/check_pieces.h"
#include "meshes/io/atomic_file.h"
#include "smoothing/base/interruption.h"
#include "smoothing/base/parallel.h"
#include "smoothing/base/text.h"
#include "studies/framework/definition/seeds.h"
#include "studies/framework/definition/study_file.h"
#include "studies/framework/results/folder_lock.h"
#include "studies/framework/results/method_files.h"
#include "studies/framework/results/provenance.h"
#include "studies/framework/results/results_folder.h"
#include "studies/framework/run/all_or_nothing.h"
#include "studies/framework/run/constraints/periodic_nodes.h"
#include "studies/framework/run/kept/result_names.h"
#include "studies/framework/run/phase_times.h"
#include "studies/framework/run/progress.h"
#include "studies/framework/run/solve_workers.h"
#include "studies/framework/run/study_data.h"
#include "studies/framework/run/study_plan.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

template <int dim, int spacedim>
class StudyRun {
 public:
  StudyRun(const Study& study, const StudyOptions& options)
      : study_(study),
        options_(options),
        team_(study.in_parts ? Ranks() : options.ranks),
        n_workers_(n_solve_workers(study, options)),
        progress_(options.quiet || !is_writer()),
        data_{study, solves_of(study),
              KeptResults(options.kept.empty() ? options.out / kept_folder : options.kept,
                          is_writer()),
              started_} {}

  void run() {
    // All of the user's input is checked before the first file is written, except meshes that are
    // made in parts, which are kept at once.
    write([&] {
      require_writable(options_.out);
      require_published_files(study_, options_.mesh_dir);
      lock_.emplace(options_.out);
      if (study_.in_parts && options_.force) progress_.say(move_old_results(options_.out));
    });
    if (!options_.force) earlier_ = read_provenance(options_.out / "provenance.json");
    write([&] { require_unchanged_meshes(earlier_, options_.out); });
    times_.measure("meshes", [&] {
      prepare_meshes();
      if (!study_.degrees.empty()) {
        require_support_of_ties();
        require_support_of_curved_cells();
      }
      if (needs_solutions(study_)) together([&] { make_solutions(); });
    });
    changes_ =
        differences_from(earlier_, study_.header, mesh_facts(), study_.methods, study_.solvers);
    if (earlier_.status == "complete" && changes_.empty() && !options_.retime) {
      report_complete();
      // The earlier run may have been killed before it did so.
      if (is_alone()) write([&] { remove_replaced(); });
      return;
    }
    // A run that makes meshes only has no MPI.
    if (options_.until != RunUntil::meshes) require_support_of_solvers();
    begin_writing();
    if (options_.until == RunUntil::meshes) return write_provenance("interrupted");
    times_.measure("smoothing", [&] { smooth_meshes(); });
    if (options_.until == RunUntil::smoothing) return write_provenance("interrupted");
    make_tasks(data_);
    report_kept();
    if (!data_.solves.empty()) times_.measure("finite_elements", [&] { solve(); });
    times_.measure("writing", [&] { write_results(); });
    write_provenance("complete");
    if (is_alone()) write([&] { remove_replaced(); });
  }

 private:
  /// True for the process that writes the files of results. In a study in parts all processes come
  /// here; in others the root alone.
  bool is_writer() const { return !study_.in_parts || options_.ranks.is_root(); }

  /// Runs work that writes files, or depends on files that it writes, on the writer. Collective in
  /// parts.
  template <class Work>
  void write(const Work& work) const {
    if (study_.in_parts)
      options_.ranks.on_root(work);
    else
      work();
  }

  void report_complete() {
    std::string text = "The results in " + options_.out.string() + " are complete";
    if (earlier_.commit != program_commit())
      text += " (by the program at commit " + earlier_.commit + ")";
    progress_.say(text + ": nothing to do. --force starts anew and keeps them under another name.");
  }

  /// True if the kept results are those of this study only, not of a collection's members.
  bool is_alone() const { return options_.kept.empty(); }

  /// Removes earlier results, and kept ones that no results are made of any more.
  void remove_replaced() {
    remove_earlier_results(options_.out, options_.keep);
    progress_.say(data_.kept.keep_only(used_results(options_.out)));
  }

  std::vector<MeshFacts> mesh_facts() const { return {data_.meshes.begin(), data_.meshes.end()}; }

  void prepare_meshes() {
    progress_.begin("Meshes", study_.meshes.size());
    for (const auto& description : study_.meshes) {
      progress_.update(data_.meshes.size(), description.name);
      data_.meshes.push_back(prepared_mesh(description));
      for (const auto& change : data_.meshes.back().changes)
        progress_.say(data_.meshes.back().origin + ": " + change);
      stop_if_interrupted();
    }
    progress_.end();
  }

  /// Runs work of which each rank may find its own fault, without communication.
  template <class Work>
  void together(const Work& work) const {
    if (study_.in_parts)
      options_.ranks.together(work);
    else
      work();
  }

  PreparedMesh<dim, spacedim> prepared_mesh(const StudyMesh& description) const {
    if constexpr (dim == spacedim)
      if (study_.in_parts)
        return prepare_mesh_in_parts<dim>(description, study_, options_.mesh_dir, data_.kept,
                                          options_.ranks);
    return prepare_mesh<dim, spacedim>(description, study_, options_.mesh_dir,
                                       options_.force ? nullptr : &data_.kept);
  }

  /// Throws InputError if a mesh has constraints that the study's degrees or methods do not
  /// support.
  void require_support_of_ties() const {
    for (const auto& mesh : data_.meshes) {
      if (!mesh.ties) continue;
      const std::string what =
          "mesh " + mesh.description.name + " has constraints of " +
          (study_.constrain_hanging_nodes ? "hanging nodes" : "periodic nodes");
      if (study_.degrees != std::vector{1})
        throw InputError(what +
                         ", which finite elements of degree 2 do not support; write 'set "
                         "degrees = 1'");
      if (!study_.refined_degrees.empty())
        throw InputError(what +
                         ", which refined meshes do not support; leave 'refined degrees' out");
      for (const auto& method : study_.methods)
        if (method.needs_problem(study_.dimensions))
          throw InputError(
              what + ", which method " + method.name +
              " does not support, because it moves nodes by the solution; leave it out");
    }
  }

  /// Throws InputError if the study asks for what curved cells do not support.
  void require_support_of_curved_cells() {
    for (auto& mesh : data_.meshes) {
      if (!has_curved_cells(mesh.mesh.topology(), study_.finite_elements.geometry)) continue;
      const auto refuse = [&](const std::string& what) {
        throw InputError("mesh " + mesh.description.name + " has cells of second order, " + what +
                         ", or write 'set geometry = straight' in 'subsection finite elements'");
      };
      if (mesh.ties)
        refuse("which have no constraints for hanging or periodic nodes; leave them out");
      if (!study_.refined_degrees.empty())
        refuse("which refined meshes do not support; leave 'refined degrees' out");
      for (const auto& method : study_.methods)
        if (method.needs_problem(study_.dimensions)) {
          mesh.changes.push_back(
              "methods that move nodes by the solution see straight-sided cells");
          progress_.say(mesh.origin + ": " + mesh.changes.back());
          break;
        }
    }
  }

  /// Throws InputError if a solver cannot be used on a mesh. One that fails on it gets rows with
  /// the reason later.
  void require_support_of_solvers() {
    if constexpr (dim == spacedim)
      for (std::size_t m = 0; m < data_.meshes.size(); ++m)
        for (const StudySolve& solve : data_.solves) try {
            if (solve.solver != nullptr) (void)solver_on_mesh(data_, m, solve, &team_);
          } catch (const SolverFailure&) {
          }
  }

  /// Makes the solutions. Expressions are checked at nodes of the first mesh.
  void make_solutions() {
    const auto sample = sample_of<spacedim>(data_.meshes.front().mesh.coordinates());
    data_.solutions.resize(data_.meshes.size());
    for (const StudySolution* given : solutions_of(study_)) {
      const auto solution = study_solution<spacedim>(*given, sample);
      if constexpr (dim == spacedim)
        if (study_.constrain_periodic_nodes)
          for (const auto& mesh : data_.meshes) require_periodic(solution, mesh.mesh);
      for (std::size_t m = 0; m < data_.meshes.size(); ++m)
        data_.solutions[m].push_back(solution_on(data_.meshes[m], *given, solution));
    }
  }

  /// Returns the solution on one of the meshes.
  static ManufacturedSolution<spacedim> solution_on(
      const PreparedMesh<dim, spacedim>& prepared, const StudySolution& given,
      const ManufacturedSolution<spacedim>& solution) {
    if constexpr (dim == spacedim) {
      if (given.has_materials()) try {
          return with_materials_of(solution, prepared.mesh);
        } catch (const InputError& error) {
          throw InputError(
              with_line(given.lines, "mesh " + prepared.description.name + ": " + error.what()));
        }
      at_line(given.lines, [&] { check_pieces(solution, prepared.mesh); });
    }
    return solution;
  }

  /// Returns the degree for a solver, or 0 if it has none. Throws InputError if it lacks this one.
  static int with_degree(const StudySolver& solver, int degree) {
    const auto& offered = solver.traits.degrees;
    if (offered.empty()) return 0;
    if (std::find(offered.begin(), offered.end(), degree) == offered.end())
      throw InputError("the solver " + solver.label + " has no finite elements of degree " +
                       std::to_string(degree) + ", which a method of the study asks for");
    return degree;
  }

  /// Returns the problem that a method moves nodes by; null if the study solves nothing.
  std::shared_ptr<const Problem<spacedim>> problem_of(std::size_t m, const StudyMethod& method) {
    if (study_.in_parts) return nullptr;
    if constexpr (dim == spacedim) {
      if (const StudySolver* solver = solver_smoothed_for(study_, method))
        return make_solver_problem<dim>(
            data_.meshes[m].for_solvers(data_.meshes[m].mesh.copied_coordinates()),
            [this, m, solver](int degree) {
              return solver_on_mesh(data_, m, {solver, with_degree(*solver, degree)}, nullptr);
            });
      if (data_.solutions.empty()) return nullptr;
      std::vector<std::size_t> chosen;  // indices of the study's solutions
      const auto all = solutions_of(study_);
      for (const auto& label : method.smooth_for)
        for (std::size_t s = 0; s < all.size(); ++s)
          if (all[s]->label == label) chosen.push_back(s);
      if (chosen.empty()) chosen.push_back(0);
      std::vector<ManufacturedSolution<dim>> solutions;
      for (const std::size_t s : chosen) solutions.push_back(data_.solutions[m][s]);
      if constexpr (dim == 2)
        return make_poisson_problem(std::move(solutions), study_.finite_elements.natural_groups);
      else
        return make_poisson_problem<3>(
            std::move(solutions),
            [this, m, chosen](const Mesh<3>& mesh, int degree, std::size_t number) {
              PoissonOptions options = study_.finite_elements;
              options.degree = degree;
              return team_.make_energy_solver(mesh, options, data_.solutions[m], chosen[number]);
            });
    }
    return nullptr;
  }

  /// Begins with the provenance, so that results of an earlier run are not taken for those of this
  /// one.
  void begin_writing() {
    writing_ = true;
    write([&] { prepare_folder(); });
    write_provenance("running");
    for (auto& prepared : data_.meshes) {
      write_initial_mesh(prepared, options_.out, data_.kept);
      data_.mesh_contents.push_back(content_of_mesh(prepared));
    }
    write_provenance("running");  // now with the checksums
  }

  static std::string content_of_mesh(const PreparedMesh<dim, spacedim>& prepared) {
    return prepared.parts ? prepared.parts->content() : mesh_content(prepared.mesh, prepared);
  }

  /// Makes the folder of results ready for this run.
  void prepare_folder() {
    if (options_.force && !study_.in_parts) progress_.say(move_old_results(options_.out));
    if (earlier_.status.empty()) {
      make_results_folder(options_.out, lock_);
    } else {
      remove_unfinished_files(options_.out);
      if (earlier_.status != "complete")
        progress_.say("Resuming the run in " + options_.out.string() + ".");
      else if (is_alone())
        set_aside_results(options_.out, earlier_.written);
      if (!changes_.empty()) {
        progress_.say("Since the last run, " + changes_ + ".");
        remove_outdated_files();
      }
    }
  }

  /// Removes files that the run of a changed study may not write again.
  void remove_outdated_files() const {
    std::error_code ignored;  // the folder is writable
    for (const char* name : {"meshes", "refined.csv", "solutions.csv", "metrics.csv"})
      fs::remove_all(options_.out / name, ignored);
    // A log stays as long as its method: kept results have no new one.
    std::set<std::string> logs;
    for (const auto& mesh : study_.meshes)
      for (const auto& method : study_.methods) logs.insert(log_name(mesh.name, method.name));
    std::vector<fs::path> others;
    for (const auto& entry : fs::directory_iterator(options_.out / "logs", ignored))
      if (!logs.contains(entry.path().filename().string())) others.push_back(entry.path());
    for (const auto& path : others) fs::remove(path, ignored);
  }

  /// Smooths all meshes. A smoother that waits for another program notices the interruption by
  /// itself.
  void smooth_meshes() {
    try {
      smooth_all();
    } catch (const Interrupted&) {
      stop_if_interrupted();
      throw;
    }
  }

  void smooth_all() {
    progress_.begin("Smoothing", data_.meshes.size() * study_.methods.size());
    std::size_t done = 0;
    for (const auto& prepared : data_.meshes) {
      auto& of_mesh = data_.trajectories.emplace_back();
      data_.trajectory_names.emplace_back();
      for (const auto& method : study_.methods) {
        const std::string what = prepared.description.name + ", " + method.title;
        of_mesh.push_back(trajectory_of(prepared, method, [&](const IterationRecord& record) {
          stop_if_interrupted();
          progress_.update(done, what + ": " + iteration_text(record));
        }));
        ++done;
        stop_if_interrupted();
      }
    }
    progress_.end();
  }

  /// Returns for example "simultaneous 120, q_mean 0.7312".
  static std::string iteration_text(const IterationRecord& record) {
    char q_mean[16];
    std::snprintf(q_mean, sizeof(q_mean), "%.4f", record.quality.q_mean);
    return record.stage + " " + std::to_string(record.iteration) + ", q_mean " + q_mean;
  }

  Trajectory trajectory_of(const PreparedMesh<dim, spacedim>& prepared, const StudyMethod& method,
                           const WatchIteration& watch) {
    const auto m = static_cast<std::size_t>(&prepared - data_.meshes.data());
    const unsigned int threads = options_.threads_of(method);
    const std::string name =
        trajectory_name(data_.mesh_contents[m], method, study_,
                        is_of_results_only(study_, prepared.description), threads);
    data_.trajectory_names[m].push_back(name);
    if (!options_.retime)
      if (auto known = known_trajectory(name)) {
        ++n_kept_trajectories_;
        return *std::move(known);
      }
    set_n_threads(static_cast<int>(threads));
    std::map<std::size_t, std::string> contents;  // by record
    Trajectory trajectory = record_trajectory(
        prepared.mesh, method, study_, is_of_results_only(study_, prepared.description),
        problem_of(m, method), folders_of(log_name(prepared.description.name, method.name)),
        [&](std::size_t record, std::span<const Point<spacedim>> coordinates) {
          contents[record] = save_coordinates(prepared, name, record, coordinates);
        },
        watch);
    trajectory.session = started_;
    trajectory.content = content_of(trajectory, contents);
    write([&] { data_.kept.save(name, trajectory); });
    if (!trajectory.failure.empty())
      progress_.say(prepared.description.name + ", " + method.title +
                    " failed: " + trajectory.failure + ".");
    return trajectory;
  }

  /// Returns a kept trajectory, unless its method has failed: the reason may be gone, so that is
  /// tried again. In parts, the root decides.
  std::optional<Trajectory> known_trajectory(const std::string& name) const {
    std::optional<Trajectory> known;
    bool is_known = false;
    write([&] {
      known = data_.kept.load_trajectory(name);
      is_known = known && known->failure.empty();
    });
    if (study_.in_parts) {
      options_.ranks.broadcast(is_known);
      if (is_known && !known) known = data_.kept.load_trajectory(name);
    }
    return is_known ? known : std::nullopt;
  }

  /// Keeps the coordinates of a record. Returns a digest of them.
  std::string save_coordinates(const PreparedMesh<dim, spacedim>& prepared, const std::string& name,
                               std::size_t record,
                               std::span<const Point<spacedim>> coordinates) const {
    if constexpr (dim == spacedim)
      if (prepared.parts) return prepared.parts->save(data_.kept, name, record, coordinates);
    const auto numbers = numbers_of<spacedim>(coordinates);
    data_.kept.save_numbers(name, record, numbers);
    return content_of(numbers);
  }

  /// Reports how many results an earlier run has left.
  void report_kept() const {
    if (earlier_.status.empty()) return;
    const std::size_t n_smoothed = data_.meshes.size() * study_.methods.size();
    const auto n_solved = std::count_if(data_.tasks.begin(), data_.tasks.end(),
                                        [](const SolveTask& task) { return task.done.load(); });
    progress_.say("Kept: " + std::to_string(n_kept_trajectories_) + " of " +
                  std::to_string(n_smoothed) + " smoothing runs, " + std::to_string(n_solved) +
                  " of " + std::to_string(data_.tasks.size()) + " finite element solves.");
  }

  static std::string log_name(const std::string& mesh, const std::string& method) {
    return mesh + "_" + method + ".log";
  }

  /// Returns the folders for a method's files. log: name of its log.
  SmootherFolders folders_of(const std::string& log) const {
    return {study_.folder, std::filesystem::absolute(options_.out) / "logs" / log};
  }

  void solve() {
    for (auto& task : data_.tasks)
      if (task.done)
        costs_.add(data_.kind_of(task), task.seconds);
      else
        costs_.expect(data_.kind_of(task));
    const std::vector<SolveTask*> open = open_tasks();
    announce(open.size());
    progress_.begin("Finite elements", data_.tasks.size());
    if (study_.in_parts)
      run_tasks_in_parts(open);
    else
      run_tasks(open);
    progress_.end();
    report_gauss_points();
  }

  /// Reports the chosen numbers of Gauss points of hexahedra. It covers all records, including
  /// those of earlier sessions.
  void report_gauss_points() {
    for (const auto& task : data_.tasks) {
      if (task.solution.most_points == 0) continue;
      int& n_points = data_.meshes[task.job.mesh].max_points[data_.solves[task.job.solve].degree];
      n_points = std::max(n_points, task.solution.most_points);
    }
    for (const auto& mesh : data_.meshes)
      for (const auto& [degree, n_points] : mesh.max_points)
        progress_.say("Cells of " + mesh.description.name + ", degree " + std::to_string(degree) +
                      ": " + std::to_string(adaptive_quadrature::rule_sequence.front()) + " to " +
                      std::to_string(n_points) +
                      " Gauss points per direction, chosen for each cell.");
  }

  /// Returns the tasks to do. Representative ones come first, so that the estimate of the remaining
  /// time is soon good.
  /// In a job on a volume mesh, each verified condition number starts from the record before. Such
  /// jobs keep the order of the records.
  std::vector<SolveTask*> open_tasks() {
    const bool any_order =
        dim == 2 || study_.finite_elements.condition_number != ConditionNumberMethod::verified;
    std::vector<SolveTask*> first, others;
    for (auto begin = data_.tasks.begin(); begin != data_.tasks.end();) {
      const SolveJob& job = begin->job;
      const auto representative = representative_records(job.n_tasks);
      for (std::size_t i = 0; i < job.n_tasks; ++i, ++begin) {
        if (begin->done) continue;
        const bool is_representative =
            any_order &&
            std::find(representative.begin(), representative.end(), i) != representative.end();
        (is_representative ? first : others).push_back(&*begin);
      }
    }
    first.insert(first.end(), others.begin(), others.end());
    return first;
  }

  /// Reports the number of tasks to do and their estimated time.
  void announce(std::size_t n_open) {
    constexpr double long_time = 60.0;
    const double seconds = seconds_left();
    std::string text =
        std::to_string(n_open) + " finite element solves to do, about " + duration_text(seconds);
    if (seconds > long_time)
      text += " by a rough estimate; 'set record every = " +
              std::to_string(10 * study_.record_every.default_interval) +
              "' or '--scale quick' needs fewer solves";
    if (n_open > 0) progress_.say(text + ".");
  }

  /// Estimates the seconds until all tasks are done. Tasks under way count as not begun.
  double seconds_left() const { return costs_.seconds_to_come() / n_workers_; }

  std::vector<SolveQueue::Worker> workers(const std::vector<SolveTask*>& open) {
    if constexpr (spacedim > dim)
      return {};
    else if constexpr (dim == 2)
      return solve_workers(data_, open, n_workers_);
    else
      return solve_workers(data_, open, team_);
  }

  /// Runs tasks on all ranks, one after the other, and writes the rows after each.
  void run_tasks_in_parts(const std::vector<SolveTask*>& open) {
    if constexpr (dim == spacedim) {
      const auto work = solve_worker_in_parts<dim>(data_, open, options_.ranks);
      std::size_t n_done = data_.tasks.size() - open.size();
      for (std::size_t i = 0; i < open.size(); ++i) {
        stop_if_interrupted();
        work(i);
        costs_.forget(data_.kind_of(*open[i]));
        costs_.add(data_.kind_of(*open[i]), open[i]->seconds);
        ++n_done;
        progress_.update(n_done, solved_text(n_done), seconds_left());
        write([&] { write_iterations(); });
        write_provenance("running");
      }
    }
  }

  std::string solved_text(std::size_t n_done) const {
    return std::to_string(n_done) + " of " + std::to_string(data_.tasks.size()) + " solved";
  }

  /// Waits for the queue, and writes the available rows every few seconds.
  void run_tasks(const std::vector<SolveTask*>& open) {
    using Clock = std::chrono::steady_clock;
    constexpr auto look = std::chrono::milliseconds(50);
    constexpr auto between_writes = std::chrono::seconds(5);
    const std::size_t n_known = data_.tasks.size() - open.size();
    SolveQueue queue(open.size(), workers(open));
    auto last_write = Clock::now();  // writing would disturb the times of the first solves
    std::vector<SolveTask*> not_counted = open;
    while (!queue.finished()) {
      std::this_thread::sleep_for(look);
      stop_if_interrupted();
      std::erase_if(not_counted, [&](const SolveTask* task) {
        if (!task->done) return false;
        costs_.forget(data_.kind_of(*task));
        costs_.add(data_.kind_of(*task), task->seconds);
        return true;
      });
      const std::size_t n_done = n_known + queue.n_done();
      progress_.update(n_done, solved_text(n_done), seconds_left());
      if (Clock::now() - last_write < between_writes) continue;
      write_iterations();
      write_provenance("running");
      last_write = Clock::now();
    }
    try {
      queue.rethrow();
    } catch (const Interrupted&) {  // a solver has noticed it before this thread
      stop_if_interrupted();
      throw;
    }
  }

  /// Ends the process if the user has interrupted it. Tasks may run on other threads for a long
  /// time, so it does not wait for them. Finished work is kept.
  void stop_if_interrupted() {
    bool is_asked = options_.interrupted != nullptr && *options_.interrupted;
    if (study_.in_parts) is_asked = options_.ranks.any(is_asked);
    if (!is_asked) return;
    write([&] { report_interruption(); });  // ends the root, and mpirun then ends the other ranks
    std::_Exit(130);
  }

  /// Writes the rows so far, and ends the process.
  [[noreturn]] void report_interruption() {
    if (!writing_) {
      progress_.say("Interrupted before the first result.");
      std::_Exit(130);
    }
    const auto rows = write_iterations();
    try {
      write_provenance_file("interrupted");
    } catch (const Interrupted&) {  // Python, which describes its methods, has got the signal, too
      write_provenance_file("interrupted");
    }
    progress_.say("Interrupted: the " + std::to_string(rows) + " rows finished so far are in " +
                  (options_.out / "iterations.csv").string() +
                  "; the same command resumes from here.");
    std::_Exit(130);
  }

  std::size_t write_iterations() const {
    const auto rows = finished_rows(data_);
    write_atomically(options_.out / "iterations.csv", iterations_csv(study_.header.name, rows));
    return rows.size();
  }

  /// Rows without those of meshes and degrees for which only results are solved: they do not show
  /// when an error fell.
  std::vector<IterationRow> rows_with_every_record() const {
    auto rows = finished_rows(data_);
    std::erase_if(rows, [&](const auto& row) { return !is_recorded(study_, row.degree); });
    for (const auto& mesh : data_.meshes)
      if (is_of_results_only(study_, mesh.description))
        std::erase_if(rows, [&](const auto& row) { return row.mesh == mesh.description.name; });
    return rows;
  }

  void write_results() {
    progress_.begin("Results", 0);
    const auto texts = tables();
    write([&] {
      write_iterations();
      for (const auto& [name, text] : texts) write_atomically(options_.out / name, text);
    });
    if (study_.write_meshes) write_meshes(data_, options_.out);
    progress_.end();
    if (!study_.solvers.empty()) report_failed_solvers();
  }

  /// Returns the text of each table but iterations.csv, by file name. Collective in parts.
  std::map<std::string, std::string> tables() {
    const std::string& study = study_.header.name;
    std::map<std::string, std::string> texts;
    texts["summary.csv"] = summary_csv(study, summary_rows(data_));
    if (!study_.refined_degrees.empty())
      texts["refined.csv"] = refined_csv(study, refined_rows(data_));
    if (!study_.further_solutions.empty())
      texts["solutions.csv"] = solutions_csv(study, solution_rows(data_));
    if (!study_.metrics.empty())
      texts["metrics.csv"] = metrics_csv(study, metric_rows(data_, [&] { stop_if_interrupted(); }));
    const auto thresholds =
        study_.thresholds.reference.empty()
            ? std::vector<ThresholdRow>()
            : reach_thresholds(rows_with_every_record(), study_.thresholds.reference,
                               study_.thresholds.margin);
    texts["thresholds.csv"] = thresholds_csv(study, thresholds);
    return texts;
  }

  /// Says on the error stream if solvers other than Poisson's have failed: their columns are then
  /// empty.
  void report_failed_solvers() const {
    const auto rows = summary_rows(data_);
    std::size_t n_failed = 0;
    std::string first;
    for (const auto& row : rows)
      for (const auto& solver : study_.solvers)
        if (row.status.find(solver.label + ": failed") != std::string::npos) {
          ++n_failed;
          if (first.empty()) first = row.mesh + ", " + row.method + ": " + row.status;
          break;
        }
    if (n_failed > 0)
      std::fprintf(stderr, "smoothfem: a solver failed for %zu of %zu rows of summary.csv (%s)\n",
                   n_failed, rows.size(), in_one_line(first).c_str());
  }

  /// Returns the problem as text.
  ProblemFacts problem_facts() const {
    ProblemFacts facts{.solutions = {},
                       .natural = study_.finite_elements.natural_groups,
                       .load = study_.finite_elements.load == Load::nodal ? "nodal" : "quadrature"};
    if constexpr (dim == spacedim)
      if (needs_solutions(study_))
        for (const StudySolution* solution : solutions_of(study_))
          facts.solutions.push_back(
              {solution->label, u_text<dim>(*solution), diffusivity_text(*solution)});
    for (const auto& mesh : data_.meshes)
      if (has_curved_cells(mesh.mesh.topology(), Geometry::curved))
        facts.geometry =
            study_.finite_elements.geometry == Geometry::curved ? "curved" : "straight";
    return facts;
  }

  /// Collective in parts.
  void write_provenance(const std::string& status) {
    write([&] { write_provenance_file(status); });
  }

  void write_provenance_file(const std::string& status) {
    const bool is_complete = status == "complete";
    write_atomically(
        options_.out / "provenance.json",
        provenance_json(
            {.study = study_.header,
             .processors = {options_.smoothing_threads, n_workers_, options_.ranks.size()},
             .status = status,
             .started = started_,
             .seconds = times_.seconds(),
             .earlier_sessions = earlier_.sessions,
             .dimensions = study_.dimensions,
             .meshes = mesh_facts(),
             .methods = study_.methods,
             .solvers = study_.solvers,
             .problem = problem_facts(),
             .results = is_complete ? sessions_of(data_) : std::vector<ResultSessions>(),
             .kept = is_complete ? names_of_kept(data_) : std::set<std::string>()}));
  }

  const Study& study_;
  const StudyOptions& options_;
  const std::string started_ = now_utc();
  SolverTeam team_;  ///< the other ranks wait for its commands from the beginning
  unsigned int n_workers_;
  mutable Progress progress_;
  StudyData<dim, spacedim> data_;
  SolveCosts costs_;
  EarlierRun earlier_;
  std::string changes_;  ///< of the study since the earlier run
  std::size_t n_kept_trajectories_ = 0;
  std::optional<FolderLock> lock_;
  bool writing_ = false;  ///< the results folder has files of this run
  PhaseTimes times_;
};

/// All ranks run the study. Each has its parts of the meshes, and the root writes.
void run_study_in_parts(Study study, const StudyOptions& options) {
  if (options.dry_run)
    throw InputError("--dry-run reads whole meshes, which the study " + study.header.name +
                     " avoids by 'set in parts = true'; leave one of them out");
  if (!options.mesh_dir.empty()) study.meshes = without_published_repetitions(study.meshes);
  note_files(study);
  all_or_nothing(options.ranks, [&] {
    with_dimension(study.dimensions.cells,
                   [&]<int dim>() { StudyRun<dim, dim>(study, options).run(); });
  });
}

}  // namespace

void run_study(const Study& study, const StudyOptions& options) {
  if (study.in_parts) return run_study_in_parts(study, options);
  if (study.dimensions.cells == 2 && options.ranks.size() > 1)
    throw InputError("the study " + study.header.name +
                     " has planar meshes, whose records are shared among threads, not processes: "
                     "start it without mpirun");
  if (!options.ranks.is_root())
    return options.dry_run ? void() : serve_solves(study, options.ranks);
  Study taken = study;
  if (!options.mesh_dir.empty()) taken.meshes = without_published_repetitions(taken.meshes);
  if (options.dry_run) return print_plan(taken, options);  // before commands say their version
  note_files(taken);
  with_dimensions(study.dimensions,
                  [&]<int dim, int spacedim>() { StudyRun<dim, spacedim>(taken, options).run(); });
}

}  // namespace smoothfem
