// SPDX-License-Identifier: GPL-3.0-or-later
// mesquite_driver IN.vtk OUT.vtk METHOD ITERATIONS [planar]: smooths by Mesquite. METHOD: laplace,
// or shape, which minimizes squared inverse mean ratios by a trust region method. Compile it with
// your Mesquite:
//   c++ -O2 mesquite_driver.cc -I PREFIX/include -L PREFIX/lib -lmesquite -o mesquite_driver
#include <Mesquite_ConditionNumberQualityMetric.hpp>
#include <Mesquite_IdealWeightInverseMeanRatio.hpp>
#include <Mesquite_InstructionQueue.hpp>
#include <Mesquite_LPtoPTemplate.hpp>
#include <Mesquite_LaplacianSmoother.hpp>
#include <Mesquite_MeshImpl.hpp>
#include <Mesquite_MsqError.hpp>
#include <Mesquite_PlanarDomain.hpp>
#include <Mesquite_TerminationCriterion.hpp>
#include <Mesquite_TrustRegion.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace MESQUITE_NS;

int main(int argc, char** argv) {
  if (argc < 5)
    return std::fputs("mesquite_driver IN OUT laplace|shape ITERATIONS [planar]\n", stderr), 2;
  const std::string method = argv[3];
  const int n_iterations = std::atoi(argv[4]);
  MsqError error;
  MeshImpl mesh;
  mesh.read_vtk(argv[1], error);
  PlanarDomain plane(PlanarDomain::XY);
  MeshDomain* domain = argc > 5 ? &plane : nullptr;

  IdealWeightInverseMeanRatio metric(error);
  LPtoPTemplate objective(&metric, 2, error);
  TrustRegion optimizer(&objective);
  optimizer.use_global_patch();
  LaplacianSmoother laplace;
  VertexMover& mover = method == "laplace" ? static_cast<VertexMover&>(laplace) : optimizer;
  TerminationCriterion iterations;
  iterations.add_iteration_limit(n_iterations);
  if (method == "laplace")
    mover.set_outer_termination_criterion(&iterations);
  else
    mover.set_inner_termination_criterion(&iterations);

  InstructionQueue queue;
  queue.set_master_quality_improver(&mover, error);
  const auto start = std::chrono::steady_clock::now();
  if (n_iterations > 0) {
    if (domain) {
      MeshDomainAssoc planar(&mesh, domain);
      queue.run_instructions(&planar, error);
    } else {
      queue.run_instructions(&mesh, error);
    }
  }
  std::printf("time %.9f s\n",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  mesh.write_vtk(argv[2], error);
  if (error) std::fprintf(stderr, "%s\n", error.error_message());
  return error ? 1 : 0;
}
