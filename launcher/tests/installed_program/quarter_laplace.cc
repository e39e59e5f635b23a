// SPDX-License-Identifier: GPL-3.0-or-later
// A program of somebody else's: reads a mesh, smooths it, and tells what that did to the error.
#include <cstdio>

#include "fem/poisson_solver.h"
#include "meshes/io/mesh_file.h"
#include "smoothing/loop/smooth.h"

int main(int, char** argv) {
  using namespace smoothfem;
  const MeshFile file = read_mesh(argv[1]);
  PlanarMesh mesh = planar_mesh(file, argv[1]);
  PoissonSolver<2> solver(&mesh, {});
  const auto& solution = manufactured_solution<2>("sine");
  const double before = solver.solve(mesh.coordinates(), solution).l2_error;
  auto method = make_method<2>(argv[2]);
  const SmoothingResult result = smooth(mesh, method);
  const double after = solver.solve(mesh.coordinates(), solution).l2_error;
  write_mesh(argv[3], mesh);
  std::printf("q_mean %.6f, error %.3e -> %.3e\n", result.quality.q_mean, before, after);
}
