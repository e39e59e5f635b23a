// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/netgen_tetrahedra.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>

#include "meshes/external/child_process.h"
#include "smoothing/base/data_folder.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

/// Turns triangles over until neighbours have the same side outside, and all normals point
/// outwards.
void turn_outwards(ClosedSurface& surface) {
  auto& triangles = surface.triangles;
  std::map<std::pair<NodeIndex, NodeIndex>, std::vector<std::size_t>> at_edge;
  const auto edges_of = [](const std::array<NodeIndex, 3>& t) {
    return std::array{std::pair(t[0], t[1]), std::pair(t[1], t[2]), std::pair(t[2], t[0])};
  };
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const auto& [a, b] : edges_of(triangles[t])) at_edge[std::minmax(a, b)].push_back(t);
  std::vector<bool> done(triangles.size(), false);
  std::vector<std::size_t> open{0};
  done.front() = true;
  while (!open.empty()) {
    const auto edges = edges_of(triangles[open.back()]);
    open.pop_back();
    for (const auto& edge : edges)
      for (const std::size_t other : at_edge.at(std::minmax(edge.first, edge.second))) {
        if (done[other]) continue;
        done[other] = true;
        open.push_back(other);
        const auto others = edges_of(triangles[other]);
        if (std::find(others.begin(), others.end(), edge) != others.end())
          std::swap(triangles[other][1], triangles[other][2]);
      }
  }
  double volume = 0.0;
  for (const auto& t : triangles)
    volume += surface.points[t[0]].dot(surface.points[t[1]].cross(surface.points[t[2]]));
  if (volume < 0.0)
    for (auto& t : triangles) std::swap(t[1], t[2]);
}

fs::path netgen_program() {
  // PREFIX/share/smoothfem and PREFIX/libexec/smoothfem
  const fs::path program =
      data_folder().parent_path().parent_path() / "libexec/smoothfem/netgen_mesh";
  if (!fs::exists(program))
    throw InputError("the algorithm 'netgen' needs " + program.string() +
                     ", which is missing; install the packages netgen-headers and libnglib-dev and "
                     "build smoothfem again");
  return program;
}

void write(const fs::path& file, const ClosedSurface& surface, double edge_length) {
  std::ofstream out(file);
  out.precision(std::numeric_limits<double>::max_digits10);
  out << surface.points.size() << ' ' << surface.triangles.size() << ' ' << edge_length << '\n';
  for (const auto& p : surface.points) out << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (const auto& t : surface.triangles) out << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  if (!out.flush()) throw InputError(file.string() + " cannot be written");
}

VolumeCells read(const fs::path& file) {
  std::ifstream in(file);
  std::size_t n_points = 0, n_cells = 0;
  in >> n_points >> n_cells;
  VolumeCells mesh;
  mesh.coordinates.resize(in ? n_points : 0);
  for (auto& p : mesh.coordinates) in >> p.x() >> p.y() >> p.z();
  std::array<NodeIndex, 4> c{};
  for (std::size_t k = 0; k < n_cells && in; ++k) {
    for (NodeIndex& node : c) in >> node;
    // Netgen's tetrahedra have the other direction.
    mesh.cells.append(std::array<NodeIndex, 4>{c[0], c[2], c[1], c[3]});
  }
  if (!in || n_cells == 0) throw InputError("Netgen has not filled the surface");
  return mesh;
}

}  // namespace

VolumeCells fill_by_netgen(ClosedSurface surface, double edge_length) {
  turn_outwards(surface);
  constexpr double hour = 3600.0;
  const fs::path program = netgen_program();
  const ScratchFolder folder;
  write(folder.path() / "surface", surface, edge_length);
  const CommandEnd end =
      run_command(shell_quoted(program.string()) + " surface mesh", folder.path(), hour);
  if (end.exit_code != 0 || end.signal != 0 || end.timed_out)
    throw InputError("Netgen cannot fill the surface with tetrahedra");
  return read(folder.path() / "mesh");
}

}  // namespace smoothfem
