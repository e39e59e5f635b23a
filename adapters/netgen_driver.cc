// SPDX-License-Identifier: GPL-3.0-or-later
// netgen_driver IN.vtk OUT.vtk ITERATIONS: moves the inner nodes of a tetrahedral mesh by Netgen's
// Mesh::ImproveMesh, the smoothing part of its optimizer, which minimizes the badness of the cells
// around one node after another. (Its Python module has only the whole optimizer, which swaps and
// splits, too.) Compile it with Debian's netgen-headers and libnglib-dev, which need MPI:
//   mpicxx -DPARALLEL -w -O2 -I /usr/include/netgen/include netgen_driver.cc \
//     -L LIB/netgen -Wl,-rpath,LIB/netgen -lmesh -linterface -lngcore -o netgen_driver
// LIB: /usr/lib/x86_64-linux-gnu, or where `dpkg -L libnglib-dev` says.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <limits>
#include <meshing.hpp>
#include <string>
#include <vector>

namespace {

/// Goes on to what stands after a word of a legacy VTK file.
void find(std::istream& in, const std::string& word) {
  for (std::string w; in >> w;)
    if (w == word) return;
  std::cerr << "no " << word << " in the file\n";
  std::exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::fputs("netgen_driver IN.vtk OUT.vtk ITERATIONS\n", stderr), 2;
  std::ifstream in(argv[1]);  // text, as smoothfem writes it for commands
  std::size_t n_nodes = 0, n_cells = 0;
  find(in, "POINTS");
  in >> n_nodes;
  find(in, "double");
  std::vector<double> x(3 * n_nodes);
  for (double& value : x) in >> value;
  find(in, "CELLS");
  in >> n_cells;
  const auto begin_cells = in.tellg();
  find(in, "fixed");
  find(in, "default");

  netgen::Mesh mesh;
  mesh.SetDimension(3);
  for (std::size_t i = 0; i < n_nodes; ++i) {
    int fixed = 0;
    in >> fixed;
    mesh.AddPoint(netgen::Point3d(x[3 * i], x[3 * i + 1], x[3 * i + 2]), 1,
                  fixed ? netgen::FIXEDPOINT : netgen::INNERPOINT);
  }
  in.seekg(begin_cells);
  in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  for (std::size_t c = 0; c < n_cells; ++c) {
    int n = 0, node[4];
    in >> n;
    if (n != 4) return std::fputs("netgen_driver takes tetrahedra only\n", stderr), 1;
    for (int& k : node) in >> k;
    std::swap(node[2], node[3]);  // Netgen's tetrahedra are the other way round
    netgen::Element cell(4);
    for (int k = 0; k < 4; ++k) cell[k] = netgen::PointIndex(node[k] + netgen::PointIndex::BASE);
    cell.SetIndex(1);
    mesh.AddVolumeElement(cell);
  }

  netgen::printmessage_importance = 0;
  netgen::MeshingParameters parameters;
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < std::atoi(argv[3]); ++k) mesh.ImproveMesh(parameters);
  std::printf("time %.9f s\n",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());

  // The file as it was, with the new places of the nodes.
  std::ifstream old(argv[1]);
  std::ofstream out(argv[2]);
  out.precision(17);
  std::string line;
  while (std::getline(old, line) && line.rfind("POINTS", 0) != 0) out << line << '\n';
  out << line << '\n';
  for (std::size_t i = 0; i < n_nodes; ++i) {
    std::getline(old, line);
    const auto& p = mesh[netgen::PointIndex(static_cast<int>(i) + netgen::PointIndex::BASE)];
    out << p(0) << ' ' << p(1) << ' ' << p(2) << '\n';
  }
  out << old.rdbuf();
  return out.flush() ? 0 : 1;
}
