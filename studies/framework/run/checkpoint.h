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
  std::map<std::size_t, double> seconds;          ///< that each took
  std::vector<double> eigenvectors;               ///< what the next record starts from
};

/// What a study has done so far, in a folder: a run that is killed at any moment goes on from here,
/// and after a power failure from what was noted last. Every file appears in one piece; numbers
/// come back with the same bits, and a file that is not what was written is refused
/// (sealed_file.h). The files are for the program that wrote them alone. Errors are InputError.
class Checkpoint {
 public:
  explicit Checkpoint(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Names a mesh's method, or with a degree its finite element records.
  static std::string name(const std::string& mesh, const std::string& method, int degree = 0);

  /// One array of numbers per record: coordinates (without degree), nodal errors (with degree).
  void save_numbers(const std::string& name, std::size_t record,
                    const std::vector<double>& numbers) const;
  /// size: how many there have to be.
  std::vector<double> load_numbers(const std::string& name, std::size_t record,
                                   std::size_t size) const;

  /// Saved when all its snapshots have been.
  void save(const std::string& name, const Trajectory& trajectory) const;
  std::optional<Trajectory> load_trajectory(const std::string& name) const;
  /// Takes over the trajectory of this name, and its snapshots, if the checkpoint in another folder
  /// has them and this one has not.
  void adopt(const std::filesystem::path& other, const std::string& name) const;

  void save(const std::string& name, const SolvedRecords& solved) const;
  std::optional<SolvedRecords> load_solved(const std::string& name) const;

  /// When the study is complete, its results stand elsewhere.
  void remove() const;

 private:
  static std::string numbers_name(const std::string& name, std::size_t record);

  std::filesystem::path folder_;
};

/// Points as numbers, one coordinate after the other, and back.
template <int dim>
std::vector<double> numbers_of(std::span<const Point<dim>> points);
template <int dim>
std::vector<Point<dim>> points_of(const std::vector<double>& numbers);

}  // namespace smoothfem
