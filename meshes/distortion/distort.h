// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// n_candidates that reach the mean quality of the thesis' distorted meshes of a dimension, 2 or 3.
/// Planar: at radii of about 1.2, and smart Laplace smoothing then behaves as on the published
/// meshes; fewer do not reach it, more reach it with smaller movements. Volume: 15 do not reach it
/// on coarse tetrahedra. On the flange with seed 1, whether the second stage of GETMe with the
/// thesis' patience repairs tetrahedra depends on single cells: with 40 it does with all and with a
/// tenth of them, with 20 not with all, with 30 not with a tenth.
constexpr int default_candidates(int dim) {
  return dim == 2 ? 10 : 40;
}

/// How a node finds its new place.
enum class DistortionKind {
  /// The worst of several random points around where the node is in the given mesh. Smoothers that
  /// move nodes to the mean of their neighbours undo it easily.
  worst_candidate,
  /// A random step from where it is at present, shortened until all its cells are valid; in several
  /// sweeps nodes walk away from the given mesh, and neighbours together. So the published
  /// distorted gears look: beside the same meshes smoothed and distorted anew to the same q_mean,
  /// more of their cells are all but flat than the worst candidates leave, and displacements of
  /// neighbours correlate.
  random_steps,
};

/// In the order of DistortionKind.
constexpr std::array<const char*, 2> distortion_kind_names{"worst-candidate", "random-steps"};

/// How to make a good mesh bad in a way that smoothing can undo.
struct DistortionParameters {
  double target_q_mean = 0.3699;  ///< in (0, 1); the published gear of triangles has this, that of
                                  ///< quadrilaterals 0.4180
  std::uint64_t seed = 1;
  DistortionKind kind = DistortionKind::worst_candidate;
  int n_candidates = default_candidates(2);  ///< valid random points per node, at least 1;
                                             ///< random_steps has no use for them
  int n_sweeps = 1;          ///< times all nodes are moved, at least 1; several sweeps of worst
                             ///< candidates make meshes that resist every smoother
  double min_quality = 0.0;  ///< no cell's mean ratio falls below it, or below its own if that is
                             ///< lower; in [0, 1). Many steps would make few cells much worse
                             ///< than the thesis prints
  double tolerance = 1e-4;   ///< largest distance of q_mean from the target, positive
};

struct DistortionResult {
  double radius;  ///< of the balls, in units of the mean edge length at the node
  double q_mean;
};

/// Moves the free nodes of a valid mesh at random until its mean quality is the target.
/// Node after node moves, n_sweeps times. Worst candidate: to that of n_candidates random points in
/// a ball around its original position that keep all its cells valid, which has the worst mean
/// quality of these cells; a node for which no such point turns up stays. Random steps: by a random
/// vector in a ball, times .8 until all its cells are valid, and not after 60 trials. The ball's
/// radius, relative to the mean length of the node's edges in the original mesh, is found by
/// bisection; every radius sees the same random numbers.
/// Hexahedra keep a positive Jacobian inside, too (has_positive_mapping), because finite elements
/// need it. On surface meshes the points in the ball are projected onto the surface or feature line
/// first. The result is valid and depends only on mesh and parameters, not on machine and threads.
/// Throws InputError, with the mesh unchanged, for an invalid mesh, parameters out of range (target
/// in (0, 1), n_candidates and n_sweeps >= 1, tolerance > 0) and a target that no radius reaches,
/// with the range that can be reached.
template <int dim, int spacedim>
DistortionResult distort(Mesh<dim, spacedim>& mesh, const DistortionParameters& parameters);

/// The same with balls of a given radius (relative, about 0.65 and two sweeps for tetrahedra, 0.9
/// and one for hexahedra give the mean quality of the thesis' distorted volume meshes) instead of a
/// target; returns the mean quality that this gives.
template <int dim, int spacedim>
double distort_within(Mesh<dim, spacedim>& mesh, double radius,
                      const DistortionParameters& parameters);

}  // namespace smoothfem
