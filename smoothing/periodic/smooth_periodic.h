// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "smoothing/loop/smooth.h"
#include "smoothing/mesh/node_constraints.h"
#include "smoothing/surface/surface_features.h"

namespace smoothfem {

template <int dim>
struct PeriodicParameters {
  int n_layers = 3;         ///< layers of copied cells at each periodic part of the boundary
  int max_rounds = 50;      ///< of each stage of the method, each with new copies
  int patience = 3;         ///< rounds without a better mesh, if the stage keeps the best one
  double tolerance = 1e-4;  ///< ends when no periodic node moves by more, relative to its edges
  /// Makes the constraints of the mesh with its copies from the coordinates of all nodes, for a
  /// boundary that slides; empty: none.
  std::function<std::shared_ptr<const NodeConstraints<dim>>(std::span<const Point<dim>>)>
      make_constraints = {};
};

/// Returns the facets without those on a periodic part of the boundary of a mesh.
template <int dim>
SurfaceFacets without_periodic_facets(const Mesh<dim>& mesh, const SurfaceFacets& facets);

/// Smooths a periodic mesh so that partners move together. Periodic nodes are surrounded by the
/// cells of both sides, as inner nodes of a torus. The method runs on the mesh with copies of cells
/// beyond its periodic boundary, whose nodes stay during a run (an overlapping Schwarz iteration).
/// After each run nodes take the images of their partners, and the copies follow. Stages follow
/// each other, each with its own rounds, and keep their best mesh as in smooth(). A periodic node
/// stays if it has another reason to stay, or if copies do not surround it. Cells stay valid if the
/// method controls validity, and Method::floor holds. The observer gets the mesh without copies.
/// Results count the iterations and times of all runs. Throws InputError as periodic_maps and
/// smooth do, and if the mesh has no periodic partners.
template <int dim>
SmoothingResult smooth_periodic(Mesh<dim>& mesh, Method<dim>& method,
                                const std::type_identity_t<Observer<dim>>& observer = {},
                                const PeriodicParameters<dim>& parameters = {});

}  // namespace smoothfem
