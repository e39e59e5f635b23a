// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <sstream>

#include "smoothing/optimization/untangle.h"
#include "smoothing/quality/mesh_quality.h"
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
    const UntangleResult result = untangle(mesh);
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
