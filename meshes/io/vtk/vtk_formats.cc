// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/vtk_files.h"

namespace smoothfem {
namespace {

MeshFormat vtk_format(const std::string& name, const std::string& description,
                      decltype(MeshFormat::read) read, decltype(MeshFormat::write) write) {
  return {.name = name,
          .extension = "." + name,
          .description = description,
          .holds_planar_meshes = true,
          .holds_volume_meshes = true,
          .holds_surface_meshes = true,
          .holds_polygons = true,
          .holds_fixed_nodes = true,
          .holds_facets = true,
          .holds_physical_names = true,
          .holds_numbers = true,
          .min_element_dimension = 0,
          .holds_field = [](const MeshField&, bool) { return true; },
          .read = read,
          .write = write};
}

const RegisteredFormat legacy(vtk_format("vtk", "legacy VTK, text or binary", read_legacy_vtk,
                                         write_legacy_vtk));
const RegisteredFormat xml(vtk_format("vtu", "VTK XML unstructured grid", read_vtu, write_vtu));

}  // namespace
}  // namespace smoothfem
