// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/mesh_file.h"

#include <algorithm>
#include <exception>
#include <new>

#include "meshes/io/atomic_file.h"
#include "meshes/io/foreign/foreign_formats.h"
#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "smoothing/base/registry.h"

namespace smoothfem {

namespace {

Registry<MeshFormat>& registry() {
  static Registry<MeshFormat> formats("mesh format");
  return formats;
}

}  // namespace

RegisteredFormat::RegisteredFormat(MeshFormat format) {
  registry().add(std::move(format));
}

const std::vector<MeshFormat>& mesh_formats() {
  return registry().all();
}

namespace {

/// Returns the formats of the path's extension: one or more.
std::vector<const MeshFormat*> formats_of(const std::filesystem::path& path,
                                          const std::string& prefix) {
  const std::string extension = lower_case(path.extension().string());
  std::vector<std::string> known;
  std::vector<const MeshFormat*> found;
  for (const auto* formats : {&mesh_formats(), &foreign_formats()})
    for (const auto& format : *formats) {
      if (format.extension == extension) found.push_back(&format);
      if (std::find(known.begin(), known.end(), format.extension) == known.end())
        known.push_back(format.extension);
    }
  if (found.empty())
    throw InputError(prefix + ": " +
                     (extension.empty() ? "the file name has no extension"
                                        : "the extension " + extension + " is not known") +
                     "; " + choose_one_of(known, extension));
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

/// Returns the format that recognizes the content, if several share an extension; otherwise the
/// fallback.
const MeshFormat& format_of_content(const std::filesystem::path& path) {
  const auto formats = formats_of(path, path.string());
  if (formats.size() == 1) return *formats.front();
  const std::string content = read_whole_file(path);
  const MeshFormat* other = formats.front();
  for (const MeshFormat* format : formats) {
    if (!format->recognizes)
      other = format;
    else if (format->recognizes(content))
      return *format;
  }
  return *other;
}

/// Returns the result of work(), whose foreign exceptions become InputErrors about the file.
template <class Work>
auto read_safely(const std::filesystem::path& path, const Work& work) {
  try {
    return work();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(path.string() + ": there is not enough memory to read the file");
  } catch (const std::exception&) {
    throw InputError(path.string() + ": the file is damaged");
  }
}

}  // namespace

MeshParts read_mesh_parts(const std::filesystem::path& path) {
  return read_safely(path, [&] { return format_of_content(path).read(path, {}); });
}

MeshFile read_mesh(const std::filesystem::path& path, const MeshReadOptions& options) {
  return read_safely(path, [&] {
    return assemble_mesh(path, format_of_content(path).read(path, options), options);
  });
}

const PlanarMesh& planar_mesh(const MeshFile& file, const std::filesystem::path& path) {
  if (const auto* mesh = std::get_if<PlanarMesh>(&file.mesh)) return *mesh;
  throw InputError(path.string() + ": the file holds a " + kind_name(file.mesh) +
                   " mesh, but a planar one is needed here; give another file");
}

const MeshFormat& format_for(const std::filesystem::path& path, const MeshView& mesh) {
  const std::string prefix = "cannot write " + path.string();
  const auto holds = mesh.planar()       ? &MeshFormat::holds_planar_meshes
                     : mesh.is_surface() ? &MeshFormat::holds_surface_meshes
                                         : &MeshFormat::holds_volume_meshes;
  const auto formats = formats_of(path, prefix);
  for (const MeshFormat* format : formats)
    if (mesh.content() && mesh.content()->format == format->name) return *format;
  for (const MeshFormat* format : formats)
    if (format->*holds) return *format;
  throw InputError(prefix + ": the format cannot hold " +
                   mesh_kind_name(mesh.dimension(), mesh.planar() ? 2 : 3) +
                   " meshes; use .vtu or another extension");
}

void write_mesh(const std::filesystem::path& path, const MeshView& mesh, const MeshFields& fields,
                const MeshWriteOptions& options) {
  require_sizes(path.string(), "cell", fields.cell, mesh.n_cells());
  require_sizes(path.string(), "point", fields.point, mesh.n_nodes());
  format_for(path, mesh).write(path, mesh, fields, options);
}

WriteTarget parse_write_target(const std::string& text) {
  WriteTarget target;
  if (text.empty()) return target;
  std::string name = lower_case(text.starts_with('.') ? text.substr(1) : text);
  for (const bool is_binary : {false, true}) {
    const std::string ending = is_binary ? "-binary" : "-text";
    if (!name.ends_with(ending)) continue;
    name.resize(name.size() - ending.size());
    target.options.binary = is_binary;
  }
  if (name == "msh22" || name == "msh41") {
    target.options.msh_version = name == "msh22" ? MshVersion::v2_2 : MshVersion::v4_1;
    name = "msh";
  }
  target.extension = "." + name;
  (void)formats_of("mesh" + target.extension, "--to " + text);
  if (target.options.binary && name != "msh")
    throw InputError("--to " + text + ": only .msh files are written as text or binary; use --to " +
                     name);
  return target;
}

void require_mesh_path(const std::filesystem::path& path) {
  (void)formats_of(path, "cannot write " + path.string());
  require_writable_file(path);
}

}  // namespace smoothfem
