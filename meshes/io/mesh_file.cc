// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/mesh_file.h"

#include <algorithm>
#include <exception>
#include <fstream>
#include <iterator>
#include <new>
#include <tuple>

#include "meshes/io/atomic_file.h"
#include "meshes/io/foreign/foreign_formats.h"
#include "meshes/io/line_reader.h"
#include "meshes/io/losses.h"
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

bool has_extension(const MeshFormat& format, const std::string& extension) {
  const auto& others = format.other_extensions;
  return format.extension == extension ||
         std::find(others.begin(), others.end(), extension) != others.end();
}

std::vector<const MeshFormat*> formats_of(const std::string& extension) {
  std::vector<const MeshFormat*> found;
  for (const auto* formats : {&mesh_formats(), &foreign_formats()})
    for (const auto& format : *formats)
      if (has_extension(format, extension)) found.push_back(&format);
  return found;
}

std::string extension_of(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

[[noreturn]] void refuse_extension(const std::string& prefix, const std::string& extension,
                                   bool is_to_write) {
  std::vector<std::string> known;
  for (const auto* formats : {&mesh_formats(), &foreign_formats()})
    for (const auto& format : *formats)
      if ((format.write || !is_to_write) &&
          std::find(known.begin(), known.end(), format.extension) == known.end())
        known.push_back(format.extension);
  throw InputError(prefix + ": " +
                   (extension.empty() ? "the file name has no extension"
                                      : "the extension " + extension + " is not known") +
                   "; " + choose_one_of(known, extension));
}

/// Returns the formats in which a file of this extension can be written: one or more.
std::vector<const MeshFormat*> formats_to_write(const std::string& extension,
                                                const std::string& prefix) {
  auto formats = formats_of(extension);
  if (formats.empty()) refuse_extension(prefix, extension, true);
  std::erase_if(formats, [](const MeshFormat* format) { return !format->write; });
  if (formats.empty())
    throw InputError(prefix + ": files " + extension + " are only read; use .vtu or another one");
  return formats;
}

void require_sizes(const std::string& path, const std::string& kind,
                   const std::map<std::string, std::vector<double>>& fields, std::size_t n) {
  for (const auto& [name, values] : fields)
    if (values.size() != n)
      throw InputError("cannot write " + path + ": the " + kind + " field '" + name + "' has " +
                       std::to_string(values.size()) + " values, but the mesh needs " +
                       std::to_string(n));
}

/// Returns the first bytes of a file. Pipes give none: they can be read only once.
std::string beginning_of(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};
  std::string text(n_recognized, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

struct FoundFormat {
  const MeshFormat* format;
  std::string note;  ///< empty if the extension is one of the format
};

/// Returns the format that recognizes the content; one of the extension comes first, and is the
/// fallback.
FoundFormat format_to_read(const std::filesystem::path& path) {
  const std::string beginning = beginning_of(path), extension = extension_of(path);
  const auto formats = formats_of(extension);
  const auto recognizes = [&](const MeshFormat& format) {
    return format.recognizes && format.recognizes(beginning);
  };
  for (const MeshFormat* format : formats)
    if (recognizes(*format)) return {format, {}};
  for (const MeshFormat& format : mesh_formats())
    if (recognizes(format))
      return {&format, "the file does not have the format that its name says; it is read as " +
                           format.name + " (" + format.description +
                           "); written files have the formats that their names say"};
  if (formats.empty()) refuse_extension(path.string(), extension, false);
  for (const MeshFormat* format : formats)
    if (!format->recognizes) return {format, {}};
  return {formats.front(), {}};
}

MeshParts read_parts(const std::filesystem::path& path, const MeshReadOptions& options) {
  const FoundFormat found = format_to_read(path);
  MeshParts parts = found.format->read(path, options);
  if (!options.tag_field.empty() && !found.format->takes_tag_field)
    throw InputError(path.string() + ": files of the format " + found.format->name +
                     " have no cell arrays for --tag-field; leave it out");
  if (!found.note.empty()) parts.notes.insert(parts.notes.begin(), found.note);
  return parts;
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
  return read_safely(path, [&] { return read_parts(path, {}); });
}

MeshFile read_mesh(const std::filesystem::path& path, const MeshReadOptions& options) {
  return read_safely(path, [&] { return assemble_mesh(path, read_parts(path, options), options); });
}

const PlanarMesh& planar_mesh(const MeshFile& file, const std::filesystem::path& path) {
  if (const auto* mesh = std::get_if<PlanarMesh>(&file.mesh)) return *mesh;
  throw InputError(path.string() + ": the file holds a " + kind_name(file.mesh) +
                   " mesh, but a planar one is needed here; give another file");
}

namespace {

bool has_polygons(const Topology& topology) {
  for (CellIndex c = 0; topology.dimension() == 2 && c < topology.n_cells(); ++c)
    if (topology.cell_nodes(c).size() > 4) return true;
  return false;
}

}  // namespace

const MeshFormat& format_for(const std::filesystem::path& path, const MeshView& mesh) {
  const std::string prefix = "cannot write " + path.string();
  const auto holds = mesh.planar()       ? &MeshFormat::holds_planar_meshes
                     : mesh.is_surface() ? &MeshFormat::holds_surface_meshes
                                         : &MeshFormat::holds_volume_meshes;
  const auto formats = formats_to_write(extension_of(path), prefix);
  for (const MeshFormat* format : formats)
    if (mesh.content() && mesh.content()->format == format->name) return *format;
  std::vector<const MeshFormat*> able;
  std::copy_if(formats.begin(), formats.end(), std::back_inserter(able),
               [&](const MeshFormat* format) { return format->*holds; });
  if (able.size() == 1) return *able.front();
  const bool is_polygonal = has_polygons(mesh.topology());
  const auto n_lost = [&](const MeshFormat* format) {
    return std::tuple((is_polygonal && !format->holds_polygons) ||
                          (mesh.topology().midside() && !format->holds_second_order),
                      losses(*format, mesh).size(), !format->holds_fixed_nodes);
  };
  if (!able.empty())
    return **std::min_element(able.begin(), able.end(),
                              [&](const auto* a, const auto* b) { return n_lost(a) < n_lost(b); });
  throw InputError(prefix + ": the format cannot hold " +
                   mesh_kind_name(mesh.dimension(), mesh.planar() ? 2 : 3) +
                   " meshes; use .vtu or another extension");
}

void write_mesh(const std::filesystem::path& path, const MeshView& mesh, const MeshFields& fields,
                const MeshWriteOptions& options) {
  require_sizes(path.string(), "cell", fields.cell, mesh.n_cells());
  require_sizes(path.string(), "point", fields.point, mesh.n_nodes());
  const MeshFormat& format = format_for(path, mesh);
  if (mesh.topology().midside() && !format.holds_second_order) {
    std::vector<std::string> others;
    for (const MeshFormat& other : mesh_formats())
      if (other.holds_second_order && other.write) others.push_back(other.extension);
    throw InputError("cannot write " + path.string() +
                     ": the mesh has elements of second order, and the format " + format.name +
                     " holds linear ones only; use one of " + joined(others));
  }
  format.write(path, mesh, fields, options);
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
  const auto formats = formats_to_write(target.extension, "--to " + text);
  if (target.options.binary && !formats.front()->has_two_encodings)
    throw InputError("--to " + text + ": files ." + name + " have one encoding only; use --to " +
                     name);
  return target;
}

void require_mesh_path(const std::filesystem::path& path) {
  (void)formats_to_write(extension_of(path), "cannot write " + path.string());
  require_writable_file(path);
}

std::string extension_to_write(const std::filesystem::path& path) {
  const auto formats = formats_of(extension_of(path));
  const bool is_written = std::any_of(formats.begin(), formats.end(),
                                      [](const MeshFormat* format) { return format->write; });
  return is_written || formats.empty() ? path.extension().string() : ".vtu";
}

}  // namespace smoothfem
