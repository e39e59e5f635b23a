// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <sstream>

#include "meshes/doctor/examine_boundary.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/optimization/untangle.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/surface/boundary_lines.h"
#include "studies/cli/smooth_arguments.h"

namespace smoothfem {

namespace {

/// "cells 3, 17, ..., the first at (0.5, 1, 2)"
template <int dim>
std::string cells_text(const Mesh<dim>& mesh, const std::vector<CellIndex>& cells) {
  constexpr std::size_t n_named = 5;
  const auto& ids = mesh.topology().labels().cell_ids;
  std::ostringstream text;
  text << (cells.size() == 1 ? "cell " : "cells ");
  for (std::size_t i = 0; i < std::min(n_named, cells.size()); ++i)
    text << (i > 0 ? ", " : "") << (ids.empty() ? cells[i] : ids[cells[i]]);
  if (cells.size() > n_named) text << ", ...";
  text << (cells.size() == 1 ? " at (" : ", the first at (");
  const Point<dim>& at = mesh.coordinates()[mesh.topology().cell_nodes(cells.front())[0]];
  for (int d = 0; d < dim; ++d) text << (d > 0 ? ", " : "") << at[d];
  return text.str() + ")";
}

/// Throws InputError that untangling did not succeed, with the cells and advice.
template <int dim>
[[noreturn]] void refuse(const SmoothArguments& arguments, const Mesh<dim>& mesh,
                         const UntangleResult& result) {
  const bool hopeless = !result.fully_fixed_cells.empty(), slides = arguments.boundary == "slide";
  const auto& cells = hopeless ? result.fully_fixed_cells : result.invalid_cells;
  const auto stays_on_boundary = [&](CellIndex c) {
    const auto nodes = mesh.topology().cell_nodes(c);
    return std::any_of(nodes.begin(), nodes.end(), [&](NodeIndex i) {
      return mesh.topology().on_boundary()[i] && mesh.topology().is_fixed(i);
    });
  };
  const bool would_slide = !slides && std::any_of(cells.begin(), cells.end(), stays_on_boundary);
  const std::string what = std::to_string(cells.size()) + " of " +
                           std::to_string(result.n_invalid_before) + " invalid cells",
                    where = " (" + cells_text(mesh, cells) + ")";
  const std::string advice =
      slides ? "give the boundary more freedom by a larger --slide-distance or --feature-angle"
             : std::string("free ") + (hopeless ? "some of their" : "more") + " nodes with --fix" +
                   (would_slide
                        ? ", or let boundary nodes move along the boundary with --boundary slide"
                        : "");
  throw InputError(arguments.in + ": " + what +
                   (hopeless ? " have only fixed nodes, so that untangling cannot repair them"
                             : " are left after untangling") +
                   where + "; " + advice + ", or repair them in the mesh generator");
}

/// Untangles a planar mesh whose nodes slide along the initial boundary. Corners and the nodes of
/// --fix stay.
UntangleResult untangle_with_sliding_boundary(const SmoothArguments& arguments, PlanarMesh& mesh) {
  const BoundaryLines lines(mesh, features_of(arguments), slide_distance_of(arguments));
  const auto on_seam = examine_boundary(mesh).seam_nodes;  // its sides would come apart
  std::vector<bool> fixed(mesh.n_nodes());
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    fixed[i] = lines.is_corner(i) || (!on_seam.empty() && on_seam[i]) ||
               (mesh.topology().is_fixed(i) &&
                (!arguments.fix.empty() || !mesh.topology().on_boundary()[i]));
  PlanarMesh sliding = with_fixed_nodes(mesh, std::move(fixed));
  const UntangleResult result = untangle(sliding, {}, &lines);
  mesh.set_coordinates(sliding.coordinates());
  if (!arguments.quiet && result.valid && result.n_invalid_before > 0)
    std::printf("distance from the initial boundary: %.3g (limit: %.3g)\n",
                lines.edge_distance(mesh.coordinates()), lines.edge_bound());
  return result;
}

}  // namespace

template <int dim, int spacedim>
void make_valid(const SmoothArguments& arguments, const Method<dim, spacedim>& method,
                Mesh<dim, spacedim>& mesh, const std::vector<std::size_t>& cell_lines) {
  const bool needs_valid =
      std::any_of(method.stages.begin(), method.stages.end(),
                  [](const auto& stage) { return stage->traits().needs_valid_mesh; });
  if (!arguments.untangle) {
    if (needs_valid) require_valid(mesh, arguments.in, cell_lines);
    return;
  }
  if constexpr (spacedim > dim) {
    throw InputError(arguments.in +
                     ": surface meshes cannot be untangled; smooth it without --untangle");
  } else {
    const UntangleResult result = [&] {
      if constexpr (dim == 2)
        if (slides_while_untangling<dim, spacedim>(arguments))
          return untangle_with_sliding_boundary(arguments, mesh);
      return untangle(mesh);
    }();
    if (!result.valid) refuse(arguments, mesh, result);
    if (!arguments.quiet && result.n_invalid_before > 0)
      std::printf("untangled %zu invalid cells in %.4g s\n", result.n_invalid_before,
                  result.seconds);
  }
}

template void make_valid(const SmoothArguments&, const Method<2>&, Mesh<2>&,
                         const std::vector<std::size_t>&);
template void make_valid(const SmoothArguments&, const Method<3>&, Mesh<3>&,
                         const std::vector<std::size_t>&);
template void make_valid(const SmoothArguments&, const Method<2, 3>&, Mesh<2, 3>&,
                         const std::vector<std::size_t>&);

}  // namespace smoothfem
