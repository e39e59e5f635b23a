// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/kept/kept_results.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "meshes/io/atomic_file.h"
#include "smoothing/base/text.h"
#include "studies/framework/results/sha256.h"
#include "studies/framework/run/kept/sealed_file.h"

namespace nlohmann {

template <class T>
struct adl_serializer<std::optional<T>> {
  static void to_json(json& made, const std::optional<T>& value) {
    made = value ? json(*value) : json(nullptr);
  }
  static void from_json(const json& read, std::optional<T>& value) {
    value = read.is_null() ? std::nullopt : std::optional(read.get<T>());
  }
};

}  // namespace nlohmann

namespace smoothfem {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MeshQuality, q_min, q_star_min, q_mean, n_invalid)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CellsBelow, threshold, n, n_star)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MeshWarpage, max, mean, n_faces)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SolveEffort, n_solves, seconds)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(IterationRecord, record, stage, iteration, smoothing_seconds,
                                   preparation_seconds, wall_seconds, quality, n_made_invalid,
                                   n_reset, solves)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Trajectory, records, snapshots, result_record, iterations_text,
                                   smoothing_seconds, preparation_seconds, wall_seconds, quality,
                                   cells_below, warpage, warpage_of_records, peak_memory_gib,
                                   failure, session, content)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SolverNumber, name, value)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SolutionRecord, degree, n_dofs, n_free, assembly_seconds,
                                   condition_number, lambda_min, lambda_max, condition_method,
                                   condition_residual, jacobi_condition_number, cg_iterations,
                                   jacobi_cg_iterations, amg_cg_iterations, cg_seconds,
                                   jacobi_cg_seconds, amg_setup_seconds, amg_cg_seconds,
                                   cg_converged, e_max, e_mean, e_l2, e_h1, l2_error, h1_error,
                                   l2_best, h1_best, most_points, status, numbers)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SolvedRecords, records, seconds, eigenvectors, session)

namespace {

namespace fs = std::filesystem;

/// Saves as CBOR, which is short and keeps every bit of a double.
template <class T>
void save_as_cbor(const fs::path& folder, const std::string& name, const T& value) {
  const auto bytes = nlohmann::json::to_cbor(nlohmann::json(value));
  write_sealed(folder, name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

template <class T>
std::optional<T> load_cbor(const fs::path& folder, const std::string& name) {
  const auto content = read_sealed(folder, name);
  if (!content) return std::nullopt;
  try {
    return nlohmann::json::from_cbor(*content).get<T>();
  } catch (const nlohmann::json::exception&) {  // of another version of the program
    refuse_damaged(folder / name);
  }
}

/// Extensions of initial meshes.
constexpr std::array<const char*, 2> mesh_extensions{".mesh", ".vtk"};

/// True if the trajectory's indices are valid for its records.
bool is_consistent(const Trajectory& t) {
  const std::size_t n_records = t.records.size();
  return t.result_record < n_records && std::is_sorted(t.snapshots.begin(), t.snapshots.end()) &&
         (t.snapshots.empty() || t.snapshots.back() < n_records) &&
         (t.warpage_of_records.empty() || t.warpage_of_records.size() == n_records);
}

}  // namespace

std::string KeptResults::numbers_name(const std::string& name, std::size_t record) {
  return name + "/" + std::to_string(record) + ".numbers";
}

void KeptResults::save_numbers(const std::string& name, std::size_t record,
                               const std::vector<double>& numbers) const {
  write_sealed(folder_, numbers_name(name, record),
               {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)});
}

std::vector<double> KeptResults::load_numbers(const std::string& name, std::size_t record,
                                              std::size_t size) const {
  const auto content = read_sealed(folder_, numbers_name(name, record));
  if (!content || content->size() != size * sizeof(double))
    refuse_damaged(folder_ / numbers_name(name, record));
  std::vector<double> numbers(size);
  std::memcpy(numbers.data(), content->data(), content->size());
  return numbers;
}

void KeptResults::save(const std::string& name, const Trajectory& trajectory) const {
  if (!is_writer_) return;
  if (std::filesystem::exists(folder_)) flush_file_system(folder_);  // the saved numbers
  save_as_cbor(folder_, name + ".trajectory", trajectory);
}

std::optional<Trajectory> KeptResults::load_trajectory(const std::string& name) const {
  auto trajectory = load_cbor<Trajectory>(folder_, name + ".trajectory");
  if (trajectory && !is_consistent(*trajectory)) refuse_damaged(folder_ / (name + ".trajectory"));
  return trajectory;
}

void KeptResults::save(const std::string& name, const SolvedRecords& solved) const {
  if (!is_writer_) return;
  save_as_cbor(folder_, name + ".solved", solved);
}

std::optional<SolvedRecords> KeptResults::load_solved(const std::string& name) const {
  return load_cbor<SolvedRecords>(folder_, name + ".solved");
}

void KeptResults::save_mesh(const std::string& name, const fs::path& file) const {
  const std::string content = file_content(file);
  write_atomically(folder_ / (name + file.extension().string()), content);
  write_sealed(folder_, name + ".sum", sha256(content));
}

std::optional<fs::path> KeptResults::find_mesh(const std::string& name) const {
  const auto sum = read_sealed(folder_, name + ".sum");
  for (const std::string extension : mesh_extensions) {
    const fs::path file = folder_ / (name + extension);
    if (sum && fs::exists(file) && sha256_of_file(file) == *sum) return file;
  }
  return std::nullopt;
}

void KeptResults::save_notes(const std::string& name, const std::vector<std::string>& notes) const {
  if (is_writer_) save_as_cbor(folder_, name + ".notes", notes);
}

std::optional<std::vector<std::string>> KeptResults::load_notes(const std::string& name) const {
  return load_cbor<std::vector<std::string>>(folder_, name + ".notes");
}

bool KeptResults::has_solved(const std::string& name) const {
  return fs::exists(folder_ / (name + ".solved"));
}

std::string KeptResults::keep_only(const std::set<std::string>& names) const {
  constexpr double large = 1e9;  // bytes
  if (!fs::exists(folder_)) return {};
  std::vector<fs::path> unused;
  for (const auto& entry : fs::directory_iterator(folder_))
    if (!names.contains(entry.path().stem().string())) unused.push_back(entry.path());
  std::error_code ignored;  // leftovers are harmless
  for (const auto& path : unused) fs::remove_all(path, ignored);
  double bytes = 0.0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  if (bytes < large) return {};
  char size[32];
  std::snprintf(size, sizeof(size), "%.1f GB", 1e-9 * bytes);
  return "The results kept for changes of the study take " + std::string(size) +
         ". You may remove " + folder_.string() + ": you lose only time.";
}

template <int dim>
std::vector<double> numbers_of(std::span<const Point<dim>> points) {
  std::vector<double> numbers;
  numbers.reserve(dim * points.size());
  for (const auto& p : points) numbers.insert(numbers.end(), p.begin(), p.end());
  return numbers;
}
template std::vector<double> numbers_of(std::span<const Point<2>>);
template std::vector<double> numbers_of(std::span<const Point<3>>);

template <int dim>
std::vector<Point<dim>> points_of(const std::vector<double>& numbers) {
  std::vector<Point<dim>> points(numbers.size() / dim);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = Eigen::Map<const Point<dim>>(&numbers[dim * i]);
  return points;
}
template std::vector<Point<2>> points_of(const std::vector<double>&);
template std::vector<Point<3>> points_of(const std::vector<double>&);

}  // namespace smoothfem
