// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fem/poisson_solver.h"
#include "studies/framework/run/trajectory.h"

namespace smoothfem {

/// The finite element records of one mesh, method and degree.
struct SolvedRecords {
  std::map<std::size_t, SolutionRecord> records;  ///< by the record of the trajectory
  std::map<std::size_t, double> seconds;          ///< of each record
  std::vector<double> eigenvectors;               ///< start values of the next record
  std::string session;                            ///< start of the session that began them (UTC)
};

/// The results that a study has computed so far, in a folder. Each has a name that says what made
/// it (result_names.h). So a run that was killed resumes from here, and a run of a changed study
/// computes only the new results. After a power failure a run resumes from the last saved state.
/// Every file is written as a whole. Numbers are restored bitwise identical. Damaged files are
/// refused (sealed_file.h). Only the program that wrote the files can read them. Errors are
/// InputError.
class KeptResults {
 public:
  /// is_writer: false for a process that leaves it to another to save what both have. Only
  /// save_numbers() then writes.
  explicit KeptResults(std::filesystem::path folder, bool is_writer = true)
      : folder_(std::move(folder)), is_writer_(is_writer) {}

  /// Saves one array of numbers per record: coordinates of a trajectory or nodal errors of solved
  /// records.
  void save_numbers(const std::string& name, std::size_t record,
                    const std::vector<double>& numbers) const;
  /// Loads such an array. size: its required length.
  std::vector<double> load_numbers(const std::string& name, std::size_t record,
                                   std::size_t size) const;

  /// Saves a trajectory. All its snapshots must have been saved.
  void save(const std::string& name, const Trajectory& trajectory) const;
  std::optional<Trajectory> load_trajectory(const std::string& name) const;

  void save(const std::string& name, const SolvedRecords& solved) const;
  std::optional<SolvedRecords> load_solved(const std::string& name) const;

  /// Keeps a copy of a mesh file.
  void save_mesh(const std::string& name, const std::filesystem::path& file) const;
  /// Returns the path of that copy, or nothing if there is none or it has been changed.
  std::optional<std::filesystem::path> find_mesh(const std::string& name) const;

  /// Returns where the pieces of a mesh in parts are kept. They are complete if load_notes() finds
  /// the mesh's notes, which are saved last.
  std::filesystem::path pieces_file(const std::string& name) const {
    return folder_ / (name + ".pvtu");
  }
  void save_notes(const std::string& name, const std::vector<std::string>& notes) const;
  std::optional<std::vector<std::string>> load_notes(const std::string& name) const;

  /// True if there are solved records of this name.
  bool has_solved(const std::string& name) const;

  /// Removes all results but those of these names. Returns a sentence with the size of the others
  /// if they are large; otherwise nothing.
  std::string keep_only(const std::set<std::string>& names) const;

 private:
  static std::string numbers_name(const std::string& name, std::size_t record);

  std::filesystem::path folder_;
  bool is_writer_;
};

/// Converts points to numbers, one coordinate after the other, and back.
template <int dim>
std::vector<double> numbers_of(std::span<const Point<dim>> points);
template <int dim>
std::vector<Point<dim>> points_of(const std::vector<double>& numbers);

}  // namespace smoothfem
