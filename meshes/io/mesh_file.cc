// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <exception>

#include "meshes/io/abaqus_file.h"
#include "meshes/io/line_reader.h"
#include "meshes/io/medit_text.h"
#include "meshes/io/msh_file.h"
#include "meshes/io/polygonal_text.h"
#include "meshes/io/vtk_files.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

/// Two formats share this extension.
MeshFile read_dot_mesh(const std::filesystem::path& path) {
  const bool medit = is_medit_text(read_whole_file(path));
  return medit ? read_medit_text(path) : read_polygonal_text(path);
}

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
          .holds_physical_names = true,
          .holds_numbers = true,
          .read = read,
          .write = write};
}

}  // namespace

const std::vector<MeshFormat>& mesh_formats() {
  static const std::vector<MeshFormat> formats = {
      {.name = "polygonal",
       .extension = ".mesh",
       .description = "planar polygonal mesh, text",
       .holds_planar_meshes = true,
       .holds_polygons = true,
       .holds_fixed_nodes = true,
       .read = read_dot_mesh,
       .write = write_polygonal_text},
      {.name = "medit",
       .extension = ".mesh",
       .description = "Medit, text; written for volume meshes",
       .holds_volume_meshes = true,
       .read = read_dot_mesh,
       .write = write_medit_text},
      {.name = "gmsh",
       .extension = ".msh",
       .description = "Gmsh 4.1 and 2.2, text or binary",
       .holds_planar_meshes = true,
       .holds_volume_meshes = true,
       .holds_surface_meshes = true,
       .holds_physical_names = true,
       .holds_numbers = true,
       .read = read_msh,
       .write = write_msh},
      vtk_format("vtk", "legacy VTK, text or binary", read_legacy_vtk, write_legacy_vtk),
      vtk_format("vtu", "VTK XML unstructured grid", read_vtu, write_vtu),
      {.name = "abaqus",
       .extension = ".inp",
       .description = "Abaqus and CalculiX input",
       .holds_planar_meshes = true,
       .holds_volume_meshes = true,
       .holds_fixed_nodes = true,
       .holds_physical_names = true,
       .holds_numbers = true,
       .read = read_abaqus,
       .write = write_abaqus},
  };
  return formats;
}

namespace {

/// Formats of the path's extension: one or more.
std::vector<const MeshFormat*> formats_of(const std::filesystem::path& path,
                                          const std::string& prefix) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::vector<std::string> known;
  std::vector<const MeshFormat*> found;
  for (const auto& format : mesh_formats()) {
    if (format.extension == extension) found.push_back(&format);
    if (std::find(known.begin(), known.end(), format.extension) == known.end())
      known.push_back(format.extension);
  }
  if (found.empty())
    throw InputError(prefix + ": " +
                     (extension.empty() ? "the file name has no extension"
                                        : "the extension " + extension + " is not known") +
                     "; use one of " + joined(known));
  return found;
}

void require_sizes(const std::string& path, const std::string& kind,
                   const std::map<std::string, std::vector<double>>& fields, std::size_t n) {
  for (const auto& [name, values] : fields)
    if (values.size() != n)
      throw InputError("cannot write " + path + ": the " + kind + " field '" + name + "' has " +
                       std::to_string(values.size()) + " values, but the mesh needs " +
                       std::to_string(n));
}

}  // namespace

MeshFile read_mesh(const std::filesystem::path& path) {
  try {
    return formats_of(path, path.string()).front()->read(path);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {  // a damaged count can ask for more memory than there is
    throw InputError(path.string() + ": the file is damaged or too large (" + error.what() + ")");
  }
}

const PlanarMesh& planar_mesh(const MeshFile& file, const std::filesystem::path& path) {
  if (const auto* mesh = std::get_if<PlanarMesh>(&file.mesh)) return *mesh;
  throw InputError(path.string() + ": the file holds a " + kind_name(file.mesh) +
                   " mesh, but a planar one is needed here; give another file");
}

void write_mesh(const std::filesystem::path& path, const MeshView& mesh, const MeshFields& fields,
                const MeshWriteOptions& options) {
  const std::string prefix = "cannot write " + path.string();
  require_sizes(path.string(), "cell", fields.cell, mesh.n_cells());
  require_sizes(path.string(), "point", fields.point, mesh.n_nodes());
  const auto holds = mesh.planar()       ? &MeshFormat::holds_planar_meshes
                     : mesh.is_surface() ? &MeshFormat::holds_surface_meshes
                                         : &MeshFormat::holds_volume_meshes;
  for (const MeshFormat* format : formats_of(path, prefix))
    if (format->*holds) return format->write(path, mesh, fields, options);
  throw InputError(prefix + ": the format holds no " +
                   mesh_kind_name(mesh.dimension(), mesh.planar() ? 2 : 3) +
                   " meshes; use .vtu or another extension");
}

}  // namespace smoothfem
