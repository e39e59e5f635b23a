// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/vtk_files.h"

namespace smoothfem {
namespace {

MeshFormat vtk_format(const std::string& name, const std::string& description,
                      decltype(MeshFormat::recognizes) recognizes, decltype(MeshFormat::read) read,
                      decltype(MeshFormat::write) write) {
  return {.name = name,
          .extension = "." + name,
          .description = description,
          .holds_planar_meshes = true,
          .holds_volume_meshes = true,
          .holds_surface_meshes = true,
          .holds_polygons = true,
          .holds_second_order = true,
          .holds_fixed_nodes = true,
          .holds_facets = true,
          .holds_physical_names = true,
          .holds_numbers = true,
          .has_two_encodings = true,
          .takes_tag_field = true,
          .min_element_dimension = 0,
          .holds_field = [](const MeshField&, bool) { return true; },
          .recognizes = recognizes,
          .read = read,
          .write = write};
}

bool is_legacy(std::string_view beginning) {
  return beginning.starts_with("# vtk DataFile");
}

/// True for an XML file of VTK of this type.
bool is_xml(std::string_view beginning, const std::string& type) {
  const std::size_t tag = beginning.find("<VTKFile");
  if (tag == beginning.npos) return false;
  const std::string_view attributes = beginning.substr(tag, beginning.find('>', tag) - tag);
  return attributes.find('"' + type + '"') != attributes.npos ||
         attributes.find('\'' + type + '\'') != attributes.npos;
}
bool is_vtu(std::string_view beginning) {
  return is_xml(beginning, "UnstructuredGrid");
}
bool is_pvtu(std::string_view beginning) {
  return is_xml(beginning, "PUnstructuredGrid");
}

const RegisteredFormat legacy(vtk_format("vtk", "legacy VTK, text or binary", is_legacy,
                                         read_legacy_vtk, write_legacy_vtk));
const RegisteredFormat xml(vtk_format("vtu", "VTK XML unstructured grid, text or binary", is_vtu,
                                      read_vtu, write_vtu));
const RegisteredFormat parallel({.name = "pvtu",
                                 .extension = ".pvtu",
                                 .description = "list of .vtu files that make one mesh; only read",
                                 .takes_tag_field = true,
                                 .recognizes = is_pvtu,
                                 .read = read_pvtu});

}  // namespace
}  // namespace smoothfem
