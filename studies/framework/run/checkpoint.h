// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
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
};

/// The present state of a study, in a folder. A run that is killed at any moment resumes from here;
/// after a power failure it resumes from the last saved state.
/// Every file is written as a whole. Numbers are restored bitwise identical. Damaged files are
/// refused (sealed_file.h). Only the program that wrote the files can read them. Errors are
/// InputError.
class Checkpoint {
 public:
  explicit Checkpoint(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Returns the name of a mesh's method, or with a degree that of its finite element records.
  static std::string name(const std::string& mesh, const std::string& method, int degree = 0);

  /// Saves one array of numbers per record: coordinates (without degree) or nodal errors (with
  /// degree).
  void save_numbers(const std::string& name, std::size_t record,
                    const std::vector<double>& numbers) const;
  /// Loads such an array. size: its required length.
  std::vector<double> load_numbers(const std::string& name, std::size_t record,
                                   std::size_t size) const;

  /// Saves a trajectory. All its snapshots must have been saved.
  void save(const std::string& name, const Trajectory& trajectory) const;
  std::optional<Trajectory> load_trajectory(const std::string& name) const;
  /// Links the trajectory of this name and its snapshots from the checkpoint in another folder.
  /// Does nothing if this checkpoint has them, or if the other one does not.
  void adopt(const std::filesystem::path& other, const std::string& name) const;

  void save(const std::string& name, const SolvedRecords& solved) const;
  std::optional<SolvedRecords> load_solved(const std::string& name) const;

  /// Removes the checkpoint of a complete study, whose results are elsewhere.
  void remove() const;

 private:
  static std::string numbers_name(const std::string& name, std::size_t record);

  std::filesystem::path folder_;
};

/// Converts points to numbers, one coordinate after the other, and back.
template <int dim>
std::vector<double> numbers_of(std::span<const Point<dim>> points);
template <int dim>
std::vector<Point<dim>> points_of(const std::vector<double>& numbers);

}  // namespace smoothfem
