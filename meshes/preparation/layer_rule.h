// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshes/preparation/mesh_options.h"

namespace smoothfem {

/// Returns the mesh with the nodes of its layers fixed, if the options ask for it. Otherwise warns
/// before a run that makes them isotropic.
template <int dim>
Mesh<dim> with_layer_rule(Mesh<dim> mesh, const MeshOptions& options, const NoteTaker& notes);

}  // namespace smoothfem
