// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Ideal shape and size of each cell of a planar or volume mesh. Each is the image of a regular
/// element by a linear map, the target matrix. Methods and qualities see a cell's corners mapped
/// back. There the ideal is the regular element with a mean node simplex (node_simplex_size) of 1.
/// Immutable. Source: target-matrix optimization, Knupp, Engrg. with Computers 28 (2012).
template <int dim>
class CellTargets {
 public:
  using Matrix = Eigen::Matrix<double, dim, dim>;
  using Entries = std::array<double, static_cast<std::size_t>(dim* dim)>;  ///< by columns

  /// maps: of regular elements to the targets, one invertible matrix for each cell. size_bound:
  /// above 1.
  explicit CellTargets(const std::vector<Matrix>& maps,
                       double size_bound = std::numeric_limits<double>::infinity());

  /// Largest factor between a cell's size and that of its target. Methods treat cells beyond it as
  /// invalid.
  double size_bound() const { return size_bound_; }

  std::size_t n_cells() const { return to_target_.size(); }
  const Entries& to_target(CellIndex cell) const { return to_target_[cell]; }
  const Entries& to_regular(CellIndex cell) const { return to_regular_[cell]; }

 private:
  std::vector<Entries> to_target_, to_regular_;
  double size_bound_;
};

/// What a target takes from a cell of a reference mesh.
enum class TargetKind {
  shape_and_size,
  size  ///< the shape is regular
};
/// Users' names of these kinds, for references that are a method's initial mesh.
inline constexpr std::array<std::string_view, 2> initial_target_names{"initial", "initial-size"};

/// Bound of sizes for targets that are a method's initial mesh.
inline constexpr double initial_size_bound = 2.0;

/// Makes the targets from the cells of a reference mesh, which must be valid. A simplex is exactly
/// the image of a regular one. For other types the map is the closest one in the sense of least
/// squares. Throws InputError that names the first cell without a positive size.
template <int dim>
std::shared_ptr<const CellTargets<dim>> targets_of(
    const Mesh<dim>& reference, TargetKind kind,
    double size_bound = std::numeric_limits<double>::infinity());

/// Returns the kind with this user's name; none for other names.
std::optional<TargetKind> initial_target(std::string_view name);

/// Returns the mesh with other targets; null: regular elements of any size. Throws InputError if
/// their number is not that of the cells.
template <int dim>
Mesh<dim> with_targets(const Mesh<dim>& mesh, std::shared_ptr<const CellTargets<dim>> targets);

/// Returns the mesh with targets that are its present cells.
template <int dim>
Mesh<dim> with_initial_targets(const Mesh<dim>& mesh, TargetKind kind) {
  return with_targets(mesh, targets_of(mesh, kind, initial_size_bound));
}

/// Returns the mesh without targets, whose cells are measured by their own shapes.
template <int dim, int spacedim>
Mesh<dim, spacedim> without_targets(const Mesh<dim, spacedim>& mesh) {
  return {mesh.shared_topology(), mesh.copied_coordinates(), mesh.shared_constraints()};
}

}  // namespace smoothfem
