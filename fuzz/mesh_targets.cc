// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "fuzz/targets.h"
#include "meshes/io/mesh_assembly.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem::fuzz {

namespace {

template <int dim, int spacedim>
void require_sound(const Mesh<dim, spacedim>& mesh) {
  const Topology& topology = mesh.topology();
  const MeshLabels& labels = topology.labels();
  const auto has_size = [](std::size_t n, std::size_t expected) { return n == 0 || n == expected; };
  for (const auto& point : mesh.coordinates())
    require(point.allFinite(), "a coordinate is not finite");
  for (const auto* rows : {&topology.cells(), &labels.facets})
    for (const NodeIndex node : rows->entries())
      require(node < mesh.n_nodes(), "a cell or facet names a node that does not exist");
  require(mesh.n_cells() > 0, "there are no cells");
  require(labels.facet_tags.size() == labels.facets.size(), "facets have no tags");
  require(has_size(labels.cell_tags.size(), mesh.n_cells()), "cells have no tags");
  require(has_size(labels.cell_ids.size(), mesh.n_cells()), "cells have no numbers");
  require(has_size(labels.node_ids.size(), mesh.n_nodes()), "nodes have no numbers");
  const MeshQuality quality = mesh_quality(mesh);
  const auto is_quality = [](double q) { return q >= 0.0 && q <= 1.0 + 1e-9; };
  require(is_quality(quality.q_min) && is_quality(quality.q_mean), "the quality is not a number");
}

template <const char* name>
void read(const std::filesystem::path& path) {
  const auto& formats = mesh_formats();
  const auto format = std::find_if(formats.begin(), formats.end(),
                                   [](const MeshFormat& f) { return f.name == name; });
  require(format != formats.end(), std::string("there is no format ") + name);
  // Not read_mesh: it would turn foreign exceptions into InputErrors.
  const MeshFile file = assemble_mesh(path, format->read(path, {}));
  std::visit([](const auto& mesh) { require_sound(mesh); }, file.mesh);
}

template <const char* name>
bool run(Bytes bytes) {
  static const MemoryFile file;
  file.set(bytes);
  return is_read(read<name>, file.path());
}

constexpr char abaqus[] = "abaqus", gmsh[] = "gmsh", medit[] = "medit", polygonal[] = "polygonal",
               ucd[] = "ucd", vtk[] = "vtk", vtu[] = "vtu";

}  // namespace

std::vector<Target> mesh_targets() {
  return {
      {abaqus, run<abaqus>}, {gmsh, run<gmsh>}, {medit, run<medit>}, {polygonal, run<polygonal>},
      {ucd, run<ucd>},       {vtk, run<vtk>},   {vtu, run<vtu>}};
}

}  // namespace smoothfem::fuzz
