// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/foreign/foreign_formats.h"

#include <cstdlib>
#include <sstream>

#include "meshes/external/child_process.h"
#include "meshes/io/atomic_file.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/vtk/vtk_files.h"
#include "smoothing/base/data_folder.h"

namespace smoothfem {

namespace fs = std::filesystem;

namespace {

constexpr double time_limit_seconds = 3600.0;

/// Runs the translator. Returns the lines of its output that begin with "note: ", without these
/// words. Throws InputError with its last line if it fails.
std::vector<std::string> translate(const std::string& direction, const fs::path& from,
                                   const fs::path& to, const std::string& named) {
  const char* const chosen = std::getenv("SMOOTHFEM_PYTHON");
  const std::string python = chosen && *chosen ? chosen : SMOOTHFEM_PYTHON_EXECUTABLE;
  const fs::path script = data_folder() / "meshes/io/foreign/translate.py";
  std::string command = "PYTHONSAFEPATH=1 exec " + shell_quoted(python) + " -B";
  for (const std::string& word :
       {script.string(), direction, fs::absolute(from).string(), fs::absolute(to).string()})
    command += " " + shell_quoted(word);
  // In the folder of the intermediate file, which is this process' own.
  const fs::path folder = (direction == "read" ? to : from).parent_path();
  const CommandEnd end = run_command(command, folder, time_limit_seconds);
  std::vector<std::string> notes;
  std::string last;
  std::istringstream lines(end.output);
  for (std::string line; std::getline(lines, line);) {
    const std::string mark = "note: ";
    if (line.starts_with(mark)) notes.push_back(line.substr(mark.size()));
    if (!line.empty()) last = line;
  }
  if (end.timed_out) throw InputError(named + ": the translation took more than an hour");
  if (end.signal != 0)
    throw InputError(
        named + ": the library for this format crashed (signal " + std::to_string(end.signal) +
        "); " +
        (direction == "read" ? "the file is damaged" : "use another format, for example .vtu"));
  if (end.exit_code != 0)
    throw InputError(
        named + ": " +
        (last.empty() ? "the translator says nothing; it was stopped from outside" : last));
  return notes;
}

MeshParts read_foreign(const fs::path& path, const MeshReadOptions& options) {
  if (!fs::exists(path)) throw InputError(path.string() + ": there is no such file");
  const ScratchFolder folder;
  const fs::path translated = folder.path() / "mesh.vtu";
  auto notes = translate("read", path, translated, path.string());
  MeshParts parts = [&] {
    try {
      return read_vtu(translated, options);
    } catch (const InputError& error) {
      std::string text = error.what();
      const std::string name = translated.string();
      if (text.starts_with(name)) text = path.string() + text.substr(name.size());
      throw InputError(text);
    }
  }();
  parts.content.format = "";
  parts.notes.insert(parts.notes.end(), notes.begin(), notes.end());
  return parts;
}

void write_foreign(const fs::path& path, const MeshView& mesh, const MeshFields& fields,
                   const MeshWriteOptions&) {
  const ScratchFolder folder;
  const fs::path translated = folder.path() / "mesh.vtu";
  write_vtu(translated, mesh, fields, {});
  write_atomically(path, [&](const fs::path& temporary) {
    (void)translate("write", translated, temporary, "cannot write " + path.string());
  });
}

bool any_field(const MeshField&, bool) {
  return true;
}

MeshFormat volume_format(const std::string& name, const std::string& extension,
                         const std::string& description) {
  return {.name = name,
          .extension = extension,
          .description = description,
          .holds_planar_meshes = true,
          .holds_volume_meshes = true,
          .holds_surface_meshes = true,
          .holds_points_in_space = true,
          .takes_tag_field = true,
          .holds_field = any_field,
          .read = read_foreign,
          .write = write_foreign};
}

MeshFormat surface_format(const std::string& name, const std::string& extension,
                          const std::string& description) {
  MeshFormat format = volume_format(name, extension, description);
  format.holds_volume_meshes = format.holds_polygons = format.holds_tags = false;
  format.holds_field = nullptr;
  return format;
}

}  // namespace

const std::vector<MeshFormat>& foreign_formats() {
  static const std::vector<MeshFormat> formats = [] {
    std::vector<MeshFormat> all;
    for (const std::string extension : {".exo", ".e", ".ex2"}) {
      all.push_back(volume_format("exodus", extension, "Exodus II, by VTK"));
      all.back().holds_fixed_nodes = all.back().holds_numbers = true;  // as fields
    }
    for (const std::string extension : {".xdmf", ".xmf"}) {
      all.push_back(volume_format("xdmf", extension, "XDMF, by meshio"));
      all.back().holds_fixed_nodes = all.back().holds_numbers = true;  // as fields
      all.back().holds_facets = true;
      all.back().min_element_dimension = 1;
    }
    all.push_back(volume_format("cgns", ".cgns", "CGNS, by VTK (read) and h5py (written)"));
    all.back().holds_tags = false;
    all.back().holds_field = nullptr;
    all.push_back(surface_format("stl", ".stl", "STL surface, by VTK; 7 digits"));
    all.push_back(surface_format("obj", ".obj", "OBJ surface, by VTK and meshio"));
    all.push_back(surface_format("ply", ".ply", "PLY surface, by VTK and meshio"));
    return all;
  }();
  return formats;
}

}  // namespace smoothfem
