#include "meshes/io/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <exception>

#include "meshes/io/msh_file.h"
#include "meshes/io/polygonal_text.h"
#include "meshes/io/vtk_files.h"
#include "smoothing/mesh/input_error.h"

namespace smoothfem {

const std::vector<MeshFormat>& mesh_formats() {
  static const std::vector<MeshFormat> formats = {
      {"polygonal", ".mesh", "planar polygonal mesh, text", true, true, false, false,
       read_polygonal_text, write_polygonal_text},
      {"gmsh", ".msh", "Gmsh 4.1 and 2.2, text or binary", false, false, false, true, read_msh,
       write_msh},
      {"vtk", ".vtk", "legacy VTK, text or binary", true, true, true, false, read_legacy_vtk,
       write_legacy_vtk},
      {"vtu", ".vtu", "VTK XML unstructured grid", true, true, true, false, read_vtu, write_vtu},
  };
  return formats;
}

namespace {

const MeshFormat& format_of(const std::filesystem::path& path, const std::string& prefix) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::string known;
  for (const auto& format : mesh_formats()) {
    if (format.extension == extension) return format;
    known += (known.empty() ? "" : ", ") + format.extension;
  }
  throw InputError(prefix + ": " +
                   (extension.empty() ? "the file name has no extension"
                                      : "the extension " + extension + " is not known") +
                   "; use one of " + known);
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
    return format_of(path, path.string()).read(path);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {  // a damaged count can ask for more memory than there is
    throw InputError(path.string() + ": the file is damaged or too large (" + error.what() + ")");
  }
}

void write_mesh(const std::filesystem::path& path, const PlanarMesh& mesh, const MeshFields& fields,
                const MeshWriteOptions& options) {
  const MeshFormat& format = format_of(path, "cannot write " + path.string());
  require_sizes(path.string(), "cell", fields.cell, mesh.n_cells());
  require_sizes(path.string(), "point", fields.point, mesh.n_nodes());
  format.write(path, mesh, fields, options);
}

}  // namespace smoothfem
