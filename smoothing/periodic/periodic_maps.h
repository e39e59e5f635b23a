// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A rigid motion: x -> rotation * x + shift.
template <int dim>
struct RigidMotion {
  Eigen::Matrix<double, dim, dim> rotation = Eigen::Matrix<double, dim, dim>::Identity();
  Point<dim> shift = Point<dim>::Zero();

  Point<dim> operator()(const Point<dim>& x) const { return rotation * x + shift; }
  RigidMotion inverse() const { return {rotation.transpose(), -(rotation.transpose() * shift)}; }
  /// Returns the motion that makes `first` and then this one.
  RigidMotion after(const RigidMotion& first) const {
    return {rotation * first.rotation, rotation * first.shift + shift};
  }
};

/// A motion of a part of the boundary to its periodic partner.
template <int dim>
struct PeriodicMap {
  RigidMotion<dim> motion;
  std::vector<std::array<NodeIndex, 2>> nodes;  ///< a node, and the partner whose image it is
};

/// Returns the maps of a planar or volume mesh, one for each periodic curve (in space: surface) of
/// its file. Nodes of its corners and edges belong to the maps that move their partners to them.
/// Translations are preferred to rotations. Throws InputError if the nodes of a curve or surface
/// are not where a rigid motion brings their partners.
template <int dim>
std::vector<PeriodicMap<dim>> periodic_maps(const Mesh<dim>& mesh);

}  // namespace smoothfem
