// SPDX-License-Identifier: GPL-3.0-or-later
// mesquite_driver IN.vtk OUT.vtk METHOD ITERATIONS [planar]: smooths by Mesquite. METHOD: laplace;
// shape, which minimizes squared inverse mean ratios by a trust region method; newton, the same by
// a feasible Newton method; wrapper, Mesquite's ShapeImprovementWrapper, which makes as many Newton
// iterations as it likes, called again until the mean of the mean ratios rises by less than 1e-4,
// at most ITERATIONS times. Compile it with your Mesquite:
//   c++ -O2 mesquite_driver.cc -I PREFIX/include -L PREFIX/lib -lmesquite -o mesquite_driver
#include <Mesquite_FeasibleNewton.hpp>
#include <Mesquite_IdealWeightInverseMeanRatio.hpp>
#include <Mesquite_InstructionQueue.hpp>
#include <Mesquite_LPtoPTemplate.hpp>
#include <Mesquite_LaplacianSmoother.hpp>
#include <Mesquite_MeshImpl.hpp>
#include <Mesquite_MsqError.hpp>
#include <Mesquite_PatchData.hpp>
#include <Mesquite_ShapeImprovementWrapper.hpp>
#include <Mesquite_TerminationCriterion.hpp>
#include <Mesquite_TrustRegion.hpp>
#include <Mesquite_XYPlanarDomain.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace MESQUITE_NS;

/// The mean of the cells' mean ratios.
double mean_quality(MeshDomainAssoc& mesh, QualityMetric& metric, MsqError& error) {
  PatchData cells;
  cells.set_mesh(mesh.get_mesh());
  cells.set_domain(mesh.get_domain());
  cells.fill_global_patch(error);
  double sum = 0;
  for (size_t i = 0; i < cells.num_elements(); ++i) {
    double inverse = 0;
    if (metric.evaluate(cells, i, inverse, error)) sum += 1 / inverse;
  }
  return sum / cells.num_elements();
}

int main(int argc, char** argv) {
  if (argc < 5)
    return std::fputs("mesquite_driver IN OUT laplace|shape|newton|wrapper ITERATIONS [planar]\n",
                      stderr),
           2;
  const std::string method = argv[3];
  const int n_iterations = std::atoi(argv[4]);
  MsqError error;
  MeshImpl mesh;
  mesh.read_vtk(argv[1], error);
  if (error) return std::fprintf(stderr, "%s: %s\n", argv[1], error.error_message()), 1;
  XYPlanarDomain plane;
  MeshDomainAssoc domain(&mesh, argc > 5 ? &plane : nullptr);

  IdealWeightInverseMeanRatio metric(error);
  metric.set_averaging_method(QualityMetric::LINEAR);
  LPtoPTemplate objective(&metric, 2, error);
  TrustRegion trust_region(&objective);
  trust_region.use_global_patch();
  FeasibleNewton newton(&objective);
  newton.use_global_patch();
  LaplacianSmoother laplace;
  TerminationCriterion iterations;
  iterations.add_iteration_limit(n_iterations);
  laplace.set_outer_termination_criterion(&iterations);
  trust_region.set_inner_termination_criterion(&iterations);
  newton.set_inner_termination_criterion(&iterations);

  InstructionQueue queue;
  if (method == "laplace")
    queue.set_master_quality_improver(&laplace, error);
  else if (method == "newton")
    queue.set_master_quality_improver(&newton, error);
  else
    queue.set_master_quality_improver(&trust_region, error);
  double seconds = 0;
  const auto run = [&](auto& instructions) {
    const auto start = std::chrono::steady_clock::now();
    instructions.run_instructions(&domain, error);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  if (method == "wrapper") {
    double before = mean_quality(domain, metric, error), gain = 1;
    for (int i = 0; i < n_iterations && gain >= 1e-4 && !error; ++i) {
      ShapeImprovementWrapper wrapper;
      run(wrapper);
      const double now = mean_quality(domain, metric, error);
      gain = now - before;
      before = now;
    }
  } else if (n_iterations > 0) {
    run(queue);
  }
  std::printf("time %.9f s\n", seconds);
  mesh.write_vtk(argv[2], error);
  if (error) std::fprintf(stderr, "%s\n", error.error_message());
  return error ? 1 : 0;
}
