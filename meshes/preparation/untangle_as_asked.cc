// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iomanip>
#include <sstream>

#include "meshes/preparation/prepare_mesh.h"
#include "smoothing/base/option_text.h"
#include "smoothing/optimization/untangle.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/second_order/raise_order.h"

namespace smoothfem {

namespace {

/// "cells 3, 17, ..., the first at (0.5, 1, 2)"
template <int dim>
std::string cells_text(const Mesh<dim>& mesh, const std::vector<CellIndex>& cells) {
  constexpr std::size_t n_named = 5;
  std::ostringstream text;
  text << (cells.size() == 1 ? "cell " : "cells ");
  for (std::size_t i = 0; i < std::min(n_named, cells.size()); ++i)
    text << (i > 0 ? ", " : "") << mesh.topology().labels().cell_number(cells[i]);
  if (cells.size() > n_named) text << ", ...";
  text << (cells.size() == 1 ? " at (" : ", the first at (");
  const Point<dim>& at = mesh.coordinates()[mesh.topology().cell_nodes(cells.front())[0]];
  for (int d = 0; d < dim; ++d) text << (d > 0 ? ", " : "") << at[d];
  return text.str() + ")";
}

/// Throws InputError that untangling did not succeed, with the cells and advice.
template <int dim>
[[noreturn]] void refuse(const MeshOptions& options, const std::string& name, const Mesh<dim>& mesh,
                         const UntangleResult& result) {
  const bool hopeless = !result.fully_fixed_cells.empty(), slides = options.boundary == "slide";
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
      slides ? "give the boundary more freedom by a larger " + option_text("slide-distance") +
                   " or " + option_text("feature-angle")
             : std::string("free ") + (hopeless ? "some of their" : "more") + " nodes with " +
                   option_text("fix") +
                   (would_slide ? ", or let boundary nodes move along the boundary with " +
                                      option_text("boundary", "slide")
                                : "");
  throw InputError((name.empty() ? "" : name + ": ") + what +
                   (hopeless ? " have only fixed nodes, so that untangling cannot repair them"
                             : " are left after untangling") +
                   where + "; " + advice + ", or repair them in the mesh generator");
}

}  // namespace

template <int dim, int spacedim>
void untangle_as_asked(const MeshOptions& options, const Method<dim, spacedim>& method,
                       const std::string& name, const NoteTaker& notes, Mesh<dim, spacedim>& mesh) {
  if (!options.untangle) return;
  if constexpr (spacedim > dim) {
    throw InputError((name.empty() ? "" : name + ": ") +
                     "surface meshes cannot be untangled; smooth it without " +
                     option_text("untangle"));
  } else {
    if (mesh.topology().midside() && mesh_quality(with_linear_cells(mesh)).n_invalid == 0)
      return;  // smoothing repairs curved cells of valid corners
    const UntangleResult result = untangle(mesh);
    if (!result.valid) refuse(options, name, mesh, result);
    if (result.n_invalid_before > 0) {
      std::ostringstream text;
      text << std::setprecision(4) << "untangled " << result.n_invalid_before
           << " invalid cells in " << result.seconds << " s";
      notes.tell(text.str());
    }
    if (mesh.constraints() && !keeps_constraints(method)) {
      mesh = with_fixed_surfaces(mesh);
      notes.tell(method.info.name +
                 " keeps no nodes on surfaces: from here on the nodes that slide stay");
    }
  }
}

template void untangle_as_asked(const MeshOptions&, const Method<2>&, const std::string&,
                                const NoteTaker&, Mesh<2>&);
template void untangle_as_asked(const MeshOptions&, const Method<3>&, const std::string&,
                                const NoteTaker&, Mesh<3>&);
template void untangle_as_asked(const MeshOptions&, const Method<2, 3>&, const std::string&,
                                const NoteTaker&, Mesh<2, 3>&);

}  // namespace smoothfem
