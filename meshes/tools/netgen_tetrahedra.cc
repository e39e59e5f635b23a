// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/netgen_tetrahedra.h"

#include <array>
#include <fstream>
#include <limits>
#include <numeric>

#include "meshes/doctor/examinations/orientation.h"
#include "meshes/external/child_process.h"
#include "smoothing/base/data_folder.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

/// Returns the triangles with all normals outwards.
CompressedRows<NodeIndex> turned_outwards(const ClosedSurface& surface) {
  const PlainCells plain{2, surface.triangles, surface.points, false};
  auto triangles = with_reversed(2, surface.triangles, find_reversed_cells(plain).reversed);
  double volume = 0.0;
  for (CellIndex t = 0; t < triangles.size(); ++t)
    volume += surface.points[triangles[t][0]].dot(
        surface.points[triangles[t][1]].cross(surface.points[triangles[t][2]]));
  if (volume > 0.0) return triangles;
  std::vector<CellIndex> all(triangles.size());
  std::iota(all.begin(), all.end(), CellIndex{0});
  return with_reversed(2, triangles, all);
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
  const auto triangles = turned_outwards(surface);
  std::ofstream out(file);
  out.precision(std::numeric_limits<double>::max_digits10);
  out << surface.points.size() << ' ' << triangles.size() << ' ' << edge_length << '\n';
  for (const auto& p : surface.points) out << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (CellIndex t = 0; t < triangles.size(); ++t)
    out << triangles[t][0] << ' ' << triangles[t][1] << ' ' << triangles[t][2] << '\n';
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

VolumeCells fill_by_netgen(const ClosedSurface& surface, double edge_length) {
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
