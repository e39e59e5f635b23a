// SPDX-License-Identifier: GPL-3.0-or-later
// A program of its own, because Netgen prints, keeps global data and loads MPI.
// netgen_mesh IN OUT: fills a closed surface of triangles with tetrahedra by Netgen.
// IN: numbers of points and triangles, largest edge length; points; triangles (from 0, outwards).
// OUT: numbers of points and tetrahedra; points, the first being those of IN; tetrahedra (from 0).
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <limits>

namespace nglib {
#include <nglib.h>
}

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("netgen_mesh IN OUT\n", stderr), 2;
  using namespace nglib;
  std::ifstream in(argv[1]);
  int n_points = 0, n_triangles = 0;
  Ng_Meshing_Parameters parameters;
  in >> n_points >> n_triangles >> parameters.maxh;
  Ng_Init();
  Ng_Mesh* mesh = Ng_NewMesh();
  for (int i = 0; i < n_points; ++i) {
    double x[3];
    in >> x[0] >> x[1] >> x[2];
    Ng_AddPoint(mesh, x);
  }
  for (int t = 0; t < n_triangles; ++t) {
    int corners[3];
    in >> corners[0] >> corners[1] >> corners[2];
    for (int& corner : corners) ++corner;
    Ng_AddSurfaceElement(mesh, NG_TRIG, corners);
  }
  if (!in) return std::fputs("netgen_mesh: the file of the surface is incomplete\n", stderr), 2;
  if (Ng_GenerateVolumeMesh(mesh, &parameters) != NG_OK)
    return std::fputs("netgen_mesh: Netgen does not fill the surface\n", stderr), 1;
  std::ofstream out(argv[2]);
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  out << Ng_GetNP(mesh) << ' ' << Ng_GetNE(mesh) << '\n';
  for (int i = 1; i <= Ng_GetNP(mesh); ++i) {
    double x[3];
    Ng_GetPoint(mesh, i, x);
    out << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
  }
  for (int e = 1; e <= Ng_GetNE(mesh); ++e) {
    int corners[4];
    Ng_GetVolumeElement(mesh, e, corners);
    out << corners[0] - 1 << ' ' << corners[1] - 1 << ' ' << corners[2] - 1 << ' ' << corners[3] - 1
        << '\n';
  }
  Ng_DeleteMesh(mesh);
  Ng_Exit();
  return out.flush() ? 0 : 2;
}
