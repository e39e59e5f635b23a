// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshes/preparation/mesh_options.h"
#include "smoothing/loop/catalogue.h"

namespace smoothfem {

/// Returns the mesh with the constraints and the fixed nodes that the options ask for. Seams of
/// hanging and coincident nodes stay, too, as their sides would come apart. Throws InputError for
/// options that the mesh does not support.
template <int dim, int spacedim>
Mesh<dim, spacedim> prepared_mesh(Mesh<dim, spacedim> mesh, const MeshOptions& options,
                                  const NoteTaker& notes);

/// Untangles the mesh if the options ask for it. Nodes that slide stay from then on if the method
/// keeps no constraints. Throws InputError with the cells and advice if some stay invalid. name: of
/// the mesh in messages; may be empty.
template <int dim, int spacedim>
void untangle_as_asked(const MeshOptions& options, const Method<dim, spacedim>& method,
                       const std::string& name, const NoteTaker& notes, Mesh<dim, spacedim>& mesh);

/// Returns the mesh with the cells of another mesh as targets. Throws InputError if that has other
/// cells; names: of both meshes in messages.
template <int dim>
Mesh<dim> with_cells_as_targets(const Mesh<dim>& mesh, const AnyMesh& reference,
                                const std::string& name, const std::string& reference_name);

/// Smooths a prepared mesh. Periodic partners move together if the boundary slides, or as inner
/// nodes if the options ask for it.
template <int dim, int spacedim>
SmoothingResult smooth_prepared(Mesh<dim, spacedim>& mesh, Method<dim, spacedim>& method,
                                const MeshOptions& options,
                                const std::type_identity_t<Observer<dim, spacedim>>& observer);

/// Returns a sentence on invalid cells of a smoothed mesh, with advice; empty if there are none.
std::string invalid_cells_text(std::size_t n_invalid, std::size_t n_cells);

/// Returns sentences on midside nodes; none for linear meshes. is_warning: the domain has changed.
struct MidsideNote {
  std::string sentence;
  bool is_warning = false;
};
std::vector<MidsideNote> midside_notes(const MidsideReport& report);

/// Returns a sentence on the nodes that Method::floor has reset; empty if there are none.
std::string floor_text(const SmoothingResult& result);

}  // namespace smoothfem
